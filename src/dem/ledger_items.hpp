// What one particle adds to the sums over all particles. One text for the CPU and CUDA.
#pragma once

#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "partition/subdomain.hpp"
#include "physics/energy.hpp"
#include "physics/time_stepping.hpp"

namespace scree {

// Position without the periodic box [m].
SCREE_HD Vec3 unwrapped(Vec4 position, const ImageCount& image, Vec3 period) {
  return moved_by_periods(xyz(position), image, period);
}

// Kinetic and gravitational energy of a particle [J]; velocity: mass in w.
SCREE_HD Real energy_of_motion(Vec4 position, Vec4 velocity, const ImageCount& image, Vec3 gravity,
                               Vec3 period) {
  return kinetic_energy(velocity.w, xyz(velocity)) +
         gravitational_energy(velocity.w, gravity, unwrapped(position, image, period));
}

enum LedgerTerm {
  kKinetic,                          // [J]
  kGravitational,                    // [J]
  kContactElastic,                   // [J]
  kContactLoss,                      // [J]
  kIntegratorLoss,                   // [J]
  kPairs,                            // share of the number of contacts
  kMomentum,                         // three terms [kg m/s]
  kAngularMomentum = kMomentum + 3,  // three terms, about the origin [kg m^2/s]
  kLedgerTerms = kAngularMomentum + 3
};

struct LedgerTerms {
  Real value[kLedgerTerms];
};

struct LedgerItem {
  const Vec4 *position, *velocity;
  const Vec3* acceleration;
  const ImageCount* image;
  const Real *contact_loss, *integrator_loss;  // [J]
  const Real *elastic, *pairs;                 // of ContactEnergyItem
  Vec3 gravity, period;
  Real verlet_step;  // 0 for HHT, else the substep [s]

  SCREE_HD LedgerTerms operator()(Index i) const {
    const Real mass = velocity[i].w;
    const Vec3 v = xyz(velocity[i]), x = unwrapped(position[i], image[i], period);
    const Vec3 p = mass * v, l = mass * cross(x, v);
    return {{kinetic_energy(mass, v), gravitational_energy(mass, gravity, x), elastic[i], contact_loss[i],
             integrator_loss[i] - verlet_energy_shift(verlet_step, mass, acceleration[i]), pairs[i], p.x, p.y,
             p.z, l.x, l.y, l.z}};
  }
};

}  // namespace scree
