// How much of a correction of the particles' Newton iteration is taken: one rule for every backend. The
// schedules form the sums and move the particles; what follows from the sums is decided here.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/types.hpp"

namespace scree {

// Line search along one correction. The potential whose minimum solves the step has kinks where contacts open
// or close, and past a kink a whole correction can lead further away. Its slope along the correction tells:
// the residual is minus its gradient, so that the slope is minus the sum of SlopeItem.
class LineSearch {
 public:
  // The whole correction has been applied. along: sum of SlopeItem where it started [N m/s^2].
  void open(Real along) { share_ = 1, start_slope_ = -along, slope_ = 0; }

  // Whether the correction may yet be shortened.
  bool is_open() const { return share_ > kLeastShare; }

  // The sum of SlopeItem at the iterate, while the search is open.
  void look(Real along) { slope_ = -along; }

  // Whether the iterate lies too far along the correction.
  bool overshoots() const { return is_open() && slope_ > kMostSlope * std::abs(start_slope_); }

  // After an overshoot, regula falsi: the share at which the straight line between the two slopes is zero,
  // less than two thirds of the last. Where the slope jumps the line is a bad guide, and the next look
  // decides again.
  Real next_share() const {
    const Real size = std::abs(start_slope_);
    return share_ * std::max(size / (size + slope_), kLeastFactor);
  }

  // Takes the next share; returns by how much the share changes, which is what to apply of the correction.
  Real shorten() {
    const Real last = share_;
    share_ = next_share();
    return share_ - last;
  }

 private:
  // An exact minimum is not needed: past this share of the slope at the start the correction is shortened,
  // and a lesser slope is left to the next correction.
  static constexpr Real kMostSlope = 0.5;
  // Where the slope jumps from below 0 to far above it no share is good enough. The search then ends at this
  // share, and the next correction starts from there.
  static constexpr Real kLeastShare = 0.05;
  // Far past a kink the slope is so large that regula falsi would give up nearly all of the correction.
  static constexpr Real kLeastFactor = 0.1;

  Real share_ = 0;                    // of the correction that is applied; 0: there is none
  Real start_slope_ = 0, slope_ = 0;  // of the potential, where the correction starts and at the iterate
};

// The same where friction leaves no potential: a correction is shortened while the largest scaled residual is
// larger than where it started. That is a maximum, the same on any number of ranks.
class ResidualSearch {
 public:
  // The whole correction has been applied. residual: where it started.
  void open(Real residual) { share_ = 1, start_ = residual, residual_ = 0; }
  bool is_open() const { return share_ > kLeastShare; }
  void look(Real residual) { residual_ = residual; }
  bool overshoots() const { return is_open() && residual_ > kMostGrowth * start_; }
  // By how much the share changes, which is what to apply of the correction.
  Real shorten() {
    const Real last = share_;
    share_ *= Real(0.5);
    return share_ - last;
  }

 private:
  static constexpr Real kMostGrowth = 1;
  static constexpr Real kLeastShare = 0.1;

  Real share_ = 0, start_ = 0, residual_ = 0;
};

}  // namespace scree
