// Errors of many cases at one step, and the order between two steps.
#pragma once

#include <cmath>

#include "base/types.hpp"

namespace scree {

// Errors of values that are each scaled by their own unit.
class Errors {
 public:
  void add(Real error) {
    worst_ = std::abs(error) <= worst_ ? worst_ : std::abs(error);  // keeps NaN
    squares_ += error * error, ++count_;
  }
  Real worst() const { return worst_; }
  Real rms() const { return std::sqrt(squares_ / count_); }

 private:
  Real worst_ = 0, squares_ = 0;
  int count_ = 0;
};

// p of error ~ h^p from the errors at h and h / 2.
inline Real order_between(const Errors& coarse, const Errors& fine) {
  return std::log2(coarse.rms() / fine.rms());
}

}  // namespace scree
