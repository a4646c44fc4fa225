// Kinematics of planar rigid bodies: two-vectors, poses, points fixed to bodies, and pairs of such points.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/rotation.hpp"
#include "base/types.hpp"
#include "model/data/body_layout.hpp"

namespace scree {

struct Vec2 {
  Real x = 0, y = 0;
};

inline Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
inline Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
inline Vec2 operator*(Real s, Vec2 a) { return {s * a.x, s * a.y}; }
inline Real dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
inline Vec2 perp(Vec2 a) { return {-a.y, a.x}; }  // rotated by +90 degrees
inline Real norm(Vec2 a) { return std::sqrt(dot(a, a)); }
inline Vec2 planar(Vec3 a) { return {a.x, a.y}; }

// Motion of one body; the ground's is the default. Position [m], velocity [m/s], angle [rad], spin [rad/s].
struct PlanarPose {
  Vec2 position, velocity;
  Real angle = 0, spin = 0;
  Rotation rotation;

  // A s: a body-fixed vector in the global frame.
  Vec2 turn(Vec2 s) const { return planar(rotation.turn({s.x, s.y, 0})); }
};

// Poses of the planar bodies at one instant; index kGround is the ground.
class PlanarMotion {
 public:
  explicit PlanarMotion(const BodyLayout& layout) : poses_(static_cast<std::size_t>(layout.bodies()) + 1) {}
  // Sets the pose of one body; position, velocity: (x, y, angle) and rates.
  void set(int body, const Real* q, const Real* v) {
    PlanarPose& pose = poses_[static_cast<std::size_t>(body + 1)];
    pose.position = {q[0], q[1]}, pose.velocity = {v[0], v[1]}, pose.spin = v[2];
    // Successive calls are often at the same instant, and the angle of many bodies does not change.
    const Real angle = q[2];
    if (std::bit_cast<std::uint64_t>(angle) == std::bit_cast<std::uint64_t>(pose.angle)) return;
    pose.angle = angle, pose.rotation = Rotation(angle);
  }
  const PlanarPose& operator[](int body) const { return poses_[static_cast<std::size_t>(body + 1)]; }

 private:
  std::vector<PlanarPose> poses_;  // the ground first
};

// Two bodies and a point fixed to each.
struct PointPair {
  int body[2] = {kGround, kGround};
  Vec2 point[2];             // s_i, in the body frames [m]
  int column[2] = {-1, -1};  // first column of each body, -1: of the ground
};

inline PointPair point_pair(const BodyLayout& layout, const int (&body)[2], const Vec3 (&point)[2]) {
  PointPair pair{{body[0], body[1]}, {planar(point[0]), planar(point[1])}};
  for (int i = 0; i < 2; ++i)
    if (body[i] != kGround) pair.column[i] = layout.column(body[i]);
  return pair;
}

// Geometry of the pair at one instant: a_i = A_i s_i, d = P_2 - P_1 with P_i = r_i + a_i, and its rate.
struct PairGeometry {
  Vec2 arm[2];      // a_i [m]
  Vec2 gap;         // d [m]
  Vec2 gap_rate;    // d' = v_2 + w_2 perp(a_2) - v_1 - w_1 perp(a_1) [m/s]
  Vec2 gap_second;  // the part of d'' without accelerations: w_1^2 a_1 - w_2^2 a_2 [m/s^2]
};

inline PairGeometry pair_geometry(const PointPair& pair, const PlanarMotion& motion) {
  const PlanarPose &one = motion[pair.body[0]], &two = motion[pair.body[1]];
  PairGeometry g;
  g.arm[0] = one.turn(pair.point[0]);
  g.arm[1] = two.turn(pair.point[1]);
  g.gap = (two.position + g.arm[1]) - (one.position + g.arm[0]);
  g.gap_rate = two.velocity + two.spin * perp(g.arm[1]) - (one.velocity + one.spin * perp(g.arm[0]));
  g.gap_second = one.spin * one.spin * g.arm[0] - two.spin * two.spin * g.arm[1];
  return g;
}

// Derivative of w.d, w held fixed, by the pair's six coordinates: [-w, -w.perp(a_1), w, w.perp(a_2)].
inline std::array<Real, 6> gap_gradient(const PairGeometry& g, Vec2 w) {
  return {-w.x, -w.y, -dot(w, perp(g.arm[0])), w.x, w.y, dot(w, perp(g.arm[1]))};
}

// The six coordinates (x, y, angle of body 1, then of body 2) of a pair in the system's vector of
// coordinates. -1: not a coordinate, because the body is the ground or because nothing can depend on it.
using PairCoordinates = std::array<int, 6>;

inline PairCoordinates pair_coordinates(const PointPair& pair) {
  PairCoordinates index;
  for (int k = 0; k < 6; ++k) {
    const int first = pair.column[k / 3];
    index[static_cast<std::size_t>(k)] = first < 0 ? -1 : first + k % 3;
  }
  return index;
}

// Omits the angle of a body whose point is its centre, as that point does not move with the angle.
inline PairCoordinates point_coordinates(const PointPair& pair) {
  PairCoordinates index = pair_coordinates(pair);
  for (int i = 0; i < 2; ++i) {
    if (pair.point[i].x == 0 && pair.point[i].y == 0) index[static_cast<std::size_t>(3 * i + 2)] = -1;
  }
  return index;
}

}  // namespace scree
