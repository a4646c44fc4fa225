// Who owns which particles, and the neighbour list of the serial backend.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/countable.hpp"
#include "dem/cpu_backend.hpp"

namespace scree {

void CpuBackend::wrap_positions() {
  GlobalId bad = kNone;
  for (Index i = 0; i < store_.owned; ++i) {
    Vec3 p = xyz(store_.position[i]);
    if (!wrap_if_sound(model_.space.min, subdomain_.period(), store_.drifting[i], p, store_.image[i]))
      bad = std::min(bad, id_of(store_.row_key[i]));
    store_.position[i] = vec4(p, store_.position[i].w);
  }
  fail_if_any(bad, kUnsoundPosition[0], kUnsoundPosition[1]);
}

// Weights are what a step costs about: one for the particle, one for each entry of its row in the last list.
void CpuBackend::decompose() {
  std::vector<std::int64_t> weight(static_cast<std::size_t>(store_.owned), 1);
  if (row_length_.size() == weight.size())
    for (std::size_t i = 0; i < weight.size(); ++i) weight[i] += row_length_[i];
  const DomainGrid grid = make_domain_grid(model_.space, builder_.cutoff(model_.contact.skin));
  Decomposition next(ranks_, grid, {store_.position.data(), weight.size()}, weight);
  balance_.rebalances += decomposition_.exists() && next.boxes() != decomposition_.boxes();
  decomposition_ = std::move(next);
}

// migrate: every particle goes to the rank whose box it is in.
void CpuBackend::migrate() {
  if (!decomposition_.exists() || balance_.imbalance > model_.parallel.imbalance) decompose();
  std::vector<std::vector<Particle>> leaving(static_cast<std::size_t>(ranks_.size()));
  std::vector<Index> staying;
  for (Index i = 0; i < store_.owned; ++i) {
    const int owner = decomposition_.owner(xyz(store_.position[i]));
    if (owner == ranks_.rank())
      staying.push_back(i);
    else
      leaving[static_cast<std::size_t>(owner)].push_back(particle_at(store_, i));
  }
  balance_.migrated += store_.owned - static_cast<std::int64_t>(staying.size());
  const std::vector<Particle> arriving = ranks_.deal_out(leaving);
  countable(staying.size() + arriving.size(), kTooManyParticles);
  store_.reorder(staying);
  for (const Particle& particle : arriving) store_.add(particle);
}

// Owned particles in the order of their cells; those outside at the end.
void CpuBackend::sort_cells(Real skin) {
  const std::int64_t particles = ranks_.sum(static_cast<std::int64_t>(store_.owned));
  cells_ = ranks_.alone() ? builder_.cells(skin, particles)
                          : builder_.cells(skin, particles, decomposition_.box(ranks_.rank(), subdomain_),
                                           store_.owned + side_.shapes().size());
  const Index outside = cells_.own.count();
  std::vector<Index> cell(store_.owned), start(outside + 2, 0), from(store_.owned);
  store_.active = 0;
  for (Index i = 0; i < store_.owned; ++i) {
    cell[i] = store_.drifting[i] ? outside : cells_.cell(xyz(store_.position[i]));
    if (cell[i] < 0) cell[i] = outside;  // has left; whether it may is asked at the end of the step
    store_.active += cell[i] != outside;
    ++start[cell[i] + 1];
  }
  std::partial_sum(start.begin(), start.end(), start.begin());
  for (Index i = 0; i < store_.owned; ++i) from[start[cell[i]]++] = i;
  store_.reorder(from);
}

void CpuBackend::lay_out_items(Real skin) {
  layout_.owned = store_.owned, layout_.active = store_.active;
  const Real width = builder_.cutoff(skin);
  halo_.exchange(ranks_, decomposition_, subdomain_,
                 {store_.position.data(), static_cast<std::size_t>(store_.active)}, width);
  layout_.first_shape = countable(
      static_cast<std::size_t>(layout_.owned) + static_cast<std::size_t>(halo_.size()), kTooManyItems);
  layout_.shapes_meet = ranks_.is_root();

  side_.lay_out(width, layout_);

  store_.resize_items(layout_.items);
  for_each_array<kNames | kGhostCopies>([&](auto& array) { halo_.update(std::span(array), layout_.owned); },
                                        store_);
  for (Index g = 0; g < halo_.size(); ++g) {
    std::int64_t& key = store_.row_key[layout_.owned + g];
    key = row_key(id_of(key), halo_.images()[g]);
  }
  for (Index item = layout_.first_shape; item < layout_.items; ++item) {
    store_.material[item] = side_.shapes().items()[layout_.shape_of(item)].material;
    store_.row_key[item] = side_.row_key_of(layout_, item);
  }
}

void CpuBackend::build_list(Real skin, StageTimers& timers) {
  {
    const auto scope = timers.time(Stage::migrate);
    wrap_positions();
    if (!ranks_.alone()) migrate();
  }
  {
    const auto scope = timers.time(Stage::sort_cells);
    sort_cells(skin);
  }
  {
    const auto scope = timers.time(Stage::exchange_halo);
    lay_out_items(skin);
    refresh_ghosts();
    place_shapes();
  }
  const auto scope = timers.time(Stage::neighbors);
  builder_.build(store_, layout_, cells_, skin, list_);
  list_position_ = store_.position;
  spare_position_ = store_.position, spare_velocity_ = store_.velocity;
  displacement_bound_ = step_bound_ = shape_bound_ = 0;
  layout_changed_ = false;
  ++list_builds_;
  balance_.halo = {store_.owned, halo_.size(), halo_.receivers(),
                   static_cast<std::int64_t>(halo_.sent()) * 2 * static_cast<std::int64_t>(sizeof(Vec4))};
  if (!ranks_.alone()) measure_balance();
  if (model_.integrator.particles == ParticleIntegrator::hht) size_step_arrays();
}

void CpuBackend::measure_balance() {
  row_length_.resize(static_cast<std::size_t>(layout_.owned));
  std::int64_t weight = layout_.owned;
  for (Index i = 0; i < layout_.owned; ++i) {
    row_length_[i] = list_.offsets[i + 1] - list_.offsets[i];
    weight += row_length_[i];
  }
  balance_.imbalance = measure_imbalance(ranks_, weight);
  balance_.largest = std::max(balance_.largest, balance_.imbalance);
}

void CpuBackend::size_step_arrays() {
  const std::size_t slots = list_.neighbors.size(), owned = static_cast<std::size_t>(layout_.owned);
  matrix_entries_.resize(slots), direction_.resize(layout_.items);
  step_force_.resize(owned), end_force_.resize(owned), force_magnitude_.resize(owned),
      stiffening_.resize(owned), matrix_count_.resize(owned);
  residual_.resize(owned), right_hand_side_.resize(owned), correction_.resize(owned),
      matrix_diagonal_.resize(owned), inverse_block_.resize(owned);
}

}  // namespace scree
