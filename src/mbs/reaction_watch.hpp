// Detects the oscillation of the steps' own reactions that HHT with hht_alpha at or near 0 does not damp.
// Reactions of instants, which outputs show, are free of it.
#pragma once

#include <string>
#include <vector>

#include "mbs/multibody.hpp"

namespace scree {

// At hht_alpha = 0 a velocity gap e of the constraints changes its sign at every step and stays. Newmark's
// rule then adds 4 e/h to the alternating part of the accelerations at every step, and so to that of the
// reactions R = Phi_q^T lambda: it grows without bound, the faster the shorter the steps. At every step are
// computed
//   the alternating part  A = |R_1 - R_0| / 2,   the mean part  S = |R_1 + R_0| / 2,
// each the largest over the coordinates, times their scales [J]. A step alternates where the changes of R
// and of the velocity gap both point against those of the step before, and where the applied forces, which
// may be those of stiff springs or contacts, changed by less than the reactions.
class ReactionWatch {
 public:
  // coordinate_scale, constraint_scale: those of the MechanicalSystem; both must outlive the watch.
  ReactionWatch(const std::vector<Real>& coordinate_scale, const std::vector<Real>& constraint_scale);

  // Takes a step that closed from `start` to `end`; gap: Phi_q q' - velocity_rhs at its end.
  void observe(const MultibodyState& start, const MultibodyState& end, const std::vector<Real>& gap);

  // At least the last 50 steps alternate, and A has grown tenfold over them.
  bool oscillates() const;
  // share(): A over the largest S so far; worst_ratio(): its largest value over steps that oscillated.
  Real share() const { return mean_ > 0 ? alternating_ / mean_ : 0; }
  Real worst_ratio() const { return worst_ratio_; }
  // The velocity gap over the largest velocity so far, both over their scales.
  Real relative_gap() const { return fastest_ > 0 ? largest_gap_ / fastest_ : 0; }

 private:
  bool alternates(Real applied_change) const;

  const std::vector<Real>&coordinate_scale_, &constraint_scale_;
  Real worst_ratio_ = 0, largest_gap_ = 0, fastest_ = 0;
  std::vector<Real> change_, gap_;            // of the last step, scaled
  std::vector<Real> next_change_, next_gap_;  // of the step under observation
  Real alternating_ = 0, mean_ = 0;           // A of the last step, largest S [J]
  Real first_ = 0;                            // A of the first of the steps that alternate [J]
  int steps_ = 0;                             // consecutive steps that alternate
};

// The message for reactions whose alternating part has grown to `share` times the largest mean part.
std::string oscillation_text(Real share, Real hht_alpha);

}  // namespace scree
