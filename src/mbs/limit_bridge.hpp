// Modified slopes with which Newton's method converges across the limits of an effort.
#pragma once

#include <optional>

#include "mbs/joint_laws.hpp"

namespace scree {

// An effort is nearly constant beyond its limits and may be steep between them. With its own slopes Newton's
// method can cycle from beyond one limit to beyond the other. Once iterates have done so, two of them give
// the response of the mechanism to this effort as a straight line, and the slope becomes that of the chord
// from the iterate to the intersection of the law with this line. The solution is unchanged; so are the
// slopes without limits, and where no iterate has passed both.
class LimitBridge {
 public:
  // Takes an iterate of the step: its effort, whose slopes may change.
  void guide(const JointLaw& law, const LawStep& step, JointEffort& effort);
  // Marks the slopes of the last guide() as those of Newton's matrix.
  void take() { taken_ = share_; }

 private:
  struct Point {
    Real wanted, effort;
  };
  // The fraction of the unlimited slopes at `at` with which the chord ends on the line through `on`; none
  // where the line is of no use.
  std::optional<Real> share_to_line(const JointLaw& law, const LawStep& step, const Point& at,
                                    const Point& on) const;

  std::optional<Point> iterate_;  // the last one, on the law
  std::optional<Point> line_;     // the iterate of Newton's linear system, on the mechanism's line
  Real share_ = 1, taken_ = 1;    // fraction of the unlimited slopes: at the last iterate, and in the matrix
  int iterates_ = 0;
  bool crossed_ = false;  // iterates have passed both limits, or are many
};

}  // namespace scree
