// Bodies in contact with explicit particles: the stiffness of the contacts that can act on a body at one
// time, and the step of the body that they allow.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "model/data/model.hpp"

namespace scree {

// A body, and the contacts that particles can have with it.
struct PressedBody {
  // That of the stiffest contact with a particle, an estimate; 0: no particle can touch the body [N/m].
  Real stiffness = 0;
  Real damping = 0;  // of the contact with the largest damping, an estimate [N s/m]
  Real mass = 0;     // [kg]
  // Smallest effective mass at the surface, 1 / (1/m + arm^2 / inertia) with the longest arm [kg].
  Real least_mass = 0;
  Real reach = 0;  // largest distance of its surfaces from its centre of mass [m]

  // Phase of the body's oscillation on this number of contacts in a step of length h [s].
  Real phase(std::int64_t contacts, Real h) const;
  // h^2 K / M + h C / M with the stiffness K and the damping C of this number of contacts and the smallest
  // effective mass M. Joints only increase M.
  Real load(std::int64_t contacts, Real h) const;
};

// One entry per body.
std::vector<PressedBody> pressed_bodies(const Model& model);

// kMostLoadedPhase: largest phase at which a body under explicit particles is known to be stable, for any
// mass ratio and damping. kGoodLoadedPhase: the phase for which steps are chosen. Both with the particles at
// a third of their own limit (src/coupling/README.md).
inline constexpr Real kMostLoadedPhase = 2, kGoodLoadedPhase = 1;

// Number of particles that can touch the body at one time: all of them, or the number of the smallest that
// covers its surfaces.
std::int64_t most_contacts(const Model& model, int body);

// The body that needs the shortest step, with the largest number of contacts that each body can have.
struct LoadedStep {
  int body = 0;
  std::int64_t contacts = 0;
  Real step = 0;  // step of the body with kGoodLoadedPhase [s]
};
// Empty where no particle can touch a body.
std::optional<LoadedStep> shortest_loaded_step(const Model& model);

}  // namespace scree
