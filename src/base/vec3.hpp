// Three-vectors, symmetric 3x3 matrices and packed four-vectors for host and device.
#pragma once

#include <cmath>

#include "base/hd.hpp"
#include "base/types.hpp"

namespace scree {

struct Vec3 {
  Real x = 0, y = 0, z = 0;
};

SCREE_HD Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
SCREE_HD Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
SCREE_HD Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
// -a without negative zeros: the results of both partners of a contact are then +0.
SCREE_HD Vec3 opposite(Vec3 a) { return {0 - a.x, 0 - a.y, 0 - a.z}; }
SCREE_HD Vec3 operator*(Real s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
SCREE_HD Vec3& operator+=(Vec3& a, Vec3 b) { return a = a + b; }
SCREE_HD Vec3& operator-=(Vec3& a, Vec3 b) { return a = a - b; }
SCREE_HD bool operator==(Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
SCREE_HD Real dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
SCREE_HD Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
SCREE_HD Real norm(Vec3 a) { return std::sqrt(dot(a, a)); }
SCREE_HD bool is_finite(Vec3 a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

// Position and radius [m] in one aligned load; w also holds other scalars of particles.
struct alignas(32) Vec4 {
  Real x = 0, y = 0, z = 0, w = 0;
};

SCREE_HD Vec3 xyz(Vec4 a) { return {a.x, a.y, a.z}; }
SCREE_HD Vec4 vec4(Vec3 a, Real w) { return {a.x, a.y, a.z, w}; }

// Three-vector in single precision. Its functions are friends, found by argument-dependent lookup alone, so
// that braces always construct a Vec3.
struct Vec3f {
  float x = 0, y = 0, z = 0;

  friend SCREE_HD Vec3f operator+(Vec3f a, Vec3f b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend SCREE_HD Vec3f operator-(Vec3f a, Vec3f b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend SCREE_HD Vec3f operator-(Vec3f a) { return {-a.x, -a.y, -a.z}; }
  friend SCREE_HD Vec3f operator*(float s, Vec3f a) { return {s * a.x, s * a.y, s * a.z}; }
  friend SCREE_HD float dot(Vec3f a, Vec3f b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  friend SCREE_HD Vec3f cross(Vec3f a, Vec3f b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
};

SCREE_HD Vec3 in_double(Vec3f a) { return {a.x, a.y, a.z}; }
SCREE_HD Vec3f in_single(Vec3 a) {
  return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}

// Symmetric 3x3 matrix.
struct Sym3 {
  Real xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
};

SCREE_HD Sym3& operator+=(Sym3& a, Sym3 b) {
  a.xx += b.xx, a.xy += b.xy, a.xz += b.xz, a.yy += b.yy, a.yz += b.yz, a.zz += b.zz;
  return a;
}
SCREE_HD Sym3 outer(Real s, Vec3 n) {
  return {s * n.x * n.x, s * n.x * n.y, s * n.x * n.z, s * n.y * n.y, s * n.y * n.z, s * n.z * n.z};
}
SCREE_HD Vec3 operator*(const Sym3& a, Vec3 v) {
  return {a.xx * v.x + a.xy * v.y + a.xz * v.z, a.xy * v.x + a.yy * v.y + a.yz * v.z,
          a.xz * v.x + a.yz * v.y + a.zz * v.z};
}
// Inverse of a positive definite matrix.
SCREE_HD Sym3 inverse(const Sym3& a) {
  const Real cxx = a.yy * a.zz - a.yz * a.yz, cxy = a.xz * a.yz - a.xy * a.zz,
             cxz = a.xy * a.yz - a.xz * a.yy;
  const Real r = 1 / (a.xx * cxx + a.xy * cxy + a.xz * cxz);
  return {r * cxx,
          r * cxy,
          r * cxz,
          r * (a.xx * a.zz - a.xz * a.xz),
          r * (a.xy * a.xz - a.xx * a.yz),
          r * (a.xx * a.yy - a.xy * a.xy)};
}

}  // namespace scree
