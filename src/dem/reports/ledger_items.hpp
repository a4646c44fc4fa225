// Contributions of one particle to the sums over all particles. Shared by the CPU and CUDA backends.
#pragma once

#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "dem/particles/particle_fields.hpp"
#include "partition/subdomain.hpp"
#include "physics/contact_law.hpp"
#include "physics/energy.hpp"
#include "physics/time_stepping.hpp"

namespace scree {

// Position without periodic wrapping [m].
SCREE_HD Vec3 unwrapped(Vec4 position, const ImageCount& image, Vec3 period) {
  return moved_by_periods(xyz(position), image, period);
}

// Kinetic energy of a particle, rotation included [J].
SCREE_HD Real kinetic_energy(const ParticleViews& in, Index i) {
  const Vec4 v = in.velocity[i];
  const Real energy = kinetic_energy(v.w, xyz(v));
  if (in.angular_velocity == nullptr) return energy;
  const Vec4 w = in.angular_velocity[i];
  return energy + rotational_energy(w.w, xyz(w));
}

// Kinetic and gravitational energy of a particle [J].
SCREE_HD Real energy_of_motion(const ParticleViews& in, Index i, Vec3 gravity, Vec3 period) {
  return kinetic_energy(in, i) +
         gravitational_energy(in.velocity[i].w, gravity, unwrapped(in.position[i], in.image[i], period));
}

// Energy shift of velocity Verlet for a particle, rotation included [J].
SCREE_HD Real verlet_energy_shift(Real h, const ParticleViews& in, Index i) {
  const Real shift = verlet_energy_shift(h, in.velocity[i].w, in.acceleration[i]);
  if (in.angular_velocity == nullptr) return shift;
  return shift + verlet_energy_shift(h, in.angular_velocity[i].w, in.angular_acceleration[i]);
}

enum LedgerTerm {
  kKinetic,                          // translation and rotation [J]
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
  ParticleViews in;
  const Real *elastic, *pairs;  // from `ContactEnergyItem`
  Vec3 gravity, period;
  Real verlet_step;  // 0 for HHT, else the substep [s]

  SCREE_HD LedgerTerms operator()(Index i) const {
    const Real mass = in.velocity[i].w;
    const Vec3 v = xyz(in.velocity[i]), x = unwrapped(in.position[i], in.image[i], period);
    const Vec3 p = mass * v;
    Vec3 l = mass * cross(x, v);
    if (in.angular_velocity != nullptr) l += in.angular_velocity[i].w * xyz(in.angular_velocity[i]);
    return {{kinetic_energy(in, i), gravitational_energy(mass, gravity, x), elastic[i], in.contact_loss[i],
             in.integrator_loss[i] - verlet_energy_shift(verlet_step, in, i), pairs[i], p.x, p.y, p.z, l.x,
             l.y, l.z}};
  }
};

// Sums over the particles inside the domain, for InsideEnergies.
enum InsideTerm {
  kInsideKinetic,         // [J]
  kInsideGravitational,   // [J]
  kInsideIntegratorLoss,  // [J]
  kInsideTerms
};

struct InsideTerms {
  Real value[kInsideTerms];
};

// Sums of the particles inside; without escaped ones they equal those of LedgerItem bit for bit. gravity,
// period, verlet_step: as in LedgerItem.
struct InsideItem {
  ParticleViews in;
  Vec3 gravity, period;
  Real verlet_step;  // [s]

  SCREE_HD InsideTerms operator()(Index i) const {
    if (in.drifting[i] != 0) return {};
    const Vec3 x = unwrapped(in.position[i], in.image[i], period);
    return {{kinetic_energy(in, i), gravitational_energy(in.velocity[i].w, gravity, x),
             in.integrator_loss[i] - verlet_energy_shift(verlet_step, in, i)}};
  }
};

// Kinetic energy of the particles inside.
struct InsideKineticItem {
  ParticleViews in;
  struct Term {
    Real value[1];
  };

  SCREE_HD Term operator()(Index i) const { return {{in.drifting[i] == 0 ? kinetic_energy(in, i) : 0}}; }
};

// Adhesive part of the elastic energy, where contacts have adhesion.
struct CohesionItem {
  const Real* cohesion;  // from `ContactEnergyItem` [J]
  struct Term {
    Real value[1];
  };

  SCREE_HD Term operator()(Index i) const { return {{cohesion[i]}}; }
};

// Dissipation of friction, rolling and twisting in the particle's share of its contacts.
SCREE_HD TangentialLosses losses_of(const ParticleViews& in, Index i) {
  const auto value = [i](const Real* losses) { return losses != nullptr ? losses[i] : 0; };
#define SCREE_LOSS(of, kind, field, ...) value(of.field),
  return {{SCREE_LOSS_KINDS(SCREE_LOSS, in)}};
#undef SCREE_LOSS
}

// Sums where particles rotate; separate from LedgerTerm, so that other runs are unaffected.
enum RotationTerm {
  kRotational,       // kinetic energy [J]
  kFrictionSprings,  // elastic energies [J]
  kRollingSprings,
  kTangentialLosses,  // by LossKind [J]
  kRotationTerms = kTangentialLosses + kLossKinds
};

struct RotationTerms {
  Real value[kRotationTerms];
};

struct RotationItem {
  ParticleViews in;
  const SpringEnergies* springs;  // from `ContactEnergyItem`

  SCREE_HD RotationTerms operator()(Index i) const {
    const Vec4 w = in.angular_velocity[i];
    const TangentialLosses losses = losses_of(in, i);
    return {{rotational_energy(w.w, xyz(w)), springs[i].friction, springs[i].rolling,
             SCREE_LOSS_KINDS(SCREE_LOSS_VALUE, losses.of)}};
  }
};

}  // namespace scree
