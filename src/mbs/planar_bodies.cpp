// Planar bodies: positions x, y [m] and angle [rad], velocities their rates; displacements u are added to
// positions, T = 1.
#include <algorithm>
#include <array>
#include <cmath>

#include "mbs/rigid_bodies.hpp"
#include "physics/energy.hpp"
#include "physics/time_stepping.hpp"

namespace scree {

namespace {

// The planar part (x, y, rz) of a packed 6x6 block.
constexpr int kPlanarRows[3] = {0, 1, 5};

std::array<Real, 9> planar_block(const std::array<Real, 21>& packed) {
  std::array<Real, 9> block;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const int row = kPlanarRows[std::min(i, j)], column = kPlanarRows[std::max(i, j)];
      block[static_cast<std::size_t>(3 * i + j)] = packed[static_cast<std::size_t>(packed6(row, column))];
    }
  }
  return block;
}

// Writes the planar components only; those of spatial bodies keep their values.
void write_motion(const Real* q, const Real* v, Real z, BodyMotion& motion) {
  motion.position = {q[0], q[1], z}, motion.velocity = {v[0], v[1], 0};
  motion.angle = q[2], motion.angular_velocity = v[2];
}

class PlanarBodies final : public RigidBodies {
 public:
  PlanarBodies(const Model& model, const BodyLayout& layout)
      : gravity_(model.gravity), contact_(model.bodies.size()) {
    for (int b = 0; b < layout.bodies(); ++b) {
      const Body& body = model.bodies[static_cast<std::size_t>(b)];
      if (body.kind != BodyKind::planar) continue;
      const Constants constants{body.mass,
                                body.inertia,
                                body.position,
                                body.angle,
                                body.velocity,
                                body.angular_velocity,
                                may_be_stiffened(model, body)};
      bodies_.push_back({constants, {b, layout.position(b), layout.column(b)}});
    }
  }

  void start(std::vector<Real>& position, std::vector<Real>& velocity) const override {
    for (const BodyData& b : bodies_) {
      Real *q = b.at.in(position), *v = b.at.of(velocity);
      q[0] = b.body.position.x, q[1] = b.body.position.y, q[2] = b.body.angle;
      v[0] = b.body.velocity.x, v[1] = b.body.velocity.y, v[2] = b.body.angular_velocity;
    }
  }
  void set_poses(const std::vector<Real>& position, const std::vector<Real>& velocity,
                 BodyPoses& poses) const override {
    for (const BodyData& b : bodies_) poses.planar.set(b.at.body, b.at.in(position), b.at.of(velocity));
  }
  void displace(const std::vector<Real>& start, const std::vector<Real>& displacement,
                std::vector<Real>& position) const override {
    for (const BodyData& b : bodies_) {
      const Real *from = b.at.in(start), *u = b.at.of(displacement);
      Real* to = b.at.in(position);
      for (int k = 0; k < 3; ++k) to[k] = from[k] + u[k];
    }
  }
  void pull_back(const std::vector<Real>&, std::vector<Real>&) const override {}

  void set_tangents(const std::vector<Real>&, BodyPoses&) const override {}

  void set_scale(Real length, std::vector<Real>& coordinate_scale) const override {
    for (const BodyData& b : bodies_) {
      Real* scale = b.at.of(coordinate_scale);
      scale[0] = scale[1] = length, scale[2] = 1;
    }
  }
  void add_mass(SparseTerm& mass) const override {
    for (const BodyData& b : bodies_) {
      mass.add(b.at.column, b.at.column, b.body.mass);
      mass.add(b.at.column + 1, b.at.column + 1, b.body.mass);
      mass.add(b.at.column + 2, b.at.column + 2, b.body.inertia);
    }
  }
  void add_inverse_mass(SparseTerm& inverse) const override {
    for (const BodyData& b : bodies_) {
      inverse.add(b.at.column, b.at.column, 1 / b.body.mass);
      inverse.add(b.at.column + 1, b.at.column + 1, 1 / b.body.mass);
      inverse.add(b.at.column + 2, b.at.column + 2, 1 / b.body.inertia);
    }
  }
  void set_weight(std::vector<Real>& force) const override {
    for (const BodyData& b : bodies_) {
      b.at.of(force)[0] = b.body.mass * gravity_.x;
      b.at.of(force)[1] = b.body.mass * gravity_.y;
    }
  }
  Real weight_scale(Real length) const override {
    Real largest = 0;
    for (const BodyData& b : bodies_)
      largest = std::max(largest, length * b.body.mass * norm(planar(gravity_)));
    return largest;
  }

  Real add_inertial_force(const BodyPoses&, std::vector<Real>&) const override { return 0; }
  void add_inertial_derivatives(const BodyPoses&, SystemDerivatives&) const override {}

  void set_contact_stiffness(const std::vector<WrenchStiffness>& touched) override {
    for (const int body : touched_) contact_[static_cast<std::size_t>(body)] = {};
    touched_.clear();
    for (const WrenchStiffness& one : touched) {
      contact_[static_cast<std::size_t>(one.body)] = {planar_block(one.stiffness), planar_block(one.damping)};
      touched_.push_back(one.body);
    }
  }
  bool wrench_in_matrix() const override { return false; }
  Real add_contact(const BodyPoses&, const std::vector<BodyWrench>& wrench, Real length,
                   std::vector<Real>& force) const override {
    Real largest = 0;
    for (const BodyData& b : bodies_) {
      const BodyWrench& w = wrench[static_cast<std::size_t>(b.at.body)];
      Real* f = b.at.of(force);
      f[0] += w.force.x;
      f[1] += w.force.y;
      f[2] += w.torque.z;
      const std::array<Real, 9>& block = contact_of(b.at.body).stiffness;
      const Real stiffness = std::max(block[0], block[4]);
      largest = std::max(largest, length * std::max(norm(w.force), kElasticFloor * stiffness * length));
    }
    return largest;
  }
  void add_contact_derivatives(const BodyPoses&, const std::vector<BodyWrench>&,
                               SystemDerivatives& derivatives) const override {
    for (const BodyData& b : bodies_) {
      const int coordinate[3] = {b.at.column, b.at.column + 1, b.at.column + 2};
      const ContactBlock& block = contact_of(b.at.body);
      if (!b.body.touchable) {
        add_passing(coordinate, block, derivatives);
        continue;
      }
      derivatives.stiffness.add_block(
          coordinate, [&](std::size_t i, std::size_t j) { return block.stiffness[3 * i + j]; });
      derivatives.damping.add_block(coordinate,
                                    [&](std::size_t i, std::size_t j) { return block.damping[3 * i + j]; });
    }
  }

  void subtract_commutator(const MultibodyState&, std::vector<Real>&) const override {}
  Real error(const HhtMethod& step, Real length) const override {
    Real largest = 0;
    for (const BodyData& b : bodies_) {
      const Real *a0 = b.at.of(step.start_acceleration()), *a1 = b.at.of(step.acceleration());
      const Vec3 shift0{a0[0], a0[1], 0}, shift1{a1[0], a1[1], 0}, turn0{0, 0, a0[2]}, turn1{0, 0, a1[2]};
      const auto error = [&](Vec3 from, Vec3 to, Real over) {
        return hht_position_error(step.coefficients(), step.step(), from, to, over);
      };
      largest = larger_error(larger_error(largest, error(shift0, shift1, length)), error(turn0, turn1, 1));
    }
    return largest;
  }
  void add_integrator_loss(const MultibodyState& start, const MultibodyState& end,
                           Real& loss) const override {
    for (const BodyData& b : bodies_) {
      const Real *q0 = b.at.in(start.position), *q1 = b.at.in(end.position);
      const Real *v0 = b.at.of(start.velocity), *v1 = b.at.of(end.velocity), *f0 = b.at.of(start.applied),
                 *f1 = b.at.of(end.applied);
      loss += integrator_loss(b.body.mass, shift(q1) - shift(q0), shift(v0), shift(v1), shift(f0), shift(f1));
      loss += integrator_loss(b.body.inertia, rotational(q1) - rotational(q0), rotational(v0), rotational(v1),
                              rotational(f0), rotational(f1));
    }
  }
  void add_energies(const MultibodyState& state, MultibodyEnergies& energies) const override {
    for (const BodyData& b : bodies_) {
      const Real* v = b.at.of(state.velocity);
      energies.kinetic +=
          kinetic_energy(b.body.mass, shift(v)) + kinetic_energy(b.body.inertia, rotational(v));
      energies.gravitational += gravitational_energy(b.body.mass, gravity_, shift(b.at.in(state.position)));
    }
  }

  void motion(const std::vector<Real>& position, const std::vector<Real>& velocity,
              std::vector<BodyMotion>& out) const override {
    for (const BodyData& b : bodies_)
      write_motion(b.at.in(position), b.at.of(velocity), b.body.position.z,
                   out[static_cast<std::size_t>(b.at.body)]);
  }
  void motion_after(const MultibodyState& state, Real tau, std::vector<BodyMotion>& out) const override {
    for (const BodyData& b : bodies_) {
      const Real *q0 = b.at.in(state.position), *v0 = b.at.of(state.velocity),
                 *a0 = b.at.of(state.acceleration);
      Real q[3], v[3];
      for (std::size_t k = 0; k < 3; ++k) {
        q[k] = q0[k] + tau * v0[k] + tau * tau / 2 * a0[k];
        v[k] = v0[k] + tau * a0[k];
      }
      write_motion(q, v, b.body.position.z, out[static_cast<std::size_t>(b.at.body)]);
    }
  }

 private:
  // The data of a body that every step reads, without the names and shapes of the model's bodies, which
  // would slow the loop.
  struct Constants {
    Real mass, inertia;
    Vec3 position;
    Real angle;
    Vec3 velocity;
    Real angular_velocity;
    bool touchable;  // Newton's matrix has a place for its contacts
  };
  struct BodyData {
    Constants body;
    BodyOffsets at;
  };
  // Stiffness of the contacts of a body, (x, y, angle) row by row.
  struct ContactBlock {
    std::array<Real, 9> stiffness{}, damping{};
  };

  // One shared block where nothing touches any body, so that the loop over bodies reads no other memory.
  const ContactBlock& contact_of(int body) const {
    static const ContactBlock none;
    return touched_.empty() ? none : contact_[static_cast<std::size_t>(body)];
  }
  static void add_passing(const int (&coordinate)[3], const ContactBlock& block,
                          SystemDerivatives& derivatives) {
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        derivatives.add_passing(coordinate[i], coordinate[j], block.stiffness[3 * i + j],
                                block.damping[3 * i + j]);
  }
  static Vec3 shift(const Real* v) { return {v[0], v[1], 0}; }
  static Vec3 rotational(const Real* v) { return {0, 0, v[2]}; }

  Vec3 gravity_;
  std::vector<BodyData> bodies_;
  std::vector<ContactBlock> contact_;  // per body of the model; zero where nothing touches
  std::vector<int> touched_;           // bodies with another contact_
};

}  // namespace

std::unique_ptr<RigidBodies> planar_bodies(const Model& model, const BodyLayout& layout) {
  return std::make_unique<PlanarBodies>(model, layout);
}

}  // namespace scree
