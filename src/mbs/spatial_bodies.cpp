// Spatial bodies: positions r [m] and a quaternion p, velocities r' [m/s] and the angular velocity w in the
// body's frame [rad/s]; a displacement gives r + u_r, p exp(u_pi). With M = diag(m, m, m, J) the gyroscopic
// torque -w x J w is one of the forces.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.hpp"
#include "mbs/primitive_function.hpp"
#include "mbs/rigid_bodies.hpp"
#include "physics/energy.hpp"
#include "physics/spatial_rotation.hpp"
#include "physics/time_stepping.hpp"

namespace scree {

namespace {

Vec3 vec3(const Real* v) { return {v[0], v[1], v[2]}; }
void write(Vec3 v, Real* out) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }
Quaternion quaternion(const Real* p) { return {p[0], p[1], p[2], p[3]}; }
void write(const Quaternion& p, Real* out) { out[0] = p.w, out[1] = p.x, out[2] = p.y, out[3] = p.z; }

// Writes the spatial components only; those of planar bodies keep their values.
void write_motion(Vec3 position, const Quaternion& orientation, Vec3 velocity, Vec3 spin,
                  BodyMotion& motion) {
  motion.position = position, motion.velocity = velocity;
  motion.kind = BodyKind::spatial, motion.orientation = orientation, motion.spin = spin;
}

// The 3x3 block (i, j) of a packed symmetric 6x6 block; 0: forces, 1: torques.
Mat3 block_of(const std::array<Real, 21>& packed, int i, int j) {
  const auto at = [&](int row, int column) {
    const int r = 3 * i + row, c = 3 * j + column;
    return packed[static_cast<std::size_t>(packed6(std::min(r, c), std::max(r, c)))];
  };
  return {{at(0, 0), at(0, 1), at(0, 2)}, {at(1, 0), at(1, 1), at(1, 2)}, {at(2, 0), at(2, 1), at(2, 2)}};
}

// Transforms torques and rotations from the global frame to the body's.
Mat3 in_own_frame(const Mat3& block, const Mat3& rotation, int i, int j) {
  const Mat3 rows = i == 1 ? transposed(rotation) * block : block;
  return j == 1 ? rows * rotation : rows;
}

void add_passing(const Mat3& stiffness, const Mat3& damping, int row, int column,
                 SystemDerivatives& derivatives) {
  const Vec3 k[] = {stiffness.x, stiffness.y, stiffness.z}, c[] = {damping.x, damping.y, damping.z};
  for (int i = 0; i < 3; ++i) {
    derivatives.add_passing(row + i, column, k[i].x, c[i].x);
    derivatives.add_passing(row + i, column + 1, k[i].y, c[i].y);
    derivatives.add_passing(row + i, column + 2, k[i].z, c[i].z);
  }
}

class SpatialBodies final : public RigidBodies {
 public:
  SpatialBodies(const Model& model, const BodyLayout& layout) : gravity_(model.gravity) {
    for (int b = 0; b < layout.bodies(); ++b) {
      const Body& body = model.bodies[static_cast<std::size_t>(b)];
      if (body.kind != BodyKind::spatial) continue;
      bodies_.push_back({{b, layout.position(b), layout.column(b)},
                         body.mass,
                         full(body.inertia_tensor),
                         may_be_stiffened(model, body)});
      given_.push_back(body);
    }
  }

  void start(std::vector<Real>& position, std::vector<Real>& velocity) const override {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      Real *q = bodies_[i].at.in(position), *v = bodies_[i].at.of(velocity);
      write(given_[i].position, q), write(given_[i].orientation, q + 3);
      write(given_[i].velocity, v), write(given_[i].spin, v + 3);
    }
  }
  void set_poses(const std::vector<Real>& position, const std::vector<Real>& velocity,
                 BodyPoses& poses) const override {
    for (const BodyData& b : bodies_) {
      const Real *q = b.at.in(position), *v = b.at.of(velocity);
      SpatialPose& pose = poses.spatial[b.at.body];
      pose.position = vec3(q), pose.rotation = rotation_matrix(quaternion(q + 3));
      pose.velocity = vec3(v), pose.spin = vec3(v + 3);
    }
  }
  void displace(const std::vector<Real>& start, const std::vector<Real>& displacement,
                std::vector<Real>& position) const override {
    for (const BodyData& b : bodies_) {
      const Real *from = b.at.in(start), *u = b.at.of(displacement);
      const Vec3 turn = vec3(u + 3);
      if (norm(turn) >= M_PI)
        throw SimulationError(fmt::format(
            "mbs_correct, rank 0: body '{}' (id {}) rotates by more than half a revolution in a step; "
            "time.step is too long",
            given_[static_cast<std::size_t>(&b - bodies_.data())].name, b.at.body));
      Real* to = b.at.in(position);
      write(vec3(from) + vec3(u), to);
      write(normalized(quaternion(from + 3) * exponential(turn)), to + 3);
    }
  }
  void pull_back(const std::vector<Real>& displacement, std::vector<Real>& change) const override {
    for (const BodyData& b : bodies_) {
      Real* turn = b.at.of(change) + 3;
      write(inverse_tangent(vec3(b.at.of(displacement) + 3)) * vec3(turn), turn);
    }
  }
  void set_tangents(const std::vector<Real>& displacement, BodyPoses& poses) const override {
    for (const BodyData& b : bodies_)
      poses.spatial[b.at.body].inverse_tangent = inverse_tangent(vec3(b.at.of(displacement) + 3));
  }

  void set_scale(Real length, std::vector<Real>& coordinate_scale) const override {
    for (const BodyData& b : bodies_) {
      Real* scale = b.at.of(coordinate_scale);
      write(Vec3{length, length, length}, scale), write(Vec3{1, 1, 1}, scale + 3);
    }
  }
  void add_mass(SparseTerm& mass) const override {
    for (const BodyData& b : bodies_) {
      for (int k = 0; k < 3; ++k) mass.add(b.at.column + k, b.at.column + k, b.mass);
      add_block(mass, b.rotation_column(), b.rotation_column(), b.inertia);
    }
  }
  void add_inverse_mass(SparseTerm& inverse) const override {
    for (const BodyData& b : bodies_) {
      for (int k = 0; k < 3; ++k) inverse.add(b.at.column + k, b.at.column + k, 1 / b.mass);
      add_block(inverse, b.rotation_column(), b.rotation_column(), scree::inverse(b.inertia));
    }
  }
  void set_weight(std::vector<Real>& force) const override {
    for (const BodyData& b : bodies_) write(b.mass * gravity_, b.at.of(force));
  }
  Real weight_scale(Real length) const override {
    Real largest = 0;
    for (const BodyData& b : bodies_) largest = std::max(largest, length * b.mass * norm(gravity_));
    return largest;
  }

  // The torque -w x J w, and its derivative by the angular velocity, -(w~ J - (J w)~).
  Real add_inertial_force(const BodyPoses& poses, std::vector<Real>& force) const override {
    Real largest = 0;
    for (const BodyData& b : bodies_) {
      const Vec3 torque = gyroscopic_torque(b.inertia, poses.spatial[b.at.body].spin);
      Real* f = b.at.of(force) + 3;
      write(vec3(f) + torque, f);
      largest = std::max(largest, norm(torque));
    }
    return largest;
  }
  void add_inertial_derivatives(const BodyPoses& poses, SystemDerivatives& derivatives) const override {
    for (const BodyData& b : bodies_) {
      const SpatialPose& pose = poses.spatial[b.at.body];
      const Mat3 tangent = pose.inverse_tangent;
      add_block(derivatives.tangent_inertia, b.rotation_column(), b.rotation_column(),
                b.inertia * (tangent - identity3()));
      const Mat3 damping = tilde(pose.spin) * b.inertia - tilde(b.inertia * pose.spin);
      add_block(derivatives.damping, b.rotation_column(), b.rotation_column(), damping * tangent);
    }
  }

  void set_contact_stiffness(const std::vector<WrenchStiffness>& touched) override {
    touched_.clear();
    for (const WrenchStiffness& one : touched) touched_[one.body] = one;
  }
  bool wrench_in_matrix() const override {
    return std::ranges::any_of(bodies_, [](const BodyData& b) { return b.touchable; });
  }
  Real add_contact(const BodyPoses& poses, const std::vector<BodyWrench>& wrench, Real length,
                   std::vector<Real>& force) const override {
    Real largest = 0;
    for (const BodyData& b : bodies_) {
      const BodyWrench& w = wrench[static_cast<std::size_t>(b.at.body)];
      Real* f = b.at.of(force);
      write(vec3(f) + w.force, f);
      write(vec3(f + 3) + poses.spatial[b.at.body].rotate_back(w.torque), f + 3);
      const auto touched = touched_.find(b.at.body);
      Real stiffness = 0;
      if (touched != touched_.end())
        for (int k = 0; k < 3; ++k)
          stiffness = std::max(stiffness, touched->second.stiffness[static_cast<std::size_t>(packed6(k, k))]);
      largest = std::max(
          {largest, length * std::max(norm(w.force), kElasticFloor * stiffness * length), norm(w.torque)});
    }
    return largest;
  }
  // Derivatives by the body's own rotations dpi: the contact's block multiplies A dpi, and the torque A^T
  // tau rotates with the body, -(A^T tau)~.
  void add_contact_derivatives(const BodyPoses& poses, const std::vector<BodyWrench>& wrench,
                               SystemDerivatives& derivatives) const override {
    static const WrenchStiffness none;
    for (const BodyData& b : bodies_) {
      const auto found = touched_.find(b.at.body);
      if (!b.touchable && found == touched_.end()) continue;
      const SpatialPose& pose = poses.spatial[b.at.body];
      const WrenchStiffness& contact = found == touched_.end() ? none : found->second;
      const Vec3 torque = pose.rotate_back(wrench[static_cast<std::size_t>(b.at.body)].torque);
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) {
          const int row = b.at.column + 3 * i, column = b.at.column + 3 * j;
          Mat3 k = in_own_frame(block_of(contact.stiffness, i, j), pose.rotation, i, j);
          if (i == 1 && j == 1) k = k - tilde(torque);
          Mat3 c = in_own_frame(block_of(contact.damping, i, j), pose.rotation, i, j);
          if (j == 1) c = c * pose.inverse_tangent;
          if (b.touchable)
            add_block(derivatives.stiffness, row, column, k), add_block(derivatives.damping, row, column, c);
          else
            add_passing(k, c, row, column, derivatives);
        }
    }
  }

  void subtract_commutator(const MultibodyState& state, std::vector<Real>& rate) const override {
    for (const BodyData& b : bodies_) {
      Real* turn = b.at.of(rate) + 3;
      const Vec3 w = vec3(b.at.of(state.velocity) + 3), up = vec3(b.at.of(state.acceleration) + 3);
      write(vec3(turn) - rotation_drift(1, w, up), turn);
    }
  }
  // Newmark's change of the rotation vector lacks the commutator term.
  Real error(const HhtMethod& step, Real length) const override {
    const Real h = step.step();
    Real largest = 0;
    for (const BodyData& b : bodies_) {
      const Real *a0 = b.at.of(step.start_acceleration()), *a1 = b.at.of(step.acceleration());
      const Vec3 w = vec3(b.at.of(step.velocity()) + 3);
      const Vec3 turn = (step.coefficients().error_constant * h * h) * (vec3(a1 + 3) - vec3(a0 + 3)) -
                        rotation_drift(h * h * h, w, vec3(a1 + 3));
      largest = larger_error(largest, norm(turn));
      largest = larger_error(largest, hht_position_error(step.coefficients(), h, vec3(a0), vec3(a1), length));
    }
    return largest;
  }
  void add_integrator_loss(const MultibodyState& start, const MultibodyState& end,
                           Real& loss) const override {
    for (const BodyData& b : bodies_) {
      const Real *q0 = b.at.in(start.position), *q1 = b.at.in(end.position), *v0 = b.at.of(start.velocity),
                 *v1 = b.at.of(end.velocity), *f0 = b.at.of(start.applied), *f1 = b.at.of(end.applied);
      loss += integrator_loss(b.mass, vec3(q1) - vec3(q0), vec3(v0), vec3(v1), vec3(f0), vec3(f1));
      const Vec3 turn = rotation_vector(conjugate(quaternion(q0 + 3)) * quaternion(q1 + 3));
      const Vec3 w0 = vec3(v0 + 3), w1 = vec3(v1 + 3);
      loss += rotation_loss(b.inertia, turn, w0, w1, vec3(f0 + 3) - gyroscopic_torque(b.inertia, w0),
                            vec3(f1 + 3) - gyroscopic_torque(b.inertia, w1));
    }
  }
  void add_energies(const MultibodyState& state, MultibodyEnergies& energies) const override {
    for (const BodyData& b : bodies_) {
      const Real* v = b.at.of(state.velocity);
      energies.kinetic += kinetic_energy(b.mass, vec3(v)) + rotational_energy(b.inertia, vec3(v + 3));
      energies.gravitational += gravitational_energy(b.mass, gravity_, vec3(b.at.in(state.position)));
    }
  }

  void motion(const std::vector<Real>& position, const std::vector<Real>& velocity,
              std::vector<BodyMotion>& out) const override {
    for (const BodyData& b : bodies_) {
      const Real *q = b.at.in(position), *v = b.at.of(velocity);
      write_motion(vec3(q), quaternion(q + 3), vec3(v), vec3(v + 3),
                   out[static_cast<std::size_t>(b.at.body)]);
    }
  }
  void motion_after(const MultibodyState& state, Real tau, std::vector<BodyMotion>& out) const override {
    for (const BodyData& b : bodies_) {
      const Real *q = b.at.in(state.position), *v = b.at.of(state.velocity), *a = b.at.of(state.acceleration);
      const auto moved = [&](int k) { return tau * vec3(v + k) + (tau * tau / 2) * vec3(a + k); };
      // A second normalization can change the last bit, by which a restart would differ.
      const Quaternion p = quaternion(q + 3),
                       orientation = tau == 0 ? p : normalized(p * exponential(moved(3)));
      write_motion(vec3(q) + moved(0), orientation, vec3(v) + tau * vec3(a), vec3(v + 3) + tau * vec3(a + 3),
                   out[static_cast<std::size_t>(b.at.body)]);
    }
  }

 private:
  // The data of a body that every step reads, without the names and shapes of the model's bodies, which
  // would slow the loop.
  struct BodyData {
    BodyOffsets at;
    Real mass;
    Mat3 inertia;    // J
    bool touchable;  // Newton's matrix has a place for its contacts

    int rotation_column() const { return at.column + 3; }
  };

  Vec3 gravity_;
  std::vector<BodyData> bodies_;
  std::vector<Body> given_;                 // the bodies as the model has them
  std::map<int, WrenchStiffness> touched_;  // by body
};

}  // namespace

std::unique_ptr<RigidBodies> spatial_bodies(const Model& model, const BodyLayout& layout) {
  return std::make_unique<SpatialBodies>(model, layout);
}

}  // namespace scree
