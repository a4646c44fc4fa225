#include "coupling/ledger.hpp"

namespace scree {

void account_escaped(const std::vector<EscapedParticle>& escaped_particles, OutsidePolicy policy,
                     CarriedOut& carried_out) {
  carried_out.left += static_cast<std::int64_t>(escaped_particles.size());
  for (const EscapedParticle& escaped_particle : escaped_particles)
    carried_out.energy += escaped_particle.elastic;
  if (policy != OutsidePolicy::remove) {
    for (const EscapedParticle& escaped_particle : escaped_particles) {
      carried_out.ballistic_energy += escaped_particle.energy;
      carried_out.ballistic_integrator_loss += escaped_particle.integrator_loss;
    }
    return;
  }
  carried_out.removed += static_cast<std::int64_t>(escaped_particles.size());
  for (const EscapedParticle& escaped_particle : escaped_particles) {
    carried_out.energy += escaped_particle.energy;
    carried_out.contact_loss += escaped_particle.contact_loss;
    carried_out.integrator_loss += escaped_particle.integrator_loss;
    carried_out.losses.add(escaped_particle.losses);
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
