// base/root.hpp as the device computes it.
#pragma once

#include <vector>

#include "base/root.hpp"

namespace scree {

struct Roots {
  RootAndInverse<Real> both;
  Real reciprocal, root, inverse;
  Real quotient;  // kDividend by the number
};
inline constexpr Real kDividend = 0.7;

SCREE_HD Roots roots_of(Real x) {
  return {root_and_inverse(x), reciprocal(x), root(x), inverse(x), quotient(kDividend, x)};
}

// Roots of each number, computed by the GPU.
std::vector<Roots> roots_on_device(const std::vector<Real>& numbers);

}  // namespace scree
