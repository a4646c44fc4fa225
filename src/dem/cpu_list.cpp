#include "dem/cpu_list.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/countable.hpp"

namespace scree {

void CpuList::wrap_positions() {
  ParticleStore& store = items_.store;
  GlobalId bad = CpuItems::kNone;
  for (Index i = 0; i < store.owned; ++i) {
    Vec3 p = xyz(store.position[i]);
    if (!wrap_if_sound(items_.model.space.min, items_.subdomain.period(), store.drifting[i], p,
                       store.image[i]))
      bad = std::min(bad, id_of(store.row_key[i]));
    store.position[i] = vec4(p, store.position[i].w);
  }
  items_.fail_if_any(bad, kUnsoundPosition[0], kUnsoundPosition[1]);
}

// Weights are what a step costs about: one for the particle, one for each entry of its row in the last list.
void CpuList::decompose() {
  const ParticleStore& store = items_.store;
  std::vector<std::int64_t> weight(static_cast<std::size_t>(store.owned), 1);
  if (row_length_.size() == weight.size())
    for (std::size_t i = 0; i < weight.size(); ++i) weight[i] += row_length_[i];
  const DomainGrid grid = make_domain_grid(items_.model.space, builder_.cutoff(items_.model.contact.skin));
  Decomposition next(items_.ranks, grid, {store.position.data(), weight.size()}, weight);
  balance_.rebalances += decomposition_.exists() && next.boxes() != decomposition_.boxes();
  decomposition_ = std::move(next);
}

// migrate: every particle goes to the rank whose box it is in.
void CpuList::migrate() {
  ParticleStore& store = items_.store;
  const Ranks& ranks = items_.ranks;
  if (!decomposition_.exists() || balance_.imbalance > items_.model.parallel.imbalance) decompose();
  std::vector<std::vector<Particle>> leaving(static_cast<std::size_t>(ranks.size()));
  std::vector<Index> staying;
  for (Index i = 0; i < store.owned; ++i) {
    const int owner = decomposition_.owner(xyz(store.position[i]));
    if (owner == ranks.rank())
      staying.push_back(i);
    else
      leaving[static_cast<std::size_t>(owner)].push_back(particle_at(store, i));
  }
  balance_.migrated += store.owned - static_cast<std::int64_t>(staying.size());
  const std::vector<Particle> arriving = ranks.deal_out(leaving);
  countable(staying.size() + arriving.size(), kTooManyParticles);
  store.reorder(staying);
  for (const Particle& particle : arriving) store.add(particle);
}

// Owned particles in the order of their cells; those outside at the end.
void CpuList::sort_cells(Real skin) {
  ParticleStore& store = items_.store;
  const Ranks& ranks = items_.ranks;
  const std::int64_t particles = ranks.sum(static_cast<std::int64_t>(store.owned));
  cells_ = ranks.alone() ? builder_.cells(skin, particles)
                         : builder_.cells(skin, particles, decomposition_.box(ranks.rank(), items_.subdomain),
                                          store.owned + items_.side.shapes().size());
  const Index outside = cells_.own.count();
  std::vector<Index> cell(store.owned), start(outside + 2, 0), from(store.owned);
  store.active = 0;
  for (Index i = 0; i < store.owned; ++i) {
    cell[i] = store.drifting[i] ? outside : cells_.cell(xyz(store.position[i]));
    if (cell[i] < 0) cell[i] = outside;  // has left; whether it may is asked at the end of the step
    store.active += cell[i] != outside;
    ++start[cell[i] + 1];
  }
  std::partial_sum(start.begin(), start.end(), start.begin());
  for (Index i = 0; i < store.owned; ++i) from[start[cell[i]]++] = i;
  store.reorder(from);
}

void CpuList::lay_out_items(Real skin) {
  ParticleStore& store = items_.store;
  ItemLayout& layout = items_.layout;
  Halo& halo = items_.halo;
  ShapeSide& side = items_.side;
  layout.owned = store.owned, layout.active = store.active;
  const Real width = builder_.cutoff(skin);
  halo.exchange(items_.ranks, decomposition_, items_.subdomain,
                {store.position.data(), static_cast<std::size_t>(store.active)}, width);
  layout.first_shape = countable(
      static_cast<std::size_t>(layout.owned) + static_cast<std::size_t>(halo.size()), kTooManyItems);
  layout.shapes_meet = items_.ranks.is_root();

  side.lay_out(width, layout);

  store.resize_items(layout.items);
  for_each_array<kNames | kGhostCopies>([&](auto& array) { halo.update(std::span(array), layout.owned); },
                                        store);
  for (Index g = 0; g < halo.size(); ++g) {
    std::int64_t& key = store.row_key[layout.owned + g];
    key = row_key(id_of(key), halo.images()[g]);
  }
  for (Index item = layout.first_shape; item < layout.items; ++item) {
    store.material[item] = side.shapes().items()[layout.shape_of(item)].material;
    store.row_key[item] = side.row_key_of(layout, item);
  }
}

void CpuList::place_shapes() {
  ParticleStore& store = items_.store;
  const ItemLayout& layout = items_.layout;
  ShapeSide& side = items_.side;
  shape_bound_ += side.place(layout);
  std::copy(side.position().begin(), side.position().end(), store.position.begin() + layout.first_shape);
  std::copy(side.velocity().begin(), side.velocity().end(), store.velocity.begin() + layout.first_shape);
}

void CpuList::place_bodies(std::span<const BodyMotion> motion) {
  items_.side.set_motion(motion);
  if (current_) place_shapes();
}

void CpuList::build(Real skin, StageTimers& timers) {
  {
    const auto scope = timers.time(Stage::migrate);
    wrap_positions();
    if (!items_.ranks.alone()) migrate();
  }
  {
    const auto scope = timers.time(Stage::sort_cells);
    sort_cells(skin);
  }
  {
    const auto scope = timers.time(Stage::exchange_halo);
    lay_out_items(skin);
    items_.refresh_ghosts();
    place_shapes();
  }
  const auto scope = timers.time(Stage::neighbors);
  const ParticleStore& store = items_.store;
  builder_.build(store, items_.layout, cells_, skin, items_.list);
  built_at_ = store.position;
  items_.spare_position = store.position, items_.spare_velocity = store.velocity;
  bound_ = shape_bound_ = 0;
  current_ = true;
  ++builds_;
  const Halo& halo = items_.halo;
  balance_.halo = {store.owned, halo.size(), halo.receivers(),
                   static_cast<std::int64_t>(halo.sent()) * 2 * static_cast<std::int64_t>(sizeof(Vec4))};
  if (!items_.ranks.alone()) measure_balance();
}

// The sum of the steps' largest displacements is cheap; the exact value follows past it.
bool CpuList::covers(Real step) {
  if (!current_) return false;
  bound_ += std::max(step, shape_bound_);
  shape_bound_ = 0;
  return bound_ < items_.list.skin / 2 || displacement() <= 1;
}

Real CpuList::displacement() {
  if (!current_) return 2;
  const ItemLayout& layout = items_.layout;
  Real squared = 0;
  const auto add = [&](Index i) {
    const Vec3 d = xyz(items_.store.position[i]) - xyz(built_at_[i]);
    const Real value = dot(d, d);
    if (!(value <= squared) && !std::isnan(squared)) squared = value;  // a NaN counts as expired
  };
  for (Index i = 0; i < layout.active; ++i) add(i);
  for (Index i = layout.first_shape; i < layout.items; ++i) add(i);
  squared = items_.ranks.max(squared);
  if (!std::isfinite(squared)) return 2;
  bound_ = std::sqrt(squared), shape_bound_ = 0;
  return bound_ / (items_.list.skin / 2);
}

void CpuList::keep_rows(const std::vector<Index>& staying) {
  if (items_.ranks.alone()) return;
  for (std::size_t k = 0; k < staying.size(); ++k) row_length_[k] = row_length_[staying[k]];
  row_length_.resize(staying.size());
}

void CpuList::measure_balance() {
  row_length_.resize(static_cast<std::size_t>(items_.layout.owned));
  std::int64_t weight = items_.layout.owned;
  for (Index i = 0; i < items_.layout.owned; ++i) {
    row_length_[i] = items_.list.offsets[i + 1] - items_.list.offsets[i];
    weight += row_length_[i];
  }
  balance_.imbalance = measure_imbalance(items_.ranks, weight);
  balance_.largest = std::max(balance_.largest, balance_.imbalance);
}

}  // namespace scree
