// Kinematics of spatial rigid bodies: poses, points fixed to bodies, and pairs of such points.
#pragma once

#include <vector>

#include "base/mat3.hpp"
#include "base/types.hpp"
#include "model/data/body_layout.hpp"

namespace scree {

// Motion of one body; the ground's is the default. spin: angular velocity in the body's frame [rad/s].
struct SpatialPose {
  Vec3 position, velocity, spin;
  Mat3 rotation = identity3();         // A, from the body's frame to the global one
  Mat3 inverse_tangent = identity3();  // T^-1 of the open step's displacement

  // A s, and A^T v below.
  Vec3 turn(Vec3 s) const { return rotation * s; }
  Vec3 rotate_back(Vec3 v) const { return transposed_times(rotation, v); }
  // Rate of A s, and its second derivative without accelerations: A w~ s, A w~ w~ s.
  Vec3 rotated_rate(Vec3 s) const { return turn(cross(spin, s)); }
  Vec3 rotated_second(Vec3 s) const { return turn(cross(spin, cross(spin, s))); }
};

// Poses of the spatial bodies at one instant; index kGround is the ground.
class SpatialMotion {
 public:
  explicit SpatialMotion(const BodyLayout& layout) : poses_(static_cast<std::size_t>(layout.bodies()) + 1) {}

  SpatialPose& operator[](int body) { return poses_[static_cast<std::size_t>(body + 1)]; }
  const SpatialPose& operator[](int body) const { return poses_[static_cast<std::size_t>(body + 1)]; }

  // Angle of a joint at the last accepted step, whole revolutions included [rad]; it selects the branch of
  // the angle nearest to it. 0 where none was set. number: angle_number (mbs/joint_parts.hpp).
  Real counted_angle(int number) const {
    const auto k = static_cast<std::size_t>(number);
    return k < counted_.size() ? counted_[k] : 0;
  }
  void set_counted_angle(int number, Real angle) {
    const auto k = static_cast<std::size_t>(number);
    if (k >= counted_.size()) counted_.resize(k + 1, 0);
    counted_[k] = angle;
  }

 private:
  std::vector<SpatialPose> poses_;  // the ground first
  std::vector<Real> counted_;       // by number
};

// Two bodies, a point fixed to each, and the first column of each.
struct SpatialPair {
  int body[2] = {kGround, kGround};
  Vec3 point[2];             // s_i, in the body frames [m]
  int column[2] = {-1, -1};  // -1: of the ground
};

inline SpatialPair spatial_pair(const BodyLayout& layout, const int (&body)[2], const Vec3 (&point)[2]) {
  SpatialPair pair{{body[0], body[1]}, {point[0], point[1]}};
  for (int i = 0; i < 2; ++i)
    if (body[i] != kGround) pair.column[i] = layout.column(body[i]);
  return pair;
}

// d = P_2 - P_1 with P_i = r_i + A_i s_i; its rate, and its second derivative without accelerations.
inline Vec3 gap(const SpatialPair& pair, const SpatialMotion& motion) {
  const SpatialPose &one = motion[pair.body[0]], &two = motion[pair.body[1]];
  return (two.position + two.turn(pair.point[1])) - (one.position + one.turn(pair.point[0]));
}
inline Vec3 gap_rate(const SpatialPair& pair, const SpatialMotion& motion) {
  const SpatialPose &one = motion[pair.body[0]], &two = motion[pair.body[1]];
  return (two.velocity + two.rotated_rate(pair.point[1])) - (one.velocity + one.rotated_rate(pair.point[0]));
}
inline Vec3 gap_second(const SpatialPair& pair, const SpatialMotion& motion) {
  return motion[pair.body[1]].rotated_second(pair.point[1]) -
         motion[pair.body[0]].rotated_second(pair.point[0]);
}

}  // namespace scree
