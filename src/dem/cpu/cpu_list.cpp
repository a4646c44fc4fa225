#include "dem/cpu/cpu_list.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/countable.hpp"
#include "base/host_memory.hpp"
#include "dem/particles/births.hpp"
#include "model/derived/choose_law.hpp"

namespace scree {
namespace {

// Measured with the excavator and the drum of input/examples.
constexpr ListCosts kListCosts{.fixed = 30, .search = 8};
// Share of the free host memory that wider lists may take.
constexpr Real kMemoryShare = 0.25;

}  // namespace

CpuList::CpuList(CpuItems& items) : items_(items), builder_(items.model), choice_(items.model, kListCosts) {}

// Packs the contact history. Ghosts are refreshed first, because contact keys depend on current positions.
void CpuList::pack_history() {
  if (!items_.history.at_slots()) return;
  items_.refresh_ghosts();
  items_.history.pack_history(items_.listed());
}

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

// Weights estimate the cost of a step: one for the particle, one for each entry of its row in the last list.
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

// Stage migrate: every particle moves to the rank whose box contains it.
void CpuList::migrate() {
  ParticleStore& store = items_.store;
  const Ranks& ranks = items_.ranks;
  if (!decomposition_.exists() || balance_.imbalance > items_.model.parallel.imbalance) decompose();
  std::vector<std::vector<Particle>> departing(static_cast<std::size_t>(ranks.size()));
  std::vector<std::vector<Index>> departing_indices(departing.size());  // their local indices
  std::vector<Index> remaining;
  for (Index i = 0; i < store.owned; ++i) {
    const int owner = decomposition_.owner(xyz(store.position[i]));
    if (owner == ranks.rank()) {
      remaining.push_back(i);
      continue;
    }
    departing[static_cast<std::size_t>(owner)].push_back(particle_at(store, i));
    departing_indices[static_cast<std::size_t>(owner)].push_back(i);
  }
  balance_.migrated += store.owned - static_cast<std::int64_t>(remaining.size());
  const std::vector<Particle> arriving = ranks.all_to_all(departing);
  countable(remaining.size() + arriving.size(), kTooManyParticles);
  items_.history.migrate(ranks, departing_indices, remaining);
  store.reorder(remaining);
  for (const Particle& particle : arriving) store.add(particle);
}

namespace {

// Order of the cells, with the shortest axis fastest: cells that are neighbours in the domain are then as
// close in memory as possible, and most neighbours are still in the caches.
class CellOrder {
 public:
  explicit CellOrder(const CellGrid& grid) {
    int axes[3] = {0, 1, 2};
    std::stable_sort(axes, axes + 3, [&](int a, int b) { return grid.cells[a] < grid.cells[b]; });
    Index stride = 1;
    for (const int axis : axes) stride_[axis] = std::exchange(stride, stride * grid.cells[axis]);
  }
  Index operator()(const CellIndex& c) const {
    return stride_[0] * c.x + stride_[1] * c.y + stride_[2] * c.z;
  }

 private:
  Index stride_[3];
};

}  // namespace

// Sorts the owned particles by cell; those outside come last.
void CpuList::sort_cells(Real skin) {
  ParticleStore& store = items_.store;
  const Ranks& ranks = items_.ranks;
  const std::int64_t particles = ranks.sum(static_cast<std::int64_t>(store.owned));
  cells_ = ranks.alone() ? builder_.cells(skin, particles)
                         : builder_.cells(skin, particles, decomposition_.box(ranks.rank(), items_.subdomain),
                                          store.owned);
  const CellGrid finest = builder_.finest_cells(cells_, skin, store.owned);
  const CellOrder order(finest);
  const Index outside = finest.count();
  std::vector<Index> cell(store.owned), start(outside + 2, 0), from(store.owned);
  store.active = 0;
  for (Index i = 0; i < store.owned; ++i) {
    const Vec3 p = xyz(store.position[i]);
    // A particle without a cell is outside the domain; whether that is an error is decided at the end of the
    // step.
    const bool searched = !store.drifting[i] && cells_.space.cell_index(p).x >= 0;
    cell[i] = searched ? order(finest.nearest_cell(p)) : outside;
    store.active += cell[i] != outside;
    ++start[cell[i] + 1];
  }
  std::partial_sum(start.begin(), start.end(), start.begin());
  for (Index i = 0; i < store.owned; ++i) from[start[cell[i]]++] = i;
  store.reorder(from), items_.history.reorder(from);
}

void CpuList::lay_out_items(Real skin) {
  ParticleStore& store = items_.store;
  ItemLayout& layout = items_.layout;
  Halo& halo = items_.halo;
  layout.owned = store.owned, layout.active = store.active;
  halo.exchange(items_.ranks, decomposition_, items_.subdomain,
                {store.position.data(), static_cast<std::size_t>(store.active)}, builder_.levels(),
                builder_.level_space(builder_.search_margin(skin)));
  layout.items = countable(static_cast<std::size_t>(layout.owned) + static_cast<std::size_t>(halo.size()),
                           kTooManyItems);
  store.resize_items(layout.items);
  for_each_array<kKeys | kGhostCopies>([&](auto& array) { halo.update(std::span(array), layout.owned); },
                                       store);
  for (Index g = 0; g < halo.size(); ++g) {
    std::int64_t& key = store.row_key[layout.owned + g];
    key = row_key(id_of(key), halo.images()[g]);
  }
}

void CpuList::set_body_motion(std::span<const BodyMotion> motion) {
  items_.side.set_motion(motion);
  if (!current_) return;
  items_.side.update_poses();
  surface_bound_ += items_.side.last_displacement();
}

void CpuList::build(Real skin, StageTimers& timers) {
  {
    const auto scope = timers.time(Stage::migrate);
    const bool known = current_ && steps_ > 0 && lists_leave_no_trace(items_.model);
    if (known) displacement();
    items_.side.plan_list(skin, known ? moved_ : HostSurfaces::kNoMotion);
    pack_history();
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
    items_.side.bring_into_box();
    items_.side.update_poses();
  }
  const auto scope = timers.time(Stage::neighbors);
  choose_frame(skin);
  const ParticleStore& store = items_.store;
  builder_.build(store, items_.layout, cells_,
                 {items_.side.poses(), items_.history.stored_contacts(), frame_.reach()}, skin, items_.list);
  items_.pairs.is_current = items_.pairs.has_records = false;
  items_.side.build_list(skin);
  items_.history.unpack_history(items_.listed());
  built_at_ = store.position;
  items_.spare_position = store.position, items_.spare_velocity = store.velocity;
  items_.spare_spin = store.angular_velocity;
  bound_ = surface_bound_ = 0, steps_ = 0;
  current_ = true;
  if (++builds_ == 1 && choice_.is_open()) limit_skin();
  const Halo& halo = items_.halo;
  balance_.halo = {store.owned, halo.size(), halo.receivers(),
                   static_cast<std::int64_t>(halo.sent()) * 2 * static_cast<std::int64_t>(sizeof(Vec4))};
  if (!items_.ranks.alone()) measure_balance();
}

// The sum of the steps' largest displacements is a cheap bound; where it is too large the exact value is
// computed.
bool CpuList::covers(Real step, Real h) {
  if (!current_) return false;
  ++steps_, frame_.move(h);
  bound_ += std::max(step, surface_bound_);
  surface_bound_ = 0;
  if (!frame_.covers_surfaces()) return false;
  return bound_ < items_.list.skin / 2 || displacement() <= 1;
}

Real CpuList::displacement() {
  if (!current_) return 2;
  Real squared = 0;
  for (Index i = 0; i < items_.layout.active; ++i) {
    const Vec3 d = xyz(items_.store.position[i]) - xyz(built_at_[i]) - frame_.displacement();
    const Real value = dot(d, d);
    if (!(value <= squared) && !std::isnan(squared)) squared = value;  // a NaN counts as expired
  }
  Real largest[2] = {std::sqrt(squared), items_.side.list_displacement()};
  items_.ranks.max(largest);
  if (!std::isfinite(largest[0]) || !std::isfinite(largest[1])) return 2;
  moved_ = largest[0];
  bound_ = std::max(largest[0], largest[1]), surface_bound_ = 0;
  return bound_ / (items_.list.skin / 2);
}

Real CpuList::choose_skin() {
  if (choice_.is_open() && current_ && steps_ > 0 && displacement() < kInfinity) choice_.note(bound_, steps_);
  return choice_.next();
}

// The frame moves only where some particles fall.
void CpuList::choose_frame(Real skin) {
  frame_ = {};
  const Model& model = items_.model;
  if (!lists_leave_no_trace(model) || model.gravity == Vec3{}) return;
  const Vec3 down = (1 / norm(model.gravity)) * model.gravity;
  const auto largest = [&](const auto& value) {
    Real most = 0;
    for (Index i = 0; i < items_.layout.active; ++i)
      most = std::max(most, value(xyz(items_.store.velocity[i])));
    return items_.ranks.max(most);
  };
  const Real most = largest([&](Vec3 v) { return dot(v, down); });
  if (!(most > 0)) return;
  const Real least = most - largest([&](Vec3 v) { return most - dot(v, down); });
  const Vec3 fall = ListFrame::mean_fall(model.gravity, least, most);
  frame_ = {model.gravity,
            least,
            most,
            largest([](Vec3 v) { return norm(v); }),
            largest([&](Vec3 v) { return norm(v - fall); }),
            skin,
            kMostFrameReach * model.particles.totals.largest_radius};
}

void CpuList::limit_skin() {
  const FreeMemory memory = free_memory();
  const Real per_entry = 2 * sizeof(Index) + 2 * history_of(items_.model.contact) * sizeof(Real),
             free = kMemoryShare * std::min(memory.host.bytes / items_.ranks.size(), memory.process.bytes);
  const Real limit = choice_.limit_in_memory(free, static_cast<Real>(entries()), per_entry);
  choice_.limit_to(1 / items_.ranks.max(1 / limit));  // the smallest limit of all ranks
}

void CpuList::append_rows(std::size_t particles) {
  if (!row_length_.empty()) row_length_.resize(row_length_.size() + particles, 0);
}

std::vector<Particle> CpuList::owned(const std::vector<Particle>& particles) const {
  return owned_by(items_.ranks, decomposition_, particles);
}

void CpuList::retain_rows(const std::vector<Index>& remaining) {
  if (items_.ranks.alone()) return;
  for (std::size_t k = 0; k < remaining.size(); ++k) row_length_[k] = row_length_[remaining[k]];
  row_length_.resize(remaining.size());
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
