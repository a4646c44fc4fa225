// What the serial backend tells about its particles: leavers, sums, packs for output.
#include <algorithm>
#include <cmath>

#include "base/reproducible_sum.hpp"
#include "dem/cpu_backend.hpp"
#include "dem/ledger_items.hpp"

namespace scree {
bool CpuBackend::any_outside() const {
  for (Index i = 0; i < store_.owned; ++i)
    if (!store_.drifting[i] && !subdomain_.inside(xyz(store_.position[i]))) return true;
  return false;
}

std::vector<Leaver> CpuBackend::outside() const {
  std::vector<Leaver> leavers;
  if (!ranks_.any(any_outside())) return leavers;
  for (Index i = 0; i < store_.owned; ++i) {
    const Vec3 p = xyz(store_.position[i]);
    if (store_.drifting[i] || subdomain_.inside(p)) continue;
    const Real energy = energy_of_motion(store_.position[i], store_.velocity[i], store_.image[i],
                                         model_.gravity, subdomain_.period());
    const Real shift = verlet_energy_shift(verlet_step(model_), store_.velocity[i].w, store_.acceleration[i]);
    leavers.push_back({id_of(store_.row_key[i]), i, p, subdomain_.beyond_wall(p), energy,
                       store_.contact_loss[i], store_.integrator_loss[i] - shift, 0, ranks_.rank()});
  }
  kernels_->leavers(views(), subdomain_.box(), static_cast<Index>(leavers.size()), leavers.data());
  leavers = ranks_.gather_everywhere(std::move(leavers));
  std::sort(leavers.begin(), leavers.end(),
            [](const Leaver& a, const Leaver& b) { return a.global_id < b.global_id; });
  return leavers;
}

// Before the leavers are wrapped and marked.
void CpuBackend::take_contacts_out() {
  const bool verlet = is_verlet(model_);
  kernels_->departures(views(store_.position, verlet ? spare_velocity_ : store_.velocity), model_.gravity,
                       subdomain_.box(), layout_.owned,
                       {store_.force.data(), store_.acceleration.data(),
                        verlet ? store_.loss_power.data() : nullptr, store_.integrator_loss.data(),
                        store_.drifting.data(), verlet ? hht_coefficients(0) : hht_, verlet_step(model_)});
}

void CpuBackend::take_out(const std::vector<Leaver>& leavers) {
  take_contacts_out();
  for (const Leaver& leaver : leavers) {
    if (leaver.rank != ranks_.rank()) continue;
    const auto i = static_cast<std::size_t>(leaver.local_index);
    const Vec4& p = store_.position[i];
    store_.position[i] = vec4(subdomain_.wrap(xyz(p), store_.image[i]), p.w);
    store_.drifting[i] = 1;
  }
  layout_changed_ = true;
  if (model_.space.leaving != Leaving::remove) return;
  std::vector<Index> staying;
  for (Index i = 0; i < store_.owned; ++i)
    if (!store_.drifting[i]) staying.push_back(i);
  if (!ranks_.alone()) {
    for (std::size_t k = 0; k < staying.size(); ++k) row_length_[k] = row_length_[staying[k]];
    row_length_.resize(staying.size());
  }
  store_.reorder(staying);
}

ParticleLedger CpuBackend::ledger(Real verlet_step) {
  const Index n = store_.owned;
  std::vector<Real> elastic(n), pairs(n);
  std::vector<Index> touching(n);
  kernels_->energies(views(), n, {elastic.data(), touching.data(), pairs.data()});
  find_shape_contacts(views());

  const LedgerItem item{store_.position.data(),
                        store_.velocity.data(),
                        store_.acceleration.data(),
                        store_.image.data(),
                        store_.contact_loss.data(),
                        store_.integrator_loss.data(),
                        elastic.data(),
                        pairs.data(),
                        model_.gravity,
                        subdomain_.period(),
                        verlet_step};
  Real sums[kLedgerTerms];
  reproducible_sums(n, item, sums, ranks_);
  ParticleLedger out = make_particle_ledger(sums, side_);
  for (Index i = 0; i < n; ++i) out.drifting += store_.drifting[i];
  out.drifting = ranks_.sum(out.drifting);
  return out;
}

void CpuBackend::start_pack() {
  const Index n = store_.owned;
  ParticlePack& pack = pack_ = {};
  std::vector<Real> energy(n), pairs(n);
  pack.contacts.resize(n);
  kernels_->energies(views(), n, {energy.data(), pack.contacts.data(), pairs.data()});
  for (Index i = 0; i < n; ++i) {
    ImageCount unused;
    pack.global_id.push_back(id_of(store_.row_key[i]));
    pack.radius.push_back(store_.position[i].w);
    pack.position.push_back(subdomain_.wrap(xyz(store_.position[i]), unused));
    pack.velocity.push_back(xyz(store_.velocity[i]));
    pack.force.push_back(store_.force[i] - store_.velocity[i].w * model_.gravity);
  }
}

ShapePack CpuBackend::pack_shapes() {
  find_shape_contacts(views());
  return side_.pack(layout_, ranks_);
}

std::vector<TracedParticle> CpuBackend::traced(std::span<const GlobalId> wanted) const {
  std::vector<GlobalId> ids(wanted.begin(), wanted.end());
  std::sort(ids.begin(), ids.end());
  std::vector<TracedParticle> found;
  for (Index i = 0; i < store_.owned; ++i) {
    if (!std::binary_search(ids.begin(), ids.end(), id_of(store_.row_key[i]))) continue;
    ImageCount unused;
    found.push_back({id_of(store_.row_key[i]), subdomain_.wrap(xyz(store_.position[i]), unused),
                     xyz(store_.velocity[i])});
  }
  return found;
}

std::vector<ContactSum> CpuBackend::body_contacts() {
  find_shape_contacts(views());
  return side_.body_contacts(layout_, ranks_);
}

std::vector<ContactSum> CpuBackend::wall_contacts(std::span<const int> walls) {
  std::vector<ContactSum> contacts;
  for (const int wall : walls) {
    Real sums[kWallTerms];
    kernels_->wall_sums(views(), layout_.owned + layout_.items - layout_.first_shape,
                        {wall, layout_.owned, model_.space.min, subdomain_.period()}, ranks_, sums);
    contacts.push_back(make_wall_contact(sums));
  }
  return contacts;
}

}  // namespace scree
