// Spheres that collide with friction, rolling and twisting resistance, for comparisons of mixed with double
// precision.
#pragma once

#include "model/data/model.hpp"

namespace scree {

// Linear with a restitution, Hertz and a power.
inline const NormalLawParameters kCollisionLaws[] = {
    {.normal_stiffness = 2e5, .damping_ratio = 0.05},
    {.effective_modulus = 5e6, .damping_ratio = 0.1},
    {.normal_stiffness = 1e6, .exponent = 1.2, .damping_ratio = 0.1}};

inline constexpr Real kCollisionStep = 1e-4;
inline constexpr int kCollisionSteps = 400;  // all have separated again

// Pairs that collide at all angles and with all spins, and spheres that hit the floor.
inline Model colliding_spheres(const NormalLawParameters& normal) {
  Model model;
  model.space.min = {0, 0, 0}, model.space.max = {1000, 1000, 1000};
  model.contact.material_names = {"sphere"};
  model.contact.laws = {normal};
  model.contact.friction = {{.friction = 0.3, .stiffness = 6e4, .shear_modulus = 2e6, .damping_ratio = 0}};
  model.contact.rolling = {
      {.friction = 0.2, .stiffness_factor = 2.25, .damping = 0.02, .twisting_friction = 0.3}};
  model.contact.skin = 0.1;
  model.integrator.particles = ParticleIntegrator::velocity_verlet;
  model.walls = {{"floor", {0, 0, 980}, {0, 0, 1}, 0}};
  ParticleSet& set = model.particles;
  const auto add = [&](Vec3 position, Vec3 velocity, Vec3 spin) {
    set.position.push_back(position), set.velocity.push_back(velocity), set.angular_velocity.push_back(spin);
    set.radius.push_back(0.5), set.mass.push_back(1), set.material.push_back(0);
  };
  for (int k = 0; k < 12; ++k) {
    const Vec3 at{900 + 1e-5 * k, 3.0 + 4 * k, 990};
    add(at, {1, 0.05 * k, 0}, {0.2 * k, 1, 0.3 * k});
    add(at + Vec3{1.01, 0.2, 0.1}, {-1, 0, 0.3}, {-1, 0.1 * k, 2});
    add({920, 3.0 + 4 * k, 980.50503}, {0.05 * k, 0, -1}, {0.1 * k, -0.2 * k, 3});
  }
  count_particles(set, model.contact.materials());
  return model;
}

}  // namespace scree
