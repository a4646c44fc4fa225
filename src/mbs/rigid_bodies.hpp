// The operations on bodies that depend on how a pose is stored: planar or spatial.
#pragma once

#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include "mbs/body_poses.hpp"
#include "mbs/hht_method.hpp"
#include "mbs/mechanical_system.hpp"
#include "mbs/multibody.hpp"
#include "model/data/body_exchange.hpp"
#include "model/data/model.hpp"

namespace scree {

// Positions of size 1 carry round-off of 1e-16; a force of stiffness times 1e-6 of the length scale stays
// far above it, and a residual of 1e-8 of that force moves a body by 1e-14 of the length scale.
inline constexpr Real kElasticFloor = 1e-6;

// Offsets of a body's entries in the model and in the vectors of the system.
struct BodyOffsets {
  int body = 0;
  int position = 0, column = 0;  // first of its own

  Real* in(std::vector<Real>& positions) const { return &positions[static_cast<std::size_t>(position)]; }
  const Real* in(const std::vector<Real>& positions) const {
    return &positions[static_cast<std::size_t>(position)];
  }
  Real* of(std::vector<Real>& columns) const { return &columns[static_cast<std::size_t>(column)]; }
  const Real* of(const std::vector<Real>& columns) const {
    return &columns[static_cast<std::size_t>(column)];
  }
};

// Maximum that is not a number if one argument is not: no step passes as exact because a comparison was
// false.
inline Real larger_error(Real a, Real b) { return std::isnan(a) || a > b ? a : b; }

// Whether Newton's matrix has entries for the stiffness of contacts on a body. Explicit steps have no such
// stiffness.
inline bool may_be_stiffened(const Model& model, const Body& body) {
  const bool implicit = model.integrator.particles == ParticleIntegrator::hht;
  return !body.shapes.empty() || (implicit && !body.meshes.empty());
}

// Vectors of positions, velocities and forces are those of the whole system; each kind reads and writes the
// entries of its bodies by the layout. Vectors over bodies are in the model's order.
class RigidBodies {
 public:
  virtual ~RigidBodies() = default;

  // Writes the start at t = 0; position: [positions], velocity: [columns].
  virtual void start(std::vector<Real>& position, std::vector<Real>& velocity) const = 0;
  virtual void set_poses(const std::vector<Real>& position, const std::vector<Real>& velocity,
                         BodyPoses& poses) const = 0;
  // The body's part of MechanicalSystem::displace() and pull_back().
  virtual void displace(const std::vector<Real>& start, const std::vector<Real>& displacement,
                        std::vector<Real>& position) const = 0;
  virtual void pull_back(const std::vector<Real>& displacement, std::vector<Real>& change) const = 0;

  // Sets T^-1 at the end of a displacement, for subsequent evaluations with these poses.
  virtual void set_tangents(const std::vector<Real>& displacement, BodyPoses& poses) const = 0;

  // length: of the system [m].
  virtual void set_scale(Real length, std::vector<Real>& coordinate_scale) const = 0;
  virtual void add_mass(SparseTerm& mass) const = 0;
  virtual void add_inverse_mass(SparseTerm& inverse) const = 0;
  virtual void set_weight(std::vector<Real>& force) const = 0;
  // Largest weight times the length [J].
  virtual Real weight_scale(Real length) const = 0;

  // Adds the inertial forces that M a does not contain; returns the largest contribution [J]. The
  // derivatives are -Q_v T^-1 and M (T^-1 - 1).
  virtual Real add_inertial_force(const BodyPoses& poses, std::vector<Real>& force) const = 0;
  virtual void add_inertial_derivatives(const BodyPoses& poses, SystemDerivatives& derivatives) const = 0;

  virtual void set_contact_stiffness(const std::vector<WrenchStiffness>& touched) = 0;
  // Whether contacts without stiffness have derivatives.
  virtual bool wrench_in_matrix() const = 0;
  // Adds the forces of the contacts; returns the largest contribution [J].
  virtual Real add_contact(const BodyPoses& poses, const std::vector<BodyWrench>& wrench, Real length,
                           std::vector<Real>& force) const = 0;
  virtual void add_contact_derivatives(const BodyPoses& poses, const std::vector<BodyWrench>& wrench,
                                       SystemDerivatives& derivatives) const = 0;

  // Subtracts w x w' / 12 of each spatial body from `rate` [columns], [rad/s^3].
  virtual void subtract_commutator(const MultibodyState& state, std::vector<Real>& rate) const = 0;
  // Scaled local error of the positions of an open step.
  virtual Real error(const HhtMethod& step, Real length) const = 0;
  virtual void add_integrator_loss(const MultibodyState& start, const MultibodyState& end,
                                   Real& loss) const = 0;
  virtual void add_energies(const MultibodyState& state, MultibodyEnergies& energies) const = 0;

  virtual void motion(const std::vector<Real>& position, const std::vector<Real>& velocity,
                      std::vector<BodyMotion>& out) const = 0;
  // Motion extrapolated by tau [s] from the state, under its accelerations.
  virtual void motion_after(const MultibodyState& state, Real tau, std::vector<BodyMotion>& out) const = 0;
};

std::unique_ptr<RigidBodies> planar_bodies(const Model& model, const BodyLayout& layout);
std::unique_ptr<RigidBodies> spatial_bodies(const Model& model, const BodyLayout& layout);

}  // namespace scree
