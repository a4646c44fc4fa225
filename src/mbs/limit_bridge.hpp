// Slopes that lead Newton's method across the limits of an effort.
#pragma once

#include <optional>

#include "mbs/joint_laws.hpp"

namespace scree {

// Beyond a limit an effort hardly changes, between its limits it may change steeply: with its own slopes
// Newton's method goes from beyond one limit to beyond the other, and back, for ever. Once it has done so,
// two iterates tell how the mechanism yields to this effort, a line, and the slope becomes that of the chord
// from the iterate to where the law meets this line. The solution is the same; without limits, and where no
// iterate has passed both, so are the slopes.
class LimitBridge {
 public:
  // Of an iterate of the step: its effort, whose slopes may change.
  void guide(const JointLaw& law, const LawStep& step, JointEffort& effort);
  // These slopes are now those of Newton's matrix.
  void take() { taken_ = share_; }

 private:
  struct Point {
    Real wanted, effort;
  };
  // Of the slopes without the limit, at `at`, while the line goes through `on`; none where it is of no use.
  std::optional<Real> share_to_line(const JointLaw& law, const LawStep& step, const Point& at,
                                    const Point& on) const;

  std::optional<Point> iterate_;  // the last one, on the law
  std::optional<Point> line_;     // where Newton's linear system had it, on the mechanism's line
  Real share_ = 1, taken_ = 1;    // of the slopes without the limit: of the last iterate, and in the matrix
  int iterates_ = 0;
  bool crossed_ = false;  // iterates have been beyond both limits, or are many
};

}  // namespace scree
