// Energy ledger of particles and bodies: where the mechanical energy is, and how it was exchanged.
#pragma once

#include <array>

#include "dem/backend/backend.hpp"
#include "mbs/multibody.hpp"
#include "model/data/model.hpp"

namespace scree {

// Energies [J] at one instant; dissipation, work and energy carried out count from t = 0.
struct Ledger {
  Real kinetic = 0, gravitational = 0;
  Real elastic_force_elements = 0, elastic_contacts = 0;
  Real dissipated_force_elements = 0, dissipated_contacts = 0, dissipated_integrator = 0;
  Real driver_work = 0;  // of drivers, actuators, applied forces and walls
  // Kinetic and gravitational energy of removed particles, and elastic energy of contacts that ended when a
  // particle escaped.
  Real carried_out = 0;
  Real carried_in = 0;  // kinetic and gravitational energy of particles born during the run

  Real mechanical() const { return kinetic + gravitational + elastic_force_elements + elastic_contacts; }
  Real accounted() const {
    return mechanical() + dissipated_force_elements + dissipated_contacts + dissipated_integrator +
           carried_out - driver_work - carried_in;
  }
  std::array<Real, 10> entries() const {
    return {kinetic,
            gravitational,
            elastic_force_elements,
            elastic_contacts,
            dissipated_force_elements,
            dissipated_contacts,
            dissipated_integrator,
            driver_work,
            carried_out,
            carried_in};
  }
};

// Energy of escaped particles, added up when they leave; part of the state.
struct CarriedOut {
  std::int64_t left = 0;                       // number of escaped particles, ballistic or removed
  std::int64_t removed = 0;                    // of these, and in outlets
  Real energy = 0;                             // see Ledger::carried_out [J]
  Real contact_loss = 0, integrator_loss = 0;  // of the removed particles [J]
  TangentialLosses losses{};                   // parts of contact_loss
  // Kinetic and gravitational energy of the ballistic particles when they escaped, and the energy that the
  // integrator had taken out of them by then [J].
  Real ballistic_energy = 0, ballistic_integrator_loss = 0;
};

// Adds the energies of particles that have just left. policy: what happens to escaped ones.
void account_escaped(const std::vector<EscapedParticle>& escaped_particles, OutsidePolicy policy,
                     CarriedOut& carried_out);

// The ledger at time t [s]. carried_in: see Ledger. bodies: null on ranks other than 0 and in models without
// bodies.
Ledger make_ledger(const ParticleLedger& particles, const CarriedOut& carried_out, const Multibody* bodies,
                   const MultibodyState& state, Real t, Real carried_in = 0);

// The ledger without particles outside the domain, as if ballistic particles had been removed when they
// escaped. Without ballistic particles its bits are those of `all`.
Ledger inside_ledger(const Ledger& all, const ParticleLedger& particles, const CarriedOut& carried_out);

}  // namespace scree
