// Square root and reciprocal, correctly rounded on host and device.
#pragma once

#include <cmath>

#include "base/hd.hpp"
#include "base/types.hpp"

namespace scree {

template <class T>
struct RootAndInverse {
  T root;     // sqrt(x)
  T inverse;  // 1 / root
};

#ifdef __CUDA_ARCH__

// The compiler's double-precision root and division branch for special cases, which keeps a GPU from
// overlapping two of them. These functions do not branch, but take the same steps: one of third order from
// the hardware's estimate, which knows some 20 bits, and a last one in the form that rounds correctly
// (Markstein, IBM J. Res. Dev. 34, 1990). Arguments and results must be normal numbers.

// The only divisor for which that form can be wrong has a mantissa of ones: its reciprocal lies just above
// the midpoint between a power of two and the next number, and is rounded to the latter.
__device__ inline Real rounded_reciprocal(Real x, Real near) {
  const bool ones = (__double2loint(x) & (__double2hiint(x) | ~0xfffff)) == ~0;
  return __hiloint2double(__double2hiint(near), __double2loint(near) | static_cast<int>(ones));
}

__device__ inline RootAndInverse<Real> root_and_inverse(Real x) {
  Real y;  // 1 / sqrt(x)
  asm("rsqrt.approx.ftz.f64 %0, %1;" : "=d"(y) : "d"(x));
  const Real error = __fma_rn(-x * y, y, 1.0);
  y = __fma_rn(y * error, __fma_rn(error, 0.375, 0.5), y);
  Real root = x * y;
  root = __fma_rn(__fma_rn(-root, root, x), 0.5 * y, root);
  Real inverse = __fma_rn(__fma_rn(-root, y, 1.0), y, y);
  inverse = __fma_rn(__fma_rn(-root, inverse, 1.0), inverse, inverse);
  return {root, rounded_reciprocal(root, inverse)};
}

// Single precision, accurate to a few units in the last place.
__device__ inline RootAndInverse<float> root_and_inverse(float x) {
  const float y = rsqrtf(x), root = x * y;
  return {__fmaf_rn(__fmaf_rn(-root, root, x), 0.5f * y, root), y};
}

__device__ inline Real reciprocal(Real x) {
  Real y;
  asm("rcp.approx.ftz.f64 %0, %1;" : "=d"(y) : "d"(x));
  // Low bits as in the compiler's division: the last step then needs no exception for a mantissa of ones.
  y = __hiloint2double(__double2hiint(y), __double2hiint(x) + 0x300402);
  const Real error = __fma_rn(-x, y, 1.0);
  y = __fma_rn(y, __fma_rn(error, error, error), y);
  return __fma_rn(y, __fma_rn(-x, y, 1.0), y);
}

// The same without these limits where contact laws meet them: the root of zero, and reciprocals and quotients
// of infinite divisors. Other arguments and results must be normal numbers.
__device__ inline Real root(Real x) {
  const Real of_normal = root_and_inverse(x).root;
  return __double2hiint(x) > 0 ? of_normal : 0;
}
__device__ inline Real inverse(Real x) {
  const Real of_finite = reciprocal(x);
  return __double2hiint(x) == 0x7ff00000 ? 0 : of_finite;
}
__device__ inline Real quotient(Real a, Real b) {
  const Real near = reciprocal(b), q = a * near, of_finite = __fma_rn(__fma_rn(-b, q, a), near, q);
  return __double2hiint(b) == 0x7ff00000 ? 0 : of_finite;
}

#else

template <class T>
SCREE_HD RootAndInverse<T> root_and_inverse(T x) {
  const T root = std::sqrt(x);
  return {root, 1 / root};
}

SCREE_HD Real reciprocal(Real x) { return 1 / x; }
SCREE_HD Real root(Real x) { return std::sqrt(x); }
SCREE_HD Real inverse(Real x) { return 1 / x; }
SCREE_HD Real quotient(Real a, Real b) { return a / b; }

#endif

SCREE_HD float root(float x) { return std::sqrt(x); }
SCREE_HD float inverse(float x) { return 1 / x; }

}  // namespace scree
