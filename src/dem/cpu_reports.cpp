// What the serial backend tells about its particles: leavers, sums, packs for output.
#include <algorithm>
#include <cmath>

#include "base/reproducible_sum.hpp"
#include "dem/cpu_backend.hpp"

namespace scree {
namespace {

template <class Term>
Vec3 vector_sum(Index n, const Term& term) {
  return {reproducible_sum(n, [&](Index i) { return term(i).x; }),
          reproducible_sum(n, [&](Index i) { return term(i).y; }),
          reproducible_sum(n, [&](Index i) { return term(i).z; })};
}

}  // namespace

Real CpuBackend::energy_of(Index i) const {
  const Vec4 v = store_.velocity[i];
  return kinetic_energy(v.w, xyz(v)) + gravitational_energy(v.w, model_.gravity, unwrapped(i));
}

Vec3 CpuBackend::unwrapped(Index i) const {
  const Vec3 period = subdomain_.period();
  const ImageCount& image = store_.image[i];
  return xyz(store_.position[i]) + Vec3{image.x * period.x, image.y * period.y, image.z * period.z};
}

std::vector<Leaver> CpuBackend::outside() const {
  std::vector<Leaver> leavers;
  for (Index i = 0; i < store_.owned; ++i) {
    const Vec3 p = xyz(store_.position[i]);
    if (store_.drifting[i] || subdomain_.inside(p)) continue;
    leavers.push_back({store_.global_id[i], i, p, subdomain_.beyond_wall(p), energy_of(i),
                       store_.contact_loss[i], store_.integrator_loss[i]});
  }
  std::sort(leavers.begin(), leavers.end(),
            [](const Leaver& a, const Leaver& b) { return a.global_id < b.global_id; });
  return leavers;
}

void CpuBackend::take_out(const std::vector<Leaver>& leavers) {
  for (const Leaver& leaver : leavers) store_.drifting[leaver.local_index] = 1;
  layout_changed_ = true;
  if (model_.space.leaving != Leaving::remove) return;
  std::vector<Index> staying;
  for (Index i = 0; i < store_.owned; ++i)
    if (!store_.drifting[i]) staying.push_back(i);
  store_.reorder(staying);
}

ParticleLedger CpuBackend::ledger(Real verlet_step) {
  const Index n = store_.owned;
  std::vector<Real> elastic(n), pairs(n);
  std::vector<Index> touching(n);
  kernels_->energies(views(), n, {elastic.data(), touching.data(), pairs.data()});
  find_shape_contacts(views());

  ParticleLedger out;
  const auto mass = [&](Index i) { return store_.velocity[i].w; };
  const auto velocity = [&](Index i) { return xyz(store_.velocity[i]); };
  out.kinetic = reproducible_sum(n, [&](Index i) { return kinetic_energy(mass(i), velocity(i)); });
  out.gravitational = reproducible_sum(
      n, [&](Index i) { return gravitational_energy(mass(i), model_.gravity, unwrapped(i)); });
  out.contact_elastic = reproducible_sum(n, [&](Index i) { return elastic[i]; }) + side_.elastic_energy();
  out.contact_loss =
      reproducible_sum(n, [&](Index i) { return store_.contact_loss[i]; }) + side_.losses().contact_loss;
  out.integrator_loss = reproducible_sum(n, [&](Index i) {
    return store_.integrator_loss[i] - verlet_energy_shift(verlet_step, mass(i), store_.acceleration[i]);
  });
  out.momentum = vector_sum(n, [&](Index i) { return mass(i) * velocity(i); });
  out.angular_momentum = vector_sum(n, [&](Index i) { return mass(i) * cross(unwrapped(i), velocity(i)); });
  out.contacts = std::llround(reproducible_sum(n, [&](Index i) { return pairs[i]; }) + side_.pairs());
  for (Index i = 0; i < n; ++i) out.drifting += store_.drifting[i];
  return out;
}

ParticlePack CpuBackend::pack_particles() {
  const Index n = store_.owned;
  ParticlePack pack;
  std::vector<Real> energy(n), pairs(n);
  pack.contacts.resize(n);
  kernels_->energies(views(), n, {energy.data(), pack.contacts.data(), pairs.data()});
  for (Index i = 0; i < n; ++i) {
    ImageCount unused;
    pack.global_id.push_back(store_.global_id[i]);
    pack.radius.push_back(store_.position[i].w);
    pack.position.push_back(subdomain_.wrap(xyz(store_.position[i]), unused));
    pack.velocity.push_back(xyz(store_.velocity[i]));
    pack.force.push_back(store_.force[i] - store_.velocity[i].w * model_.gravity);
  }
  return pack;
}

ShapePack CpuBackend::pack_shapes() {
  find_shape_contacts(views());
  return side_.pack(layout_);
}

}  // namespace scree
