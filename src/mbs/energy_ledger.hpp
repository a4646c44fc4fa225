// Energy accounting of one step (METHOD: the energy ledger), trapezoidal in time.
#pragma once

#include "mbs/multibody.hpp"
#include "mbs/rigid_body_system.hpp"

namespace scree {

// Updates min_kinetic and max_kinetic of the end state. Adds the contributions of the step from (start,
// t) to (end, t + h) to dissipated, driver_work and integrator_loss of the start and writes the sums to the
// end state. With P the power at either end [W]:
//   dissipated  += h/2 (P_0 + P_1) of the dampers
//   driver_work += h/2 (P_0 + P_1) of prescribed motions, actuators and applied forces
// The work (T_0 + T_1)/2 (c_1 - c_0) of motors on joints counts as driver_work. That of springs, limits and
// friction on joints counts as `dissipated`, less the change of their elastic energy.
//   integrator_loss += 1/2 (Q_0 + Q_1).(q_1 - q_0) + work of the prescribed motions - change of kinetic
//   energy
// kinetic + gravitational + elastic + dissipated + integrator_loss - driver_work - (work of the contact
// wrenches) then stays constant up to O(h^2).
void account_step(RigidBodySystem& system, const MultibodyState& start, Real t, Real h, MultibodyState& end);

MultibodyEnergies stored_energies(const RigidBodySystem& system, const MultibodyState& state, Real t);
// Energy scale of the forces; documented at Multibody::energy_of_forces.
Real energy_of_forces(const RigidBodySystem& system, const MultibodyState& state);

}  // namespace scree
