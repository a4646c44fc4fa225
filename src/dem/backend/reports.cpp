#include "dem/backend/reports.hpp"

#include <cmath>

#include "dem/reports/ledger_items.hpp"

namespace scree {

ParticleLedger make_particle_ledger(const Real* sums, const HostSurfaces& bodies) {
  ParticleLedger out;
  out.kinetic = sums[kKinetic], out.gravitational = sums[kGravitational];
  const BodyContactTotals shapes = bodies.shape_totals();
  out.contact_elastic = sums[kContactElastic] + shapes.elastic_energy;
  out.cohesion = shapes.cohesion;
  out.contact_loss = sums[kContactLoss] + bodies.losses().contact_loss;
  out.integrator_loss = sums[kIntegratorLoss] + bodies.losses().integrator_loss;
  out.momentum = {sums[kMomentum], sums[kMomentum + 1], sums[kMomentum + 2]};
  out.angular_momentum = {sums[kAngularMomentum], sums[kAngularMomentum + 1], sums[kAngularMomentum + 2]};
  out.contacts = std::llround(sums[kPairs] + shapes.pairs);
  return out;
}

RotationEnergies make_rotation_energies(const Real* sums, const HostSurfaces& bodies) {
  const Real* losses = sums + kTangentialLosses;
  const SpringEnergies shapes = bodies.shape_totals().springs;
  RotationEnergies out{sums[kRotational],
                       sums[kFrictionSprings] + shapes.friction,
                       sums[kRollingSprings] + shapes.rolling,
                       {{SCREE_LOSS_KINDS(SCREE_LOSS_VALUE, losses)}}};
  out.losses.add(bodies.losses().tangential);
  return out;
}

}  // namespace scree
