// base/root.hpp as the device computes it.
#pragma once

#include <vector>

#include "base/root.hpp"

namespace scree {

struct Roots {
  RootAndInverse<Real> root;
  Real reciprocal;
};

// Roots of each number, computed by the GPU.
std::vector<Roots> roots_on_device(const std::vector<Real>& numbers);

}  // namespace scree
