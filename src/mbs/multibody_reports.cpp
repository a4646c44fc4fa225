// What outputs show of the bodies: energies, and reactions and efforts of an instant.
#include "base/error.hpp"
#include "mbs/energy_ledger.hpp"
#include "mbs/multibody_impl.hpp"

namespace scree {

MultibodyEnergies Multibody::energies(const MultibodyState& state, Real t) const {
  return stored_energies(impl_->system, state, t);
}

Real Multibody::energy_of_forces(const MultibodyState& state) const {
  return scree::energy_of_forces(impl_->system, state);
}

MultibodyState Multibody::at_instant(const MultibodyState& state, Real t) const {
  MultibodyState now = state;
  impl_->system.set_forces(impl_->wrench_of_bodies(state));
  impl_->open_step(state, t, 0);
  try {
    impl_->newton.solve_instant(now, t);
  } catch (const SimulationError&) {
    return state;
  }
  if (impl_->system.joint_forces().are_loaded()) now.memory = impl_->system.joint_forces().memory();
  return now;
}

std::vector<Reaction> Multibody::reactions(const MultibodyState& state, Real t) const {
  const std::vector<ConstraintGroup>& groups = impl_->system.groups();
  if (groups.empty()) return {};
  const MultibodyState now = at_instant(state, t);
  const auto loads = impl_->system.reactions({t, now.position, now.velocity, &now.multipliers}, now.memory);
  std::vector<Reaction> reactions;
  for (std::size_t i = 0; i < groups.size(); ++i)
    reactions.push_back({groups[i].name, loads[i].force, loads[i].torque, groups[i].kind, loads[i].frame});
  return reactions;
}

std::vector<JointReading> Multibody::joint_readings(const MultibodyState& state, Real t) const {
  if (impl_->readings.empty()) return {};
  const SystemInstant at{t, state.position, state.velocity};
  return impl_->readings.at(impl_->system.poses_at(at), at);
}

std::vector<JointEffortSample> Multibody::joint_efforts(const MultibodyState& state, Real t) const {
  const JointForces& forces = impl_->system.joint_forces();
  if (forces.empty()) return {};
  const MultibodyState now = forces.are_loaded() ? at_instant(state, t) : state;
  const SystemInstant at{t, now.position, now.velocity, &now.multipliers};
  const auto samples = forces.samples(impl_->system.poses_at(at), at, now.memory);
  std::vector<JointEffortSample> out;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const CoordinateInstant& c = samples[i].at;
    out.push_back({forces.all()[i].name(), forces.all()[i].is_angle(), c.value, c.rate, samples[i].effort,
                   samples[i].effort * c.rate});
  }
  return out;
}

std::vector<Real> Multibody::spring_efforts(const MultibodyState& state, Real t) const {
  return impl_->system.spring_efforts({t, state.position, state.velocity});
}

std::vector<BushingSample> Multibody::bushings(const MultibodyState& state, Real t) const {
  if (impl_->system.bushings().empty()) return {};
  const BodyPoses poses = impl_->system.poses_at({t, state.position, state.velocity});
  std::vector<BushingSample> out;
  for (const BushingElement* bushing : impl_->system.bushings()) {
    const BushingLoad load = bushing->load(poses);
    out.push_back({bushing->name(), load.shift, load.turn, load.force, load.torque});
  }
  return out;
}

}  // namespace scree
