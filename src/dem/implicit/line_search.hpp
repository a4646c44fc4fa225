// Line searches for the corrections of the particles' Newton iteration, shared by all backends: the backends
// form the sums and move the particles, the rules are here.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/types.hpp"

namespace scree {

// Line search along one correction. The potential whose minimum solves the step has kinks where contacts open
// or close; past a kink a full correction can increase the error. The criterion is the slope of the potential
// along the correction: the residual is minus its gradient, so that the slope is minus the sum of SlopeItem.
class LineSearch {
 public:
  // Begins after the full correction was applied. along: sum of SlopeItem at its start [N m/s^2].
  void open(Real along) { share_ = 1, start_slope_ = -along, slope_ = 0; }

  // Whether the correction may still be shortened.
  bool is_open() const { return share_ > kMinFraction; }

  // Updates the slope while the search is open. along: sum of SlopeItem at the iterate.
  void update(Real along) { slope_ = -along; }

  // Whether the iterate is too far along the correction.
  bool overshoots() const { return is_open() && slope_ > kMostSlope * std::abs(start_slope_); }

  // Next fraction after an overshoot, by regula falsi between the two slopes; less than two thirds of the
  // last one. Where the slope jumps the interpolation is poor, and the next update decides again.
  Real next_share() const {
    const Real size = std::abs(start_slope_);
    return share_ * std::max(size / (size + slope_), kLeastFactor);
  }

  // Takes the next fraction; returns its change, to be applied to the correction.
  Real shorten() {
    const Real last = share_;
    share_ = next_share();
    return share_ - last;
  }

 private:
  // An exact minimum is not needed: the correction is shortened if the slope exceeds this fraction of the
  // initial one; smaller slopes are left to the next correction.
  static constexpr Real kMostSlope = 0.5;
  // Where the slope jumps from below 0 to far above it no fraction is good enough. The search then ends at
  // this fraction, and the next correction starts from there.
  static constexpr Real kMinFraction = 0.05;
  // Far past a kink the slope is so large that regula falsi would discard nearly all of the correction.
  static constexpr Real kLeastFactor = 0.1;

  Real share_ = 0;                    // fraction of the correction that is applied; 0: none
  Real start_slope_ = 0, slope_ = 0;  // slopes of the potential at the start of the correction and at the
                                      // iterate
};

// Line search with friction, for which there is no potential: a correction is shortened while the largest
// scaled residual exceeds that at its start. The maximum is the same on any number of ranks.
class ResidualSearch {
 public:
  // Begins after the full correction was applied. residual: at its start.
  void open(Real residual) { share_ = 1, start_ = residual, residual_ = 0; }
  bool is_open() const { return share_ > kMinFraction; }
  void update(Real residual) { residual_ = residual; }
  bool overshoots() const { return is_open() && residual_ > kMostGrowth * start_; }
  // Halves the fraction; returns its change, to be applied to the correction.
  Real shorten() {
    const Real last = share_;
    share_ *= Real(0.5);
    return share_ - last;
  }

 private:
  static constexpr Real kMostGrowth = 1;
  static constexpr Real kMinFraction = 0.1;

  Real share_ = 0, start_ = 0, residual_ = 0;
};

}  // namespace scree
