// Boxes of particles with friction and rolling resistance, in contact with each other, walls and bodies,
// dense enough for contacts that slide, stick, rotate and open.
#pragma once

#include "physics/cohesion.hpp"
#include "physics/eepa.hpp"
#include "physics/liquid_bridge.hpp"
#include "support/contact_record.hpp"
#include "support/history_test_box.hpp"

namespace scree {

// Laws whose bits are the same on all backends.
inline const BoxCase kFrictionalBoxes[] = {
    {"2D, polydisperse, periodic", 2, 2, 0.2, false, false, 2, 1, true},
    {"2D, walls, periodic in x", 2, 1, 0.4, true, false, 2, 1, false},
    {"3D, polydisperse, periodic", 3, 3, 0.3, false, false, 2, 1, false},
    {"3D, polydisperse, walls", 3, 0, 0.3, true, false, 1, 1, false},
    {"3D, Hertz and Mindlin, walls", 3, 1, 0.3, true, false, 2, 1, false, 2e4},
    {"2D, bodies, periodic in x", 2, 1, 0.4, true, true, 2, 1, false},
    {"3D, bodies, periodic", 3, 3, 0.3, false, true, 2, 1, false},
    {"3D, Hertz and Mindlin, bodies and walls", 3, 1, 0.3, true, true, 2, 1, false, 2e4}};

// Adds friction, weak and strong, with and without a dashpot, and spins of the particles.
inline Model with_friction(Model model) {
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

inline constexpr Real kHhtStep = 2e-4;

// An implicit step, on a list of its own, in which the bodies move; its friction limits are lagged after so
// many iterations, if it needs more. Then escaped particles are removed.
inline void frictional_hht_step(HistoryTestBox& box, Real h, int lag_after) {
  box.backend->list().build(box.model.contact.skin, box.timers);
  const std::unique_ptr<ImplicitStep> step = predicted_step(*box.backend, h);
  box.move_bodies(h);
  int iteration = 0;
  solve_step(*box.backend, *step, box.motion, [&](int linear) {
    if (++iteration == lag_after && linear != kShortened) step->lag_limits();
  });
  step->accept();
  const std::vector<EscapedParticle> escaped_particles = box.backend->particles().outside();
  if (!escaped_particles.empty())
    box.backend->particles().remove_escaped(escaped_particles),
        box.backend->list().build(box.model.contact.skin, box.timers);
}

inline Model hht_frictional_box(const BoxCase& c, OutsidePolicy leaving) {
  Model model = with_friction(moving_box(c, leaving));
  model.integrator.particles = ParticleIntegrator::hht, model.integrator.hht_alpha = -0.1;
  return model;
}

inline Model moving_frictional_box(const BoxCase& c, OutsidePolicy leaving) {
  return with_friction(moving_box(c, leaving));
}

// Adds all rolling and twisting resistances, of which pairs of materials have different parts, with a
// damping ratio in place of a damping.
inline Model rolling(Model model) {
  const int count = model.contact.materials();
  for (int k = 0; k < count * count; ++k) {
    const int kind = k / count + k % count;
    model.contact.rolling.push_back({.friction = kind == 1 ? 0 : 0.2,
                                     .stiffness_factor = kind == 0 ? 2.25 : 0,
                                     .stiffness = kind == 2 ? 0.5 : 0,
                                     .damping_ratio = kind == 2 ? 0.3 : 0,
                                     .damping = kind > 0 ? 1e-3 : 0,
                                     .twisting_friction = kind == 1 ? 0.6 : 0.3});
    NormalLawParameters& law = model.contact.laws[static_cast<std::size_t>(k)];
    if (law.effective_modulus == 0) law.normal_damping = 0, law.damping_ratio = 0.1 + 0.1 * kind;
  }
  return model;
}

// Adds all of that and cohesion: JKR beside Hertz's law, otherwise an attractive force with a range. Pairs
// of materials differ; some have none.
inline Model sticky(Model model) {
  model = rolling(std::move(model));
  const int count = model.contact.materials();
  for (int k = 0; k < count * count; ++k) {
    const int kind = k / count + k % count;
    NormalLawParameters& law = model.contact.laws[static_cast<std::size_t>(k)];
    law.tension = false;
    if (count > 1 && kind == 2) continue;
    if (law.effective_modulus > 0)
      law.jkr = true, law.adhesion_work = kind == 0 ? 30 : 10;
    else
      law.attraction = kind == 0 ? 5 : 2, law.range = kind == 0 ? 0.01 : 0.02;
    model.contact.interaction_range = std::max(
        model.contact.interaction_range, contact_search_range(law, model.particles.totals.largest_radius));
  }
  return model;
}

// Adds all of that and plastic contacts of several strengths and shapes; pairs of different materials are
// elastic and attract.
inline Model plastic(Model model) {
  model = rolling(std::move(model));
  const int count = model.contact.materials();
  for (int k = 0; k < count * count; ++k) {
    const int kind = k / count + k % count;
    NormalLawParameters& law = model.contact.laws[static_cast<std::size_t>(k)];
    law.tension = false;
    if (kind == 1) {
      law.attraction = 2;
      continue;
    }
    law.adhesion_work = kind == 0 ? 30 : 100;
    law.own = kind == 0 ? Plasticity(0.4, 1.5) : Plasticity(0.8, 3);
  }
  return model;
}

// Adds all of that and liquid bridges of both forms, with and without viscosity; some pairs are dry.
inline Model wet(Model model) {
  model = rolling(std::move(model));
  const int count = model.contact.materials();
  for (int k = 0; k < count * count; ++k) {
    const int kind = k / count + k % count;
    NormalLawParameters& law = model.contact.laws[static_cast<std::size_t>(k)];
    law.tension = false;
    if (count > 1 && kind == 2) continue;
    law.own = BridgeParameters({.volume = kind == 0 ? 1e-3 : 1e-2,
                                .surface_tension = 8,
                                .contact_angle = 0.2,
                                .viscosity = kind == 0 ? 0.1 : 0,
                                .least_gap = 0.1,
                                .soulie = kind == 0});
    model.contact.interaction_range = std::max(
        model.contact.interaction_range, contact_search_range(law, model.particles.totals.largest_radius));
  }
  return model;
}

inline int unmirrored_sticky(const std::vector<Particle>& particles, const PackedHistory& contacts) {
  return contacts.content.values == 7 ? unmirrored<7, 6>(particles, contacts)
                                      : unmirrored<6, 6>(particles, contacts);
}

// All boxes, with either policy for escaped particles.
inline std::vector<std::pair<BoxCase, OutsidePolicy>> moving_cases() {
  std::vector<std::pair<BoxCase, OutsidePolicy>> cases;
  for (const BoxCase& c : kFrictionalBoxes)
    for (const OutsidePolicy leaving : {OutsidePolicy::drift, OutsidePolicy::remove})
      cases.emplace_back(c, leaving);
  return cases;
}

// A variant of a box of particles with friction, and which of a contact's numbers is even under exchange.
struct FrictionalBoxKind {
  const char* name;
  Model (*of)(Model);
  int (*unmirrored)(const std::vector<Particle>&, const PackedHistory&);
};
inline const FrictionalBoxKind kFrictionalBoxKinds[] = {
    {"friction", [](Model model) { return model; }, unmirrored<3>},
    {"rolling", rolling, unmirrored<6, 6>},
    {"sticky", sticky, unmirrored_sticky},
    {"plastic", plastic, unmirrored<8, 6, 7>},
    {"wet", wet, unmirrored_sticky}};

}  // namespace scree
