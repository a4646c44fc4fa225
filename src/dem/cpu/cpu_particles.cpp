#include "dem/cpu/cpu_particles.hpp"

#include <algorithm>
#include <numeric>

#include "base/for_each.hpp"
#include "dem/backend/explicit_run.hpp"
#include "dem/particles/births.hpp"
#include "dem/reports/ledger_items.hpp"

namespace scree {

void CpuParticles::load(const std::vector<Particle>& records, const ShapeLosses& shapes) {
  items_.side.load(shapes);
  count_on_rank(records.size(), items_.model.particles.totals);
  items_.store.load(records);
  items_.history.load({}, items_.store.owned);
  items_.surfaces.load_works({});
  list_.outdate();
}

std::vector<Particle> CpuParticles::records() {
  std::vector<Particle> out = items_.store.records();
  for (Particle& r : out)
    if (!r.drifting) r.position = items_.subdomain.wrap(r.position, r.image);
  return out;
}

PackedHistory CpuParticles::contacts() {
  if (!items_.history.exists()) return {};
  std::vector<Index> order(static_cast<std::size_t>(items_.store.owned));
  std::iota(order.begin(), order.end(), 0);
  const std::vector<std::int64_t>& key = items_.store.row_key;
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return key[a] < key[b]; });
  return items_.history.contacts(items_.listed()).rows(order);
}

std::vector<std::int64_t> CpuParticles::works() {
  std::vector<std::int64_t> words = items_.surfaces.works();
  items_.side.add_works(words);
  return words;
}

void CpuParticles::initial_forces() {
  ParticleStore& store = items_.store;
  items_.refresh_ghosts();
  items_.find_loads();
  items_.kernels->run(items_.views(), items_.layout.owned,
                      ForceRequest{items_.model.gravity, store.force.data(), store.loss_power.data(),
                                   store.angular_acceleration.data()});
  for_each(Serial{}, items_.layout.owned,
           StartAccelerationItem{store.force.data(), store.velocity.data(), store.acceleration.data()});
  if (is_verlet(items_.model))
    items_.side.accumulate_losses(0);
  else
    std::fill(store.loss_power.begin(), store.loss_power.end(), 0);
}

std::vector<std::uint8_t> CpuParticles::overlapped(const CandidateGrid& candidates) {
  std::vector<std::uint8_t> found(static_cast<std::size_t>(candidates.size()), 0);
  const ParticleStore& store = items_.store;
  for_each(Serial{}, store.owned,
           CandidateItem{candidates.views(), store.position.data(), store.drifting.data(), found.data()});
  return on_any_rank(items_.ranks, std::move(found));
}

void CpuParticles::insert(const std::vector<Particle>& born) {
  list_.pack_history();
  const std::vector<Particle> own = list_.owned(born);
  for (const Particle& particle : own) items_.store.add(particle);
  items_.history.append_empty(static_cast<std::int64_t>(own.size()));
  list_.append_rows(own.size());
  list_.outdate();
}

std::vector<EscapedParticle> CpuParticles::find_leaving(std::span<const OutletRegion> outlets) {
  ParticleStore& store = items_.store;
  const Model& model = items_.model;
  const Ranks& ranks = items_.ranks;
  const ParticleViews views = views_of(store);
  std::vector<EscapedParticle> escaped_particles;
  space_ = RemainingSpace(items_.subdomain, model.space.min, outlets);
  if (!ranks.any(items_.any_outside(space_))) return escaped_particles;
  for (Index i = 0; i < store.owned; ++i) {
    const Vec3 p = xyz(store.position[i]);
    if (store.drifting[i] || space_.holds(p)) continue;
    const Real energy = energy_of_motion(views, i, model.gravity, items_.subdomain.period());
    const Real shift = verlet_energy_shift(verlet_step(model), views, i);
    escaped_particles.push_back({id_of(store.row_key[i]), i, p, items_.subdomain.is_beyond_wall(p), energy,
                                 store.contact_loss[i], store.integrator_loss[i] - shift, losses_of(views, i),
                                 0, ranks.rank(), space_.box.inside(p) ? space_.outlet_at(p) : -1,
                                 store.velocity[i].w});
  }
  items_.find_loads();
  items_.kernels->run(items_.views(), static_cast<Index>(escaped_particles.size()),
                      EscapeRequest{space_, escaped_particles.data()});
  escaped_particles = ranks.all_gather(std::move(escaped_particles));
  std::sort(escaped_particles.begin(), escaped_particles.end(),
            [](const EscapedParticle& a, const EscapedParticle& b) { return a.global_id < b.global_id; });
  return escaped_particles;
}

// Called before the escaped particles are wrapped and marked.
void CpuParticles::remove_escaped_contacts() {
  ParticleStore& store = items_.store;
  const Model& model = items_.model;
  const bool verlet = is_verlet(model);
  const DepartureRequest request{
      model.gravity,
      space_,
      {store.force.data(), store.acceleration.data(), verlet ? store.loss_power.data() : nullptr,
       store.integrator_loss.data(), store.drifting.data(), verlet ? hht_coefficients(0) : items_.hht,
       verlet_step(model), store.angular_acceleration.data()}};
  items_.kernels->run(items_.views(store.position, verlet ? items_.spare_velocity : store.velocity,
                                   verlet ? items_.spare_spin : store.angular_velocity),
                      items_.layout.owned, request);
}

void CpuParticles::remove_escaped(const std::vector<EscapedParticle>& escaped_particles) {
  ParticleStore& store = items_.store;
  remove_escaped_contacts();
  items_.history.pack_history(items_.listed());
  const OutsidePolicy policy = items_.model.space.leaving;
  for (const EscapedParticle& escaped_particle : escaped_particles) {
    if (escaped_particle.rank != items_.ranks.rank()) continue;
    const auto i = static_cast<std::size_t>(escaped_particle.local_index);
    const Vec4& p = store.position[i];
    store.position[i] = vec4(items_.subdomain.wrap(xyz(p), store.image[i]), p.w);
    store.drifting[i] = escaped_particle.is_removed(policy) ? kRemoved : 1;
  }
  list_.outdate();
  std::vector<Index> remaining;
  for (Index i = 0; i < store.owned; ++i)
    if (store.drifting[i] != kRemoved) remaining.push_back(i);
  if (std::ssize(remaining) == store.owned) return;
  list_.retain_rows(remaining);
  store.reorder(remaining), items_.history.reorder(remaining);
}

}  // namespace scree
