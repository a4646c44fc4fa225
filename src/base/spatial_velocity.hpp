// 6-vectors of particles that translate and rotate, and symmetric 6 x 6 blocks.
#pragma once

#include <type_traits>

#include "base/hd.hpp"
#include "base/vec3.hpp"

namespace scree {

// Translational and rotational part in the same unit: the rotational part is scaled by the radius. Aligned
// for loads of two numbers each.
struct alignas(16) Twist {
  Vec3 move, turn;
};

SCREE_HD Twist operator+(Twist a, Twist b) { return {a.move + b.move, a.turn + b.turn}; }
SCREE_HD Twist operator-(Twist a, Twist b) { return {a.move - b.move, a.turn - b.turn}; }
SCREE_HD Twist operator*(Real s, Twist a) { return {s * a.move, s * a.turn}; }
SCREE_HD Twist& operator+=(Twist& a, Twist b) { return a = a + b; }
SCREE_HD Twist& operator-=(Twist& a, Twist b) { return a = a - b; }

// In single precision, for vectors of linear solvers. A spare number follows each part, because compilers
// copy structures with padding byte by byte.
struct alignas(16) Twistf {
  Vec3f move;
  float spare = 0;
  Vec3f turn;
  float spare_too = 0;

  Twistf() = default;
  SCREE_HD Twistf(Vec3f m, Vec3f t) : move(m), turn(t) {}
};

SCREE_HD Twist in_double(Twistf a) { return {in_double(a.move), in_double(a.turn)}; }
SCREE_HD Twistf in_single(Twist a) { return {in_single(a.move), in_single(a.turn)}; }
SCREE_HD Twistf operator*(float s, Twistf a) { return {s * a.move, s * a.turn}; }
SCREE_HD Twistf operator+(Twistf a, Twistf b) { return {a.move + b.move, a.turn + b.turn}; }
SCREE_HD Twistf& operator+=(Twistf& a, Twistf b) { return a = a + b; }

// The 6-vector with parts of type Vector, Vec3 or Vec3f.
template <class Vector>
using TwistOf = std::conditional_t<std::is_same_v<Vector, Vec3>, Twist, Twistf>;

// The larger norm of the two parts.
SCREE_HD Real largest_part(Twist a) {
  const Real move = norm(a.move), turn = norm(a.turn);
  return move > turn ? move : turn;
}

// 3 x 3 matrix by rows.
struct Mat3 {
  Vec3 x, y, z;
};
SCREE_HD Vec3 operator*(const Mat3& a, Vec3 v) { return {dot(a.x, v), dot(a.y, v), dot(a.z, v)}; }
SCREE_HD Vec3 transposed_times(const Mat3& a, Vec3 v) { return v.x * a.x + v.y * a.y + v.z * a.z; }
SCREE_HD Mat3& operator+=(Mat3& a, const Mat3& b) {
  a.x += b.x, a.y += b.y, a.z += b.z;
  return a;
}
// s a b^T.
SCREE_HD Mat3 outer(Real s, Vec3 a, Vec3 b) { return {(s * a.x) * b, (s * a.y) * b, (s * a.z) * b}; }

// Symmetric block [move, mixed; mixed^T, turn].
struct Block6 {
  Sym3 move, turn;
  Mat3 mixed;
};

// Largest sum of |entries| over the rows, with row and column k scaled by the root of 1 / mass of its part:
// an upper bound of the eigenvalues of the block relative to the masses.
SCREE_HD Real largest_row(const Block6& a, Real mass, Real inertia) {
  const Real between = 1 / std::sqrt(mass * inertia);
  const auto size = [](Vec3 v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); };
  const auto rows = [&](const Sym3& s, Real own, Vec3 mixed) {
    const Real x = size({s.xx, s.xy, s.xz}) / own + between * mixed.x,
               y = size({s.xy, s.yy, s.yz}) / own + between * mixed.y,
               z = size({s.xz, s.yz, s.zz}) / own + between * mixed.z;
    return x > y ? (x > z ? x : z) : (y > z ? y : z);
  };
  const Mat3& m = a.mixed;
  const Real move = rows(a.move, mass, {size(m.x), size(m.y), size(m.z)});
  const Real turn =
      rows(a.turn, inertia,
           {size({m.x.x, m.y.x, m.z.x}), size({m.x.y, m.y.y, m.z.y}), size({m.x.z, m.y.z, m.z.z})});
  return move > turn ? move : turn;
}

// A symmetric 6 x 6 block in single precision, for preconditioners.
struct Block6f {
  static constexpr int kNumbers = 21;
  float value[kNumbers];

  // Inverse of a positive definite block, through the Schur complement of `move`.
  SCREE_HD static Block6f inverse_of(const Block6& a) {
    const Sym3 first = inverse(a.move);
    const auto column = [&](Real x, Real y, Real z) { return first * Vec3{x, y, z}; };
    const Mat3& b = a.mixed;
    // t = first b, by columns.
    const Vec3 t0 = column(b.x.x, b.y.x, b.z.x), t1 = column(b.x.y, b.y.y, b.z.y),
               t2 = column(b.x.z, b.y.z, b.z.z);
    const auto b_t = [&](Vec3 t) { return transposed_times(b, t); };
    const Vec3 s0 = b_t(t0), s1 = b_t(t1), s2 = b_t(t2);
    Sym3 rest = a.turn;
    rest += Sym3{-s0.x, -s1.x, -s2.x, -s1.y, -s2.y, -s2.z};
    const Sym3 turn = inverse(rest);
    // mixed = -t turn, and move = first + t turn t^T, by rows of t.
    const Vec3 rows[3] = {{t0.x, t1.x, t2.x}, {t0.y, t1.y, t2.y}, {t0.z, t1.z, t2.z}};
    const Vec3 m[3] = {turn * rows[0], turn * rows[1], turn * rows[2]};
    const Real entries[kNumbers] = {first.xx + dot(m[0], rows[0]),
                                    first.xy + dot(m[0], rows[1]),
                                    first.xz + dot(m[0], rows[2]),
                                    first.yy + dot(m[1], rows[1]),
                                    first.yz + dot(m[1], rows[2]),
                                    first.zz + dot(m[2], rows[2]),
                                    turn.xx,
                                    turn.xy,
                                    turn.xz,
                                    turn.yy,
                                    turn.yz,
                                    turn.zz,
                                    -m[0].x,
                                    -m[0].y,
                                    -m[0].z,
                                    -m[1].x,
                                    -m[1].y,
                                    -m[1].z,
                                    -m[2].x,
                                    -m[2].y,
                                    -m[2].z};
    Block6f out;
    for (int k = 0; k < kNumbers; ++k) out.value[k] = static_cast<float>(entries[k]);
    return out;
  }

  SCREE_HD Twistf operator*(Twistf v) const {
    const float* a = value;
    const auto symmetric = [](const float* s, Vec3f w) -> Vec3f {
      return {s[0] * w.x + s[1] * w.y + s[2] * w.z, s[1] * w.x + s[3] * w.y + s[4] * w.z,
              s[2] * w.x + s[4] * w.y + s[5] * w.z};
    };
    const Vec3f x{a[12], a[13], a[14]}, y{a[15], a[16], a[17]}, z{a[18], a[19], a[20]};
    return {symmetric(a, v.move) + Vec3f{dot(x, v.turn), dot(y, v.turn), dot(z, v.turn)},
            v.move.x * x + v.move.y * y + v.move.z * z + symmetric(a + 6, v.turn)};
  }
};

}  // namespace scree
