#include <algorithm>
#include <utility>

#include "cuda_step_queue.cuh"

namespace scree {
namespace {

// Refreshes a ghost in the arrays of the open step.
struct RunGhostItem {
  const Ghost* ghosts;
  GhostField<Vec4> position[2], velocity[2];
  const VerletControl* control;

  __device__ void operator()(Index entry) const {
    MotionGhostItem{ghosts, control->parity[0] == 0 ? position[0] : position[1],
                    control->parity[1] == 0 ? velocity[0] : velocity[1]}(entry);
  }
};

struct RunSpinGhostItem {
  const Ghost* ghosts;
  GhostField<Vec4> spin[2];
  const VerletControl* control;

  __device__ void operator()(Index entry) const {
    SpinGhostItem{ghosts, control->parity[1] == 0 ? spin[0] : spin[1]}(entry);
  }
};

struct MixedGhostItem {
  const Ghost* ghosts;
  GhostField<FixedPointPosition> position[2];
  GhostField<MixedMotion> motion[2];
  QuantumGrid grid;
  const VerletControl* control;

  __device__ void operator()(Index entry) const {
    const bool first = control->parity[0] == 0;
    const Ghost ghost = ghosts[entry];
    const GhostField<FixedPointPosition>& places = first ? position[0] : position[1];
    const GhostField<MixedMotion>& motions = first ? motion[0] : motion[1];
    places.put(entry, shifted(grid, places.field[ghost.source], ghost.shift));
    motions.put(entry, motions.field[ghost.source]);
  }
};

struct MixedSpinGhostItem {
  const Ghost* ghosts;
  GhostField<MixedSpin> spin[2];
  const VerletControl* control;

  __device__ void operator()(Index entry) const {
    const GhostField<MixedSpin>& spins = control->parity[0] == 0 ? spin[0] : spin[1];
    spins.put(entry, spins.field[ghosts[entry].source]);
  }
};

}  // namespace

PrunedViews StepQueue::pruned_views(const Vec4* position) {
  PrunedViews views =
      items_.surfaces.views(position, nullptr, items_.now.material.data(), items_.list.pruned_rows());
  views.history = items_.history.views_in_run(),
  views.interaction_range = items_.model.contact.interaction_range;
  return views;
}

VerletRequest StepQueue::request() {
  ParticleArrays& now = items_.now;
  SecondArrays& other = items_.other;
  VerletRequest r{};
  r.in = pruned_views(nullptr);
  r.rows = items_.parts.whole(), r.active = items_.layout.active, r.gravity = items_.model.gravity;
  r.position[0] = now.position.data(), r.position[1] = other.position.data();
  r.velocity[0] = now.velocity.data(), r.velocity[1] = other.velocity.data();
  r.spin[0] = now.angular_velocity.data(), r.spin[1] = other.angular_velocity.data();
  r.state = {nullptr,
             nullptr,
             now.acceleration.data(),
             now.contact_loss.data(),
             now.loss_power.data(),
             h_,
             items_.subdomain.snap_constant(),
             now.angular_velocity.data(),
             now.angular_acceleration.data(),
             now.orientation.data(),
             {now.friction_loss.data(), now.rolling_loss.data(), now.twisting_loss.data()}};
  r.force = now.force.data();
  r.box = items_.subdomain.box();
  r.drifting = now.drifting.data();
  r.control = control_.on_device();
  r.first_step = items_.history.first_step();
  return r;
}

OpenStepQuery StepQueue::surface_query(const VerletRequest& r) {
  return {r.control,
          r.first_step,
          {r.position[0], r.position[1]},
          {r.velocity[0], r.velocity[1]},
          {r.spin[0], r.spin[1]},
          {items_.history.surface_views_in_run(false), items_.history.surface_views_in_run(true)}};
}

// Null unless particles rotate.
Vec4* StepQueue::spins() const {
  return items_.model.rotates() ? items_.now.angular_velocity.data() : nullptr;
}

void StepQueue::convert_to_mixed() {
  ParticleArrays& now = items_.now;
  mixed_ = {make_quantum_grid(list_.cutoff()), control_.seen().closed};
  // The ghosts come with the halo exchange of the first step.
  for_each(items_.device(), items_.owned,
           ToMixedItem{now.position.data(), now.velocity.data(), spins(), now.acceleration.data(),
                       mixed_views(), mixed_->quanta, items_.subdomain.box(), h_, list_.skin() / 2});
}

void StepQueue::convert_from_mixed() {
  ParticleArrays& now = items_.now;
  for_each(items_.device(), items_.owned,
           FromMixedItem{mixed_views(), control_.position_parity(), mixed_->quanta, now.position.data(),
                         now.velocity.data(), spins(), now.acceleration.data(), now.contact_loss.data(),
                         now.friction_loss.data(), now.drifting.data(), items_.model.gravity, h_,
                         control_.seen().closed - mixed_->start});
  mixed_.reset();
}

void StepQueue::gather_open_step() {
  if (mixed_) {
    convert_from_mixed();
  } else {
    if (control_.position_parity() == 1) std::swap(items_.now.position, items_.other.position);
    if (control_.velocity_parity() == 1) {
      std::swap(items_.now.velocity, items_.other.velocity);
      std::swap(items_.now.angular_velocity, items_.other.angular_velocity);
      items_.history.commit_next();
    }
  }
  control_.reset_parity();
}

// queue_surfaces(device): what rows near surfaces wait for; queue_ghosts(device, k): the halo exchange of the
// k-th step from now; queue_rows(device, rows): the kernel of a step for these rows; key: everything that the
// launches depend on; boundary_done: recorded after the boundary rows, if not null.
template <class QueueSurfaces, class QueueGhosts, class QueueRows>
void StepQueue::queue_successively(const std::string& key, Index steps, const QueueSurfaces& queue_surfaces,
                                   const QueueGhosts& queue_ghosts, const QueueRows& queue_rows,
                                   Event* boundary_done) {
  const Device rows = items_.device(), lane{items_.halo_stream.stream};
  const StepParts& parts = items_.parts;
  const auto queue_boundary = [&](Device on) {
    if (parts.apart()) queue_surfaces(on);
    queue_rows(on, parts.boundary());
    if (boundary_done != nullptr) boundary_done->record(on.stream);
  };
  if (!items_.ranks.alone()) {
    const auto queue_interior = [&](Device on) {
      if (parts.interior().launched > 0) queue_rows(on, parts.interior());
    };
    return queue_with_ranks(steps, queue_surfaces, queue_ghosts, queue_interior, queue_boundary);
  }
  workspace_.graph.queue(items_.stream, key, steps, [&] {
    queue_ghosts(rows, 0);
    if (!parts.apart()) return queue_surfaces(rows), queue_rows(rows, parts.whole());
    items_.fork_halo_stream();
    queue_boundary(lane);
    queue_rows(rows, parts.interior());
    items_.join_halo_stream();
  });
}

// The same for several ranks. After each step they reduce what decides whether the next one may be taken.
template <class QueueSurfaces, class QueueGhosts, class QueueInterior, class QueueBoundary>
void StepQueue::queue_with_ranks(Index steps, const QueueSurfaces& queue_surfaces,
                                 const QueueGhosts& queue_ghosts, const QueueInterior& queue_interior,
                                 const QueueBoundary& queue_boundary) {
  const Device halo{items_.halo_stream.stream};
  items_.halo_after_rows();
  for (Index k = 0; k < steps; ++k) {
    if (!items_.parts.apart()) queue_surfaces(items_.device()), items_.halo_after_rows();
    // The clock measures the second step: the first one waits for the host, and later ones may be past a
    // stop, where nothing hides the halo exchange.
    HaloClock* clock = k == std::min<Index>(1, steps - 1) ? &items_.halo_stream.clock : nullptr;
    items_.queue_around_halo([&](Device on) { queue_ghosts(on, k); }, queue_interior, queue_boundary, clock);
    items_.halo_stream.halo.max(halo, control_.on_device()->shared, 2);
    control_.close(halo);
    items_.rows_after_halo();
  }
  require_cuda(cudaGetLastError(), "explicit step");
}

// The host knows where queued steps read their ghosts: after a stop nothing is read any more.
void StepQueue::queue_double(Index steps, const MovingSurfaces* moving) {
  DeviceHalo& halo = items_.halo_stream.halo;
  const VerletRequest r = request();
  const auto field = [&](int buffer, Vec4* const(&of)[2], int parity) {
    return halo.field(buffer, of[parity], items_.owned);
  };
  const RunGhostItem ghosts{halo.ghosts(),
                            {field(0, r.position, 0), field(0, r.position, 1)},
                            {field(1, r.velocity, 0), field(1, r.velocity, 1)},
                            r.control};
  const bool rotates = items_.model.rotates();
  RunSpinGhostItem spins{halo.ghosts(), {}, r.control};
  if (rotates) spins.spin[0] = field(2, r.spin, 0), spins.spin[1] = field(2, r.spin, 1);
  const auto queue_ghosts = [&](Device on, Index k) {
    for_each(on, halo.entries(), ghosts);
    const auto& position = ghosts.position[(control_.position_parity() + k) % 2];
    const Index parity = (control_.velocity_parity() + k) % 2;
    if (!rotates) return halo.exchange(on, position, ghosts.velocity[parity]);
    for_each(on, halo.entries(), spins);
    halo.exchange(on, position, ghosts.velocity[parity], spins.spin[parity]);
  };
  const auto queue_rows = [&](Device on, const StepRows& rows) {
    VerletRequest of_rows = r;
    of_rows.rows = rows;
    items_.kernels->verlet_advance(on, of_rows);
  };
  const std::string key =
      key_of(r) + key_of(items_.parts.interior()) + key_of(ghosts) + key_of(halo.entries());
  const DeviceContactKernels& kernels = *items_.kernels;
  DeviceSurfaces& surfaces = items_.surfaces;
  const auto no_surfaces = [](Device) {};
  if (moving != nullptr)
    return queue_successively(
        key, steps, [&](Device on) { moving->loads_found.hold(on.stream); }, queue_ghosts, queue_rows,
        &moving->boundary_done);
  if (!surfaces.any_placed()) return queue_successively(key, steps, no_surfaces, queue_ghosts, queue_rows);
  surfaces.reserve_in_run(items_.device(), steps);
  const OpenStepQuery query = surface_query(r);
  queue_successively(
      key + surfaces.key_of_loads(kernels, query, h_), steps,
      [&](Device on) { surfaces.find_loads_in_run(on, kernels, query, h_); }, queue_ghosts, queue_rows);
}

void StepQueue::queue_mixed(Index steps) {
  if (!mixed_) convert_to_mixed();
  DeviceHalo& halo = items_.halo_stream.halo;
  MixedRequest r{};
  r.in = pruned_views(items_.now.position.data()), r.rows = items_.parts.whole();
  r.active = items_.layout.active;
  r.gravity = items_.model.gravity;
  r.state = mixed_views(), r.grid = mixed_->quanta, r.h = h_;
  r.orientation = items_.now.orientation.data();
  r.box = items_.subdomain.box(), r.drifting = items_.now.drifting.data(), r.control = control_.on_device();
  r.first_step = items_.history.first_step();
  const auto field = [&](int buffer, auto* of) { return halo.field(buffer, of, items_.owned); };
  const MixedGhostItem ghosts{halo.ghosts(),
                              {field(0, r.state.position[0]), field(0, r.state.position[1])},
                              {field(1, r.state.motion[0]), field(1, r.state.motion[1])},
                              r.grid,
                              r.control};
  const bool rotates = items_.model.rotates();
  MixedSpinGhostItem spins{halo.ghosts(), {}, r.control};
  if (rotates) spins.spin[0] = field(2, r.state.spin[0]), spins.spin[1] = field(2, r.state.spin[1]);
  const auto queue_ghosts = [&](Device on, Index k) {
    for_each(on, halo.entries(), ghosts);
    const Index parity = (control_.position_parity() + k) % 2;
    if (!rotates) return halo.exchange(on, ghosts.position[parity], ghosts.motion[parity]);
    for_each(on, halo.entries(), spins);
    halo.exchange(on, ghosts.position[parity], ghosts.motion[parity], spins.spin[parity]);
  };
  const auto queue_rows = [&](Device on, const StepRows& rows) {
    MixedRequest of_rows = r;
    of_rows.rows = rows;
    items_.kernels->mixed_advance(on, of_rows);
  };
  const std::string key =
      key_of(r) + key_of(items_.parts.interior()) + key_of(ghosts) + key_of(halo.entries());
  queue_successively(
      key, steps, [](Device) {}, queue_ghosts, queue_rows);
}

}  // namespace scree
