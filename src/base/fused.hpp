// Fused multiply-add, a b + c with a single rounding, for Real and Vec3, with the same bits on host and
// device. It saves operations in contact evaluations. All functions change sign exactly with their arguments.
#pragma once

#include <cmath>

#include "base/hd.hpp"
#include "base/vec3.hpp"

namespace scree {

// a b + c.
SCREE_HD Real fused(Real a, Real b, Real c) {
#ifdef __CUDA_ARCH__
  return __fma_rn(a, b, c);
#else
  return std::fma(a, b, c);
#endif
}
SCREE_HD Vec3 fused(Real s, Vec3 a, Vec3 b) {
  return {fused(s, a.x, b.x), fused(s, a.y, b.y), fused(s, a.z, b.z)};
}
SCREE_HD Real fused_dot(Vec3 a, Vec3 b) { return fused(a.x, b.x, fused(a.y, b.y, a.z * b.z)); }
SCREE_HD Vec3 fused_cross(Vec3 a, Vec3 b) {
  return {fused(a.y, b.z, -(a.z * b.y)), fused(a.z, b.x, -(a.x * b.z)), fused(a.x, b.y, -(a.y * b.x))};
}

}  // namespace scree
