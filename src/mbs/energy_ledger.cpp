#include "mbs/energy_ledger.hpp"

#include <algorithm>
#include <cmath>

namespace scree {

void account_step(RigidBodySystem& system, const MultibodyState& start, Real t, Real h, MultibodyState& end) {
  const Powers p0 = system.powers({t, start.position, start.velocity}, start.multipliers);
  const Powers p1 = system.powers({t + h, end.position, end.velocity}, end.multipliers);
  const Real driver_work = h / 2 * (p0.drivers + p1.drivers);
  Real loss = driver_work;
  for (const auto& kind : system.kinds()) kind->add_integrator_loss(start, end, loss);
  const JointWork joints = system.joint_forces().work();
  end.dissipated = start.dissipated + h / 2 * (p0.dissipated + p1.dissipated) + joints.dissipated;
  end.driver_work = start.driver_work + driver_work + h / 2 * (p0.applied + p1.applied) + joints.applied;
  end.integrator_loss = start.integrator_loss + loss;
  MultibodyEnergies energies;
  for (const auto& kind : system.kinds()) kind->add_energies(end, energies);
  end.min_kinetic = std::min(start.min_kinetic, energies.kinetic);
  end.max_kinetic = std::max(start.max_kinetic, energies.kinetic);
}

MultibodyEnergies stored_energies(const RigidBodySystem& system, const MultibodyState& state, Real t) {
  MultibodyEnergies energies;
  for (const auto& kind : system.kinds()) kind->add_energies(state, energies);
  energies.elastic = system.elastic_energy({t, state.position, state.velocity}, state.memory);
  return energies;
}

Real energy_of_forces(const RigidBodySystem& system, const MultibodyState& state) {
  const std::vector<Real>& scale = system.coordinate_scale();
  Real sum = 0;
  for (std::size_t i = 0; i < scale.size(); ++i)
    sum += scale[i] * (std::abs(state.applied[i]) + std::abs(state.applied[i] - state.force[i]));
  return sum;
}

}  // namespace scree
