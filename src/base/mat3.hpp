// Functions of 3x3 matrices on the host: products, cross-product matrix, principal values.
#pragma once

#include <array>

#include "base/spatial_velocity.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"

namespace scree {

inline Mat3 identity3() { return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}; }
inline Mat3 full(const Sym3& a) { return {{a.xx, a.xy, a.xz}, {a.xy, a.yy, a.yz}, {a.xz, a.yz, a.zz}}; }
// The cross-product matrix: tilde(a) b = a x b.
inline Mat3 tilde(Vec3 a) { return {{0, -a.z, a.y}, {a.z, 0, -a.x}, {-a.y, a.x, 0}}; }

inline Mat3 operator+(const Mat3& a, const Mat3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Mat3 operator-(const Mat3& a, const Mat3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Mat3 operator*(Real s, const Mat3& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Mat3 transposed(const Mat3& a) {
  return {{a.x.x, a.y.x, a.z.x}, {a.x.y, a.y.y, a.z.y}, {a.x.z, a.y.z, a.z.z}};
}
inline Mat3 operator*(const Mat3& a, const Mat3& b) {
  return {transposed_times(b, a.x), transposed_times(b, a.y), transposed_times(b, a.z)};
}
inline Mat3 inverse(const Mat3& a) {
  const Vec3 x = cross(a.y, a.z), y = cross(a.z, a.x), z = cross(a.x, a.y);
  return (1 / dot(a.x, x)) * transposed({x, y, z});
}
// Component k = 0, 1, 2 of a vector.
inline Real component(Vec3 v, int k) { return k == 0 ? v.x : k == 1 ? v.y : v.z; }
inline Vec3 row_of(const Mat3& a, int k) { return k == 0 ? a.x : k == 1 ? a.y : a.z; }

// Eigenvalues of a symmetric matrix in increasing order, by Jacobi rotations; errors are round-off of the
// largest.
std::array<Real, 3> principal_values(const Sym3& a);

}  // namespace scree
