#include "coupling/ledger.hpp"

namespace scree {

void account_escaped(const std::vector<EscapedParticle>& escaped_particles, OutsidePolicy policy,
                     CarriedOut& carried_out) {
  for (const EscapedParticle& particle : escaped_particles) {
    carried_out.left += particle.outlet < 0;
    carried_out.energy += particle.elastic;
  }
  for (const EscapedParticle& particle : escaped_particles) {
    if (!particle.is_removed(policy)) {
      carried_out.ballistic_energy += particle.energy;
      carried_out.ballistic_integrator_loss += particle.integrator_loss;
      continue;
    }
    ++carried_out.removed;
    carried_out.energy += particle.energy;
    carried_out.contact_loss += particle.contact_loss;
    carried_out.integrator_loss += particle.integrator_loss;
    carried_out.losses.add(particle.losses);
  }
}

Ledger make_ledger(const ParticleLedger& particles, const CarriedOut& carried_out, const Multibody* bodies,
                   const MultibodyState& state, Real t, Real carried_in) {
  Ledger out;
  out.kinetic = particles.kinetic;
  out.gravitational = particles.gravitational;
  out.elastic_contacts = particles.contact_elastic;
  out.dissipated_contacts = particles.contact_loss + carried_out.contact_loss;
  out.dissipated_integrator = particles.integrator_loss + carried_out.integrator_loss;
  out.carried_out = carried_out.energy, out.carried_in = carried_in;
  out.driver_work = state.driver_work;
  if (bodies == nullptr) return out;
  const MultibodyEnergies energies = bodies->energies(state, t);
  out.kinetic += energies.kinetic;
  out.gravitational += energies.gravitational;
  out.elastic_force_elements = energies.elastic;
  out.dissipated_force_elements = state.dissipated;
  out.dissipated_integrator += state.integrator_loss;
  return out;
}

Ledger inside_ledger(const Ledger& all, const ParticleLedger& particles, const CarriedOut& carried_out) {
  Ledger inside = all;
  inside.kinetic += particles.inside.kinetic - particles.kinetic;
  inside.gravitational += particles.inside.gravitational - particles.gravitational;
  inside.dissipated_integrator +=
      particles.inside.integrator_loss - particles.integrator_loss + carried_out.ballistic_integrator_loss;
  inside.carried_out += carried_out.ballistic_energy;
  return inside;
}

}  // namespace scree
