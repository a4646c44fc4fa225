#include "mbs/bushing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "physics/spatial_rotation.hpp"

namespace scree {

namespace {

const SpatialPose& pose(const SpatialMotion& motion, const SpatialPair& pair, std::size_t block) {
  return motion[pair.body[block / 2]];
}
Vec3 velocity(const SpatialMotion& motion, const SpatialPair& pair, std::size_t block) {
  const SpatialPose& body = pose(motion, pair, block);
  return block % 2 == 0 ? body.velocity : body.spin;
}

Real rate_of(const PairGradient& g, const SpatialMotion& motion, const SpatialPair& pair) {
  Real rate = 0;
  for (std::size_t m = 0; m < 4; ++m) rate += dot(g[m], velocity(motion, pair, m));
  return rate;
}

Vec3 three(const std::array<Real, 6>& x, std::size_t from) { return {x[from], x[from + 1], x[from + 2]}; }

}  // namespace

BushingElement::BushingElement(const Bushing& bushing, const BodyLayout& layout) : bushing_(bushing) {
  const SpatialPair pair = spatial_pair(layout, bushing.body, bushing.point);
  const Mat3 axes = transposed(rotation_matrix(bushing.marker[0]));
  for (int k = 0; k < 3; ++k) primitives_.push_back(dot2_primitive(pair, row_of(axes, k)));
  if (!bushing.resists_rotation()) return;
  for (int k = 0; k < 3; ++k) primitives_.push_back(rotation_vector_primitive(pair, bushing.marker, k));
}

BushingElement::Deflection BushingElement::deflection(const BodyPoses& poses) const {
  Deflection x;
  for (std::size_t a = 0; a < primitives_.size(); ++a) {
    x.gradient[a] = primitives_[a]->gradient(poses.spatial);
    x.value[a] = primitives_[a]->value(poses.spatial);
    x.rate[a] = rate_of(x.gradient[a], poses.spatial, primitives_[a]->pair());
  }
  for (std::size_t a = 0; a < primitives_.size(); ++a) {
    x.tension[a] = bushing_.preload[a];
    for (std::size_t b = 0; b < primitives_.size(); ++b)
      x.tension[a] += bushing_.stiffness[a][b] * x.value[b] + bushing_.damping[a][b] * x.rate[b];
  }
  return x;
}

// The torques on the two bodies about the second point are opposite. Along the axes of the first frame the
// torque on the second body is -T^-1 s.
BushingLoad BushingElement::load(const BodyPoses& poses) const {
  const Deflection x = deflection(poses);
  BushingLoad load{three(x.value, 0), {}, -three(x.tension, 0), {}};
  if (primitives_.size() == 3) return load;
  load.turn = three(x.value, 3);
  load.torque = -(inverse_tangent(load.turn) * three(x.tension, 3));
  return load;
}

Real BushingElement::add_force(const BodyPoses& poses, Real, Real length, std::vector<Real>& force) {
  const Deflection x = deflection(poses);
  const Real rotation_angle = norm(three(x.value, 3));
  if (!(rotation_angle < kMaxBushingRotation))
    throw SimulationError(fmt::format(
        "mbs_correct, rank 0: bushing '{}' is rotated by {:.4g} rad; its rotation vector is valid "
        "up to {} rad, as it jumps at half a revolution",
        bushing_.name, rotation_angle, kMaxBushingRotation));
  Real largest = 0;
  for (std::size_t a = 0; a < primitives_.size(); ++a) {
    Real size = std::abs(bushing_.preload[a]);
    for (std::size_t b = 0; b < primitives_.size(); ++b)
      size += std::abs(bushing_.stiffness[a][b] * x.value[b]) + std::abs(bushing_.damping[a][b] * x.rate[b]);
    largest = std::max(largest, size * (a < 3 ? length : 1));
    for (std::size_t i = 0; i < 4; ++i) {
      if (column(i) < 0) continue;
      Real* q = &force[static_cast<std::size_t>(column(i))];
      const Vec3 part = -x.tension[a] * x.gradient[a][i];
      q[0] += part.x, q[1] += part.y, q[2] += part.z;
    }
  }
  return largest;
}

void BushingElement::add_derivatives(const BodyPoses& poses, Real, SparseTerm& stiffness,
                                     SparseTerm& damping) const {
  const SpatialMotion& motion = poses.spatial;
  const SpatialPair& pair = primitives_.front()->pair();
  const Deflection x = deflection(poses);
  const std::size_t n = primitives_.size();
  PairHessian weighted_hessian{};                       // s_a H_a
  std::array<PairGradient, 6> hessian_rate{};           // H_b^T v
  std::array<PairGradient, 6> displacement_gradient{};  // T^-T g_b
  for (std::size_t b = 0; b < n; ++b) {
    PairHessian own{};
    primitives_[b]->add_hessian(motion, 1, own);
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t m = 0; m < 4; ++m) {
        hessian_rate[b][j] += transposed_times(own[m][j], velocity(motion, pair, m));
        weighted_hessian[m][j] = weighted_hessian[m][j] + x.tension[b] * own[m][j];
      }
      displacement_gradient[b][j] =
          j % 2 == 0 ? x.gradient[b][j]
                     : transposed_times(pose(motion, pair, j).inverse_tangent, x.gradient[b][j]);
    }
  }
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      Mat3 by_pose = weighted_hessian[i][j], by_rate{};
      for (std::size_t a = 0; a < n; ++a) {
        Vec3 elastic, viscous;
        for (std::size_t b = 0; b < n; ++b) {
          elastic +=
              bushing_.stiffness[a][b] * x.gradient[b][j] + bushing_.damping[a][b] * hessian_rate[b][j];
          viscous += bushing_.damping[a][b] * displacement_gradient[b][j];
        }
        by_pose = by_pose + outer(1, x.gradient[a][i], elastic);
        by_rate = by_rate + outer(1, x.gradient[a][i], viscous);
      }
      add_block(stiffness, column(i), column(j), by_pose);
      add_block(damping, column(i), column(j), by_rate);
    }
}

void BushingElement::add_powers(const BodyPoses& poses, Real, Powers& powers) const {
  const Deflection x = deflection(poses);
  for (std::size_t a = 0; a < 6; ++a)
    for (std::size_t b = 0; b < 6; ++b) powers.dissipated += x.rate[a] * bushing_.damping[a][b] * x.rate[b];
}

Real BushingElement::elastic_energy(const BodyPoses& poses) const {
  const Deflection x = deflection(poses);
  Real energy = 0;
  for (std::size_t a = 0; a < 6; ++a) {
    energy += bushing_.preload[a] * x.value[a];
    for (std::size_t b = 0; b < 6; ++b) energy += x.value[a] * bushing_.stiffness[a][b] * x.value[b] / 2;
  }
  return energy;
}

Real BushingElement::elastic_scale(Real length) const {
  Real largest = 0;
  for (std::size_t a = 0; a < 6; ++a)
    largest = std::max(largest, bushing_.stiffness[a][a] * (a < 3 ? length * length : 1));
  return largest;
}

}  // namespace scree
