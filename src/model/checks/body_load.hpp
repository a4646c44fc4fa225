// Bodies beside explicit particles: how stiff the contacts with particles are that may press on a body at a
// time, and which steps of the body are short enough for them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "model/data/model.hpp"

namespace scree {

// The contacts that particles can have with one body, and the body under them.
struct PressedBody {
  Real stiffness = 0;   // of its stiffest contact with a particle [N/m], an estimate; 0: none can touch it
  Real damping = 0;     // of its contact with the largest damping [N s/m], likewise
  Real mass = 0;        // [kg]
  Real least_mass = 0;  // that a push with the longest arm meets, 1 / (1/m + arm^2 / inertia) [kg]
  Real reach = 0;       // of its surfaces from its centre of mass [m]

  // Phase by which the body on this many contacts oscillates in a step of length h [s].
  Real phase(std::int64_t contacts, Real h) const;
  // h^2 K / M + h C / M with the stiffness K and the damping C of so many contacts, and the least M: joints
  // make it only larger.
  Real load(std::int64_t contacts, Real h) const;
};

// One entry per body.
std::vector<PressedBody> pressed_bodies(const Model& model);

// Largest phase at which a body that explicit particles press on is known to be stable, whatever the ratio
// of the masses and the damping, and the one that steps are chosen for: with the particles themselves at a
// third of their limit (src/coupling/README.md).
inline constexpr Real kMostLoadedPhase = 2, kGoodLoadedPhase = 1;

// Number of particles that can touch the body at a time: all of them, or as many of the smallest as cover its
// surfaces.
std::int64_t most_contacts(const Model& model, int body);

// The body whose step must be the shortest under all contacts that it can have.
struct LoadedStep {
  int body = 0;
  std::int64_t contacts = 0;
  Real step = 0;  // of a body, with kGoodLoadedPhase [s]
};
// Empty where no particle can touch a body.
std::optional<LoadedStep> shortest_loaded_step(const Model& model);

}  // namespace scree
