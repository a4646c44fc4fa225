#include "dem/reports.hpp"

#include <cmath>

#include "dem/ledger_items.hpp"
#include "dem/wall_items.hpp"

namespace scree {

ParticleLedger make_particle_ledger(const Real* sums, const ShapeSide& shapes) {
  ParticleLedger out;
  out.kinetic = sums[kKinetic], out.gravitational = sums[kGravitational];
  out.contact_elastic = sums[kContactElastic] + shapes.elastic_energy();
  out.contact_loss = sums[kContactLoss] + shapes.losses().contact_loss;
  out.integrator_loss = sums[kIntegratorLoss] + shapes.losses().integrator_loss;
  out.momentum = {sums[kMomentum], sums[kMomentum + 1], sums[kMomentum + 2]};
  out.angular_momentum = {sums[kAngularMomentum], sums[kAngularMomentum + 1], sums[kAngularMomentum + 2]};
  out.contacts = std::llround(sums[kPairs] + shapes.pairs());
  return out;
}

ContactSum make_wall_contact(const Real* sums) {
  const auto vector = [&](int first) { return Vec3{sums[first], sums[first + 1], sums[first + 2]}; };
  return {vector(kWallForce), vector(kWallTorque), std::llround(sums[kWallContacts])};
}

}  // namespace scree
