// Interface of the HHT method to a constrained mechanical system: M(q) a + Phi_q^T lambda = Q(v, q, t),
// Phi(q, t) = 0 (Jung, Jun, Sohn 2013, Eqs. 4-8). The velocities v need not be the rates of the positions q,
// nor have as many components: a step leads from q to displace(q, u), with the displacement u = h v + ...
// composed of velocities. For rotations u is a rotation vector (Bruls, Cardona, Arnold, Mech. Mach. Theory
// 48, 2012) and T(u) the change of the orientation per change of u; otherwise T = 1. A subscript q is the
// derivative by a change of the pose, which has the components of the velocities.
#pragma once

#include <string>
#include <vector>

#include "base/types.hpp"
#include "mbs/sparse_term.hpp"

namespace scree {

// Positions and velocities at one instant.
struct SystemInstant {
  Real time = 0;                      // t [s]
  const std::vector<Real>& position;  // q [positions]
  const std::vector<Real>& velocity;  // v [coordinates]
  // lambda [constraints], where forces depend on reactions; null: the multipliers of the last instant with
  // some.
  const std::vector<Real>* multipliers = nullptr;
  // a [coordinates], at the start of a step.
  const std::vector<Real>* acceleration = nullptr;
};

// Further arguments of Newton's matrix; all but lambda are [coordinates].
struct SystemIterate {
  const std::vector<Real>& displacement;  // u, from the step's start
  const std::vector<Real>& acceleration;  // a
  const std::vector<Real>& multipliers;   // lambda [constraints]
};

// Terms of the residual.
struct SystemTerms {
  std::vector<Real> applied_force;  // Q [coordinates]
  std::vector<Real> constraint;     // Phi [constraints]
  SparseTerm mass;                  // M [coordinates, coordinates]
  SparseTerm constraint_jacobian;   // Phi_q [constraints, coordinates]
  // Largest single contribution to Q, times the scale of its coordinate [J]. The contributions may cancel in
  // Q; round-off does not.
  Real force_scale = 0;
};

// An entry of (-Q)_q and -Q_v T^-1 outside the matrix' pattern, which comes and goes with the contacts:
// between bodies in contact, and of bodies loaded by explicit particles.
struct CoupledEntry {
  int row, column;
  Real stiffness, damping;
};

// Further terms of Newton's matrix; [coordinates, coordinates] unless stated otherwise.
struct SystemDerivatives {
  SparseTerm stiffness;          // (Phi_q^T lambda - Q)_q
  SparseTerm damping;            // -Q_v T^-1
  SparseTerm inertia_stiffness;  // (M a)_q
  SparseTerm tangent_inertia;    // M (T^-1 - 1)
  SparseTerm reaction;           // -Q_lambda^T [constraints, coordinates]
  std::vector<CoupledEntry> coupling;
  // Whether `coupling` has entries of add_passing(), beside which all other entries may be small.
  bool loaded = false;

  void add_passing(int row, int column, Real of_stiffness, Real of_damping) {
    if (of_stiffness == 0 && of_damping == 0) return;
    coupling.push_back({row, column, of_stiffness, of_damping});
    loaded = true;
  }
};

class MechanicalSystem {
 public:
  virtual ~MechanicalSystem() = default;

  virtual int positions() const = 0;
  virtual int coordinates() const = 0;
  virtual int constraints() const = 0;

  // terms: the same object in every call; constant terms are written once.
  virtual void evaluate(const SystemInstant& at, SystemTerms& terms) = 0;
  // evaluate() in two parts: all but the forces of contacts, which may not be known yet, and these forces.
  virtual void evaluate_uncontacted(const SystemInstant& at, SystemTerms& terms) { evaluate(at, terms); }
  virtual void add_contacts(SystemTerms&) const {}
  // The forces of evaluate_uncontacted() alone, where Phi_q is already that of the positions.
  virtual void evaluate_uncontacted_forces(const SystemInstant& at, SystemTerms& terms) {
    evaluate_uncontacted(at, terms);
  }
  // Whether differentiate() depends on the contacts.
  virtual bool contacts_in_matrix() const { return false; }
  // Derivatives at the instant of the last evaluate().
  virtual void differentiate(const SystemInstant& at, const SystemIterate& iterate,
                             SystemDerivatives& derivatives) = 0;
  // position = start moved by the displacement; both [positions].
  virtual void displace(const std::vector<Real>& start, const std::vector<Real>& displacement,
                        std::vector<Real>& position) const = 0;
  // Converts a change of the pose at the end of `displacement` to a change of the displacement: change =
  // T^-1 change.
  virtual void pull_back(const std::vector<Real>& displacement, std::vector<Real>& change) const = 0;
  // Phi_q v = velocity_rhs = -Phi_t and Phi_q a = acceleration_rhs = -(Phi_q v)_q v - 2 Phi_qt v - Phi_tt,
  // each [constraints], at the instant of the last evaluate().
  virtual void velocity_rhs(const SystemInstant& at, std::vector<Real>& rhs) const = 0;
  virtual void acceleration_rhs(const SystemInstant& at, std::vector<Real>& rhs) const = 0;

  // A characteristic size of each coordinate and of each constraint; norms are taken over these.
  virtual const std::vector<Real>& coordinate_scale() const = 0;
  virtual const std::vector<Real>& constraint_scale() const = 0;
  // For messages, e.g. "body 'crank'" and "joint 'pin'".
  virtual std::string coordinate_name(int coordinate) const = 0;
  virtual std::string constraint_name(int constraint) const = 0;
};

}  // namespace scree
