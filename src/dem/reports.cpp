#include "dem/reports.hpp"

#include <cmath>

#include "dem/ledger_items.hpp"

namespace scree {

ParticleLedger make_particle_ledger(const Real* sums, const SurfaceSide& bodies) {
  ParticleLedger out;
  out.kinetic = sums[kKinetic], out.gravitational = sums[kGravitational];
  out.contact_elastic = sums[kContactElastic] + bodies.elastic_energy();
  out.contact_loss = sums[kContactLoss] + bodies.losses().contact_loss;
  out.integrator_loss = sums[kIntegratorLoss] + bodies.losses().integrator_loss;
  out.momentum = {sums[kMomentum], sums[kMomentum + 1], sums[kMomentum + 2]};
  out.angular_momentum = {sums[kAngularMomentum], sums[kAngularMomentum + 1], sums[kAngularMomentum + 2]};
  out.contacts = std::llround(sums[kPairs] + bodies.pairs());
  return out;
}

RotationEnergies make_rotation_energies(const Real* sums) {
  const Real* losses = sums + kRubbingLosses;
  return {sums[kRotational],
          sums[kFrictionSprings],
          sums[kRollingSprings],
          {{losses[kFrictionLoss], losses[kRollingLoss], losses[kTwistingLoss]}}};
}

}  // namespace scree
