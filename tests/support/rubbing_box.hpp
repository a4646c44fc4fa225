// Boxes of particles that rub on each other and on walls, dense enough for contacts that slide, that stick,
// that turn and that part.
#pragma once

#include "support/remembering_box.hpp"

namespace scree {

// Laws whose bits are the same on all backends, without bodies.
inline const BoxCase kRubbingBoxes[] = {
    {"2D, polydisperse, periodic", 2, 2, 0.2, false, false, 2, 1, true},
    {"2D, walls, periodic in x", 2, 1, 0.4, true, false, 2, 1, false},
    {"3D, polydisperse, periodic", 3, 3, 0.3, false, false, 2, 1, false},
    {"3D, polydisperse, walls", 3, 0, 0.3, true, false, 1, 1, false},
    {"3D, Hertz and Mindlin, walls", 3, 1, 0.3, true, false, 2, 1, false, 2e4}};

// The model with friction, weak and strong, with a dashpot and without, and with particles that spin.
inline Model rubbing(Model model) {
  RandomNumbers random(77);
  const bool flat = model.space.dimension == 2;
  for (std::size_t k = 0; k < model.contact.laws.size(); ++k) {
    const auto softness = static_cast<Real>(model.contact.laws[k].effective_modulus > 0 ? 1 : 0);
    // Symmetric in the materials: by the law of the pair.
    const Real strength =
        softness > 0 ? model.contact.laws[k].damping_ratio : model.contact.laws[k].normal_stiffness / 1e4;
    model.contact.friction.push_back({.friction = strength,
                                      .stiffness = 800 * (1 - softness),
                                      .shear_modulus = 1e4 * softness,
                                      .damping_ratio = strength > 0.15 ? 0.2 : 0});
  }
  for (std::size_t i = 0; i < model.particles.size(); ++i) {
    const Vec3 spin{10 * random.normal(), 10 * random.normal(), 10 * random.normal()};
    model.particles.angular_velocity.push_back(flat ? Vec3{0, 0, spin.z} : spin);
  }
  model.particles.dimension = model.space.dimension;
  model.integrator.particles = ParticleIntegrator::velocity_verlet;
  return model;
}

inline Model moving_rubbing_box(const BoxCase& c, Leaving leaving) { return rubbing(moving_box(c, leaving)); }

}  // namespace scree
