// Energy ledger of both sides: where the mechanical energy is and where it went.
#pragma once

#include <array>

#include "dem/backend/backend.hpp"
#include "mbs/multibody.hpp"
#include "model/data/model.hpp"

namespace scree {

// Energies [J] at one instant; what is dissipated, worked or carried out counts from t = 0.
struct Ledger {
  Real kinetic = 0, gravitational = 0;
  Real elastic_force_elements = 0, elastic_contacts = 0;
  Real dissipated_force_elements = 0, dissipated_contacts = 0, dissipated_integrator = 0;
  Real driver_work = 0;  // of drivers, actuators, applied forces and walls
  // Kinetic and gravitational energy of removed particles, elastic energy of the contacts that ended as one
  // left.
  Real carried_out = 0;

  Real mechanical() const { return kinetic + gravitational + elastic_force_elements + elastic_contacts; }
  Real accounted() const {
    return mechanical() + dissipated_force_elements + dissipated_contacts + dissipated_integrator +
           carried_out - driver_work;
  }
  std::array<Real, 9> entries() const {
    return {kinetic,
            gravitational,
            elastic_force_elements,
            elastic_contacts,
            dissipated_force_elements,
            dissipated_contacts,
            dissipated_integrator,
            driver_work,
            carried_out};
  }
};

// What particles took along, booked when they left; part of the state.
struct CarriedOut {
  std::int64_t left = 0;  // particles that have left, drifting or removed
  std::int64_t removed = 0;
  Real energy = 0;                             // see Ledger::carried_out [J]
  Real contact_loss = 0, integrator_loss = 0;  // of the removed ones [J]
  RubbingLosses losses{};                      // of contact_loss
  // Kinetic and gravitational energy of the drifting particles when they left, and what the integrator had
  // taken out of them until then [J].
  Real drifting_energy = 0, drifting_integrator_loss = 0;
};

void book_leavers(const std::vector<Leaver>& leavers, Leaving policy, CarriedOut& carried_out);

// bodies: null on ranks other than 0 and without bodies.
Ledger make_ledger(const ParticleLedger& particles, const CarriedOut& carried_out, const Multibody* bodies,
                   const MultibodyState& state, Real t);

// The ledger of an instant as if particles that drift had been removed when they left: no entry has what they
// do outside. Its bits are those of `all` where none drifts.
Ledger inside_ledger(const Ledger& all, const ParticleLedger& particles, const CarriedOut& carried_out);

}  // namespace scree
