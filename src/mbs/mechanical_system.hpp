// What the HHT method knows of a constrained mechanical system: M(q) q'' + Phi_q^T lambda = Q(q', q, t),
// Phi(q, t) = 0 (Jung, Jun, Sohn 2013, Eqs. 4-8).
#pragma once

#include <string>
#include <vector>

#include "base/types.hpp"
#include "mbs/sparse_term.hpp"

namespace scree {

// Generalized coordinates and their rates at one instant.
struct SystemInstant {
  Real time = 0;                      // t [s]
  const std::vector<Real>& position;  // q
  const std::vector<Real>& velocity;  // q'
};

// What the residual needs.
struct SystemTerms {
  std::vector<Real> applied_force;  // Q [coordinates]
  std::vector<Real> constraint;     // Phi [constraints]
  SparseTerm mass;                  // M [coordinates, coordinates]
  SparseTerm constraint_jacobian;   // Phi_q [constraints, coordinates]
  // Largest single contribution to Q, times the scale of its coordinate [J]. The contributions may cancel in
  // Q; round-off does not.
  Real force_scale = 0;
};

// What Newton's matrix needs besides; all [coordinates, coordinates].
struct SystemDerivatives {
  SparseTerm stiffness;          // (Phi_q^T lambda - Q)_q
  SparseTerm damping;            // -Q_q'
  SparseTerm inertia_stiffness;  // (M q'')_q
};

class MechanicalSystem {
 public:
  virtual ~MechanicalSystem() = default;

  virtual int coordinates() const = 0;
  virtual int constraints() const = 0;

  // terms: always the same ones; what is constant is written there once.
  virtual void evaluate(const SystemInstant& at, SystemTerms& terms) = 0;
  // At the instant of the last evaluate().
  virtual void differentiate(const SystemInstant& at, const std::vector<Real>& acceleration,
                             const std::vector<Real>& multipliers, SystemDerivatives& derivatives) = 0;
  // Phi_q q' = velocity_rhs = -Phi_t and Phi_q q'' = acceleration_rhs = -(Phi_q q')_q q' - 2 Phi_qt q' -
  // Phi_tt, each [constraints], at the instant of the last evaluate().
  virtual void velocity_rhs(const SystemInstant& at, std::vector<Real>& rhs) const = 0;
  virtual void acceleration_rhs(const SystemInstant& at, std::vector<Real>& rhs) const = 0;

  // A characteristic size of each coordinate and of each constraint: norms are taken over these.
  virtual const std::vector<Real>& coordinate_scale() const = 0;
  virtual const std::vector<Real>& constraint_scale() const = 0;
  // For messages, e.g. "body 'crank'" and "joint 'pin'".
  virtual std::string coordinate_name(int coordinate) const = 0;
  virtual std::string constraint_name(int constraint) const = 0;
};

}  // namespace scree
