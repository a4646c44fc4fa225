#include <algorithm>
#include <cmath>

#include "base/countable.hpp"
#include "cuda_explicit.cuh"
#include "cuda_list.cuh"

namespace scree {
namespace {

// Wraps a particle into the periodic box. *bad: smallest id of a particle that is not finite or has
// crossed the whole periodic box.
struct WrapItem {
  ParticleViews in;
  Vec3 box_min, period;
  long long* bad;

  __device__ void operator()(Index i) const {
    Vec3 p = xyz(in.position[i]);
    if (!wrap_if_sound(box_min, period, in.drifting[i] != 0, p, in.image[i]))
      atomicMin(bad, static_cast<long long>(id_of(in.row_key[i])));
    in.position[i] = vec4(p, in.position[i].w);
  }
};

// Key for the sort: the cell; last_cell + 1 for particles outside the search, and last_cell + 2 for those
// that have migrated to other ranks.
struct CellKeyItem {
  const Vec4* position;
  const std::uint8_t* drifting;
  CellBlockGrid grid;
  unsigned outside;
  unsigned* keys;

  SCREE_HD void operator()(Index i) const {
    const CellIndex c = grid.cells.cell_index(xyz(position[i]));
    keys[i] = drifting[i] == kMigrated      ? outside + 1
              : drifting[i] != 0 || c.x < 0 ? outside
                                            : static_cast<unsigned>(grid.key(c.x, c.y, c.z));
  }
};

// What ghosts need once per list: their keys, and the fields copied from their owners.
struct GhostNameItem {
  const Ghost* ghosts;
  FieldArrays<GhostField> fields;
  SCREE_HD void operator()(Index entry) const {
    const Ghost ghost = ghosts[entry];
    for_each_array<kGhostCopies>([&](const auto& copy) { copy.put(entry, copy.field[ghost.source]); },
                                 fields);
    const GhostField<std::int64_t>& key = fields.row_key;
    key.put(entry, row_key(id_of(key.field[ghost.source]), ghost.image));
  }
};

struct GhostKeyItem {
  const Vec4* position;  // of the ghosts
  CellBlockGrid grid;
  unsigned outside;
  unsigned* keys;
  SCREE_HD void operator()(Index g) const {
    const CellIndex c = grid.cells.cell_index(xyz(position[g]));
    keys[g] = c.x < 0 ? outside : static_cast<unsigned>(grid.key(c.x, c.y, c.z));
  }
};

// Key of an item by level and cell.
struct LevelKeyItem {
  const Vec4* position;
  Index active, owned;
  CellGrid space;
  SizeLevels sizes;
  const LevelGrid* levels;
  unsigned outside;
  unsigned* keys;
  SCREE_HD void operator()(Index i) const {
    const Vec4 p = position[i];
    const bool searched = (i < active || i >= owned) && space.cell_index(xyz(p)).x >= 0;
    if (!searched) return static_cast<void>(keys[i] = outside);
    const LevelGrid& level = levels[sizes.of(p.w)];
    const CellIndex c = level.grid.nearest_cell(xyz(p));
    keys[i] = static_cast<unsigned>(level.first_cell + level.grid.index(c.x, c.y, c.z));
  }
};

// Stores the position of a particle.
struct BuiltAtItem {
  const Vec4* position;
  Vec3* built_at;
  SCREE_HD void operator()(Index i) const { built_at[i] = xyz(position[i]); }
};

struct GhostItem {
  const Index* order;
  Index first;
  Index* out;
  SCREE_HD void operator()(Index k) const { out[k] = first + order[k]; }
};

// Of one H200 with the excavator's grains. Steps walk pruned rows, and a share of them makes these from whole
// rows, which counts as part of the search.
constexpr ListCosts kListCosts{.fixed = 16, .search = 17, .walked = 0.35};

}  // namespace

CudaList::CudaList(CudaItems& items, CudaBodies& bodies, CudaImplicitArrays& step_arrays)
    : items_(items),
      bodies_(bodies),
      step_arrays_(step_arrays),
      builder_(items.model),
      owners_(items, builder_),
      choice_(items.model, kListCosts) {}

// An open step of an explicit run is first copied into the state.
void CudaList::commit_open_step() {
  if (items_.open_run != nullptr) items_.open_run->commit_open_step();
}

// After the poses and ghosts were refreshed: the keys of contacts depend on positions.
void CudaList::pack_history() {
  if (!items_.history.at_slots()) return;
  items_.refresh_ghosts();
  bodies_.put();
  items_.ranks.collectively([&] { items_.history.pack_history(items_.listed()); });
}

void CudaList::set_body_motion(std::span<const BodyMotion> motion) {
  bodies_.side().set_motion(motion);
  if (!current_) return;
  bodies_.side().update_poses();
  // An explicit run copies the poses of the surfaces itself, concurrently with its steps.
  if (items_.open_run == nullptr) bodies_.put();
}

void CudaList::wrap_positions() {
  long long* bad = items_.results.clear_id();
  for_each(items_.device(), items_.owned,
           WrapItem{views_of(items_.now), items_.model.space.min, items_.subdomain.period(), bad});
  items_.results.copy(&Results::worst_id);
  if (items_.ranks.alone()) return;  // the sort waits, and counts unsound particles as outside
  wait_for(items_.stream);
  require_sound_positions();
}

void CudaList::require_sound_positions() {
  if (const long long id = items_.ranks.min(items_.results.host().worst_id); id < kNoId)
    throw SimulationError(kUnsoundPosition[0] + std::to_string(id) + kUnsoundPosition[1]);
}

// particles: number over all ranks.
void CudaList::sort_cells(Real skin, std::int64_t particles) {
  const Ranks& ranks = items_.ranks;
  const SearchCells cells =
      ranks.alone()
          ? builder_.cells(skin, particles)
          : builder_.cells(skin, particles, owners_.decomposition().box(ranks.rank(), items_.subdomain),
                           items_.owned);
  grid_ = make_cell_block_grid(builder_.by_finest_cells(cells, skin, items_.owned));
  const auto outside = static_cast<unsigned>(grid_.count());
  const auto owned = static_cast<std::size_t>(items_.owned);
  particle_sort_.use_scratch(items_.list.scratch_space(CellSort::kNumbers * owned), owned);
  for_each(items_.device(), items_.owned,
           CellKeyItem{items_.now.position.data(), items_.now.drifting.data(), grid_, outside,
                       particle_sort_.keys(owned)});
  particle_sort_.sort(items_.device(), items_.owned, outside + 1);
  Results& found = items_.results.host();
  const Index* starts = particle_sort_.starts();
  copy_async(&found.interior, starts + grid_.cells_of(grid_.interior), 1, items_.stream);
  copy_async(&found.active, starts + outside, 1, items_.stream);
  copy_async(&found.staying, starts + outside + 1, 1, items_.stream);
  wait_for(items_.stream);
  if (ranks.alone()) require_sound_positions();
  items_.reorder(particle_sort_.order(), found.staying);
  owners_.arrived();
  items_.interior = found.interior / kStepBlock * kStepBlock;
  items_.layout.owned = items_.owned, items_.layout.active = found.active;
}

// Lays out particles and ghosts, sizes their arrays, and sets the keys of the ghosts.
void CudaList::collect_ghosts(Real width) {
  ItemLayout& layout = items_.layout;
  DeviceHalo& halo = items_.halo_stream.halo;
  ParticleArrays& now = items_.now;
  halo.count(items_.device(), HaloPlan(items_.ranks, owners_.decomposition(), items_.subdomain, width),
             now.position.data(), layout.active);
  items_.ranks.collectively([&] {
    const auto owned = static_cast<std::size_t>(items_.owned);
    layout.items = countable(owned + static_cast<std::size_t>(halo.size()), kTooManyItems);
    halo.list(items_.device(), now.position.data(), layout.active);
    const auto items = static_cast<std::size_t>(layout.items);
    now.grow(items, owned, owned, items_.stream), items_.other.grow(items, owned);
    // Particles that have migrated to other ranks, many of them at the start of a run, shared the arrays with
    // those that arrived.
    now.trim(owned, items_.stream), items_.other.trim(items_.stream);
  });
  set_ghost_keys();
}

void CudaList::set_ghost_keys() {
  constexpr unsigned kKinds = kKeys | kGhostCopies;
  DeviceHalo& halo = items_.halo_stream.halo;
  GhostNameItem item{halo.ghosts(), {}};
  std::vector<HaloMessage> messages;
  for_each_array<kKinds>(
      [&](auto& copy, auto& array) {
        copy = halo.field(static_cast<int>(messages.size()), array.data(), items_.owned);
        messages.push_back(copy.message());
      },
      item.fields, items_.now);
  for_each(items_.device(), halo.entries(), item);
  halo.exchange(items_.device(), messages);
}

void CudaList::lay_out_items(Real skin) {
  collect_ghosts(builder_.cutoff(skin));
  items_.refresh_ghosts();
  bodies_.side().bring_into_box();
  bodies_.side().update_poses();
}

// Index of ghosts by cell.
void CudaList::index_ghosts() {
  const Index ghosts = items_.halo_stream.halo.size();
  if (ghosts == 0) return;
  const auto outside = static_cast<unsigned>(grid_.count());
  for_each(items_.device(), ghosts,
           GhostKeyItem{items_.now.position.data() + items_.owned, grid_, outside,
                        ghost_sort_.keys(static_cast<std::size_t>(ghosts))});
  ghost_sort_.sort(items_.device(), ghosts, outside);
  ghost_items_.resize_with_spare(static_cast<std::size_t>(ghosts));
  for_each(items_.device(), ghosts, GhostItem{ghost_sort_.order(), items_.owned, ghost_items_.data()});
}

// Index of all items by level and cell.
void CudaList::index_levels(Real skin) {
  levels_ = {};
  if (builder_.levels().count == 1) return;
  const Index items = items_.layout.items;
  const std::vector<LevelGrid> grids = builder_.level_grids(grid_.cells, skin, items);
  level_grids_.resize(grids.size());
  copy_async(level_grids_.data(), grids.data(), grids.size(), items_.stream);
  const auto outside = static_cast<unsigned>(grids.back().first_cell + grids.back().grid.count());
  for_each(items_.device(), items,
           LevelKeyItem{items_.now.position.data(), items_.layout.active, items_.owned, grid_.cells.space,
                        builder_.levels(), level_grids_.data(), outside,
                        level_sort_.keys(static_cast<std::size_t>(items))});
  level_sort_.sort(items_.device(), items, outside);
  levels_ = {level_grids_.data(), level_sort_.starts(), level_sort_.order(), static_cast<int>(grids.size())};
  wait_for(items_.stream);  // `grids` is on the host
}

void CudaList::search(Real skin) {
  const ParticleArrays& now = items_.now;
  ListInput in;
  in.position = now.position.data(), in.row_key = now.row_key.data();
  in.grid = grid_;
  in.particle_starts = particle_sort_.starts();
  const bool ghosts = items_.halo_stream.halo.size() > 0;
  in.ghost_starts = ghosts ? ghost_sort_.starts() : nullptr;
  in.ghost_items = ghosts ? ghost_items_.data() : nullptr;
  in.levels = levels_;
  in.active = items_.layout.active, in.owned = items_.owned;
  in.skin = builder_.search_margin(skin);
  items_.list.search(items_.device(), in);
  const DeviceSurfaces::Particles particles{now.position.data(),
                                            now.material.data(),
                                            items_.owned,
                                            items_.layout.active,
                                            &grid_,
                                            particle_sort_.starts(),
                                            builder_.largest_radius(),
                                            items_.list_scratch(),
                                            items_.history.stored_contacts()};
  items_.surfaces.build(items_.device(), particles, bodies_.side().poses(),
                        builder_.search_margin(skin) + frame_.reach());
  items_.list.complete(items_.device(), in);
}

// Arrays of explicit steps that depend on the list. Forces, and with rotation all other values at an instant,
// belong to the synchronous state: no step reads them and the last step of a run writes them all, so that
// until then their memory serves other arrays.
void CudaList::reserve_for_steps() {
  ParticleArrays& now = items_.now;
  const auto in_mixed = static_cast<std::size_t>(items_.in_mixed ? items_.owned : 0);
  const bool rotates = items_.model.rotates();
  const ArenaArray<RowIndex> row_indices = items_.list.reserve_row_indices();
  const ArenaArray fraction{items_.mixed.fraction, in_mixed};
  const ArenaArray rest{items_.mixed.rest, in_mixed};
  const ArenaArray spin_rest{items_.mixed.spin_rest, rotates ? in_mixed : 0};
  const bool in_forces = row_indices.fits(now.force);  // unless rows are long
  items_.arena.lay_out(ArenaArray{built_at_, static_cast<std::size_t>(items_.layout.active)},
                       items_.list.reserve_pruned(), row_indices.unless(in_forces), fraction.unless(rotates),
                       rest.unless(rotates), spin_rest.unless(rotates));
  if (in_forces) row_indices.alias(now.force);
  if (rotates) {
    fraction.alias(now.loss_power), rest.alias(now.acceleration);
    spin_rest.alias(now.angular_acceleration);
  }
}

// The parts of the list that each rank builds alone, which take most of the memory.
void CudaList::find_rows(Real skin) {
  index_ghosts(), index_levels(skin);
  search(skin);
  owners_.note_rows();
  if (items_.model.integrator.particles == ParticleIntegrator::hht) {
    built_at_.resize(static_cast<std::size_t>(items_.layout.active)), step_arrays_.resize(items_);
    items_.history.unpack_history(items_.listed());
  } else {
    items_.history.unpack_history(items_.listed());  // the packed history leaves the scratch memory
    reserve_for_steps();
  }
  for_each(items_.device(), items_.layout.active, BuiltAtItem{items_.now.position.data(), built_at_.data()});
  if (items_.model.integrator.particles != ParticleIntegrator::hht)
    items_.parts.find(items_.device(), items_.surfaces, items_.owned, items_.interior, items_.ranks.alone());
  items_.surfaces.complete(items_.device());
}

// Where an allocation fails the particles are unchanged. Phases in which that is likely run in
// `collectively`, so that all ranks fail at once and can write their last good state.
void CudaList::build(Real skin, StageTimers& timers) {
  if (!committed_) commit_open_step();
  committed_ = false;
  plan_surfaces(skin);
  current_ = false;
  pack_history();
  std::int64_t particles = 0;
  {
    const auto scope = timers.time(Stage::migrate);
    particles = items_.ranks.sum(static_cast<std::int64_t>(items_.owned));
    wrap_positions();
    if (!items_.ranks.alone()) owners_.migrate();
  }
  {
    const auto scope = timers.time(Stage::sort_cells);
    sort_cells(skin, particles);
  }
  {
    const auto scope = timers.time(Stage::exchange_halo);
    lay_out_items(skin);
  }
  const auto scope = timers.time(Stage::neighbors);
  choose_frame(skin);
  items_.ranks.collectively([&] { find_rows(skin); });
  bodies_.side().build_list(skin);
  items_.law_velocity = items_.law_spin = nullptr;
  skin_ = skin, bound_ = 0;
  built_step_ = measured_step_ = followed_step_ = items_.history.step();
  current_ = true;
  if (++builds_ == 1 && choice_.is_open()) limit_skin();
  owners_.measure_balance();
}

}  // namespace scree
