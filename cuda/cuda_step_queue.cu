#include <algorithm>
#include <utility>
#include <vector>

#include "cuda_step_queue.cuh"

namespace scree {
namespace {

// Refreshes a ghost in the arrays of the open step. Field: `GhostField`, or `PeerField`, for which ghosts are
// also taken out of the mailbox. Without padding, because graphs are found by the bytes of their arguments.
template <template <class> class Field>
struct RunGhostItem {
  const Ghost* ghosts;
  const VerletControl* control;
  Field<Vec4> position[2], velocity[2], spin[2];  // spin: empty where particles do not rotate

  __device__ const Field<Vec4>& open(const Field<Vec4> (&of)[2], int which) const {
    return control->parity[which] == 0 ? of[0] : of[1];
  }
  __device__ void put(Index entry) const {
    const Ghost ghost = ghosts[entry];
    const Field<Vec4>&positions = open(position, 0), &velocities = open(velocity, 1);
    positions.put(entry, moved(ghost, positions.field[ghost.source]));
    velocities.put(entry, velocities.field[ghost.source]);
    if (spin[0].field == nullptr) return;
    const Field<Vec4>& spins = open(spin, 1);
    spins.put(entry, spins.field[ghost.source]);
  }
  __device__ void take(Index k) const {
    open(position, 0).take(k), open(velocity, 1).take(k);
    if (spin[0].field != nullptr) open(spin, 1).take(k);
  }
  __device__ void operator()(Index entry) const { put(entry); }
};

template <template <class> class Field>
struct MixedGhostItem {
  const Ghost* ghosts;
  const VerletControl* control;
  Field<FixedPointPosition> position[2];
  Field<MixedMotion> motion[2];
  Field<MixedSpin> spin[2];
  QuantumGrid grid;

  template <class T>
  __device__ const Field<T>& open(const Field<T> (&of)[2]) const {
    return control->parity[0] == 0 ? of[0] : of[1];
  }
  __device__ void put(Index entry) const {
    const Ghost ghost = ghosts[entry];
    const Field<FixedPointPosition>& positions = open(position);
    const Field<MixedMotion>& motions = open(motion);
    positions.put(entry, shifted(grid, positions.field[ghost.source], ghost.shift));
    motions.put(entry, motions.field[ghost.source]);
    if (spin[0].field == nullptr) return;
    const Field<MixedSpin>& spins = open(spin);
    spins.put(entry, spins.field[ghost.source]);
  }
  __device__ void take(Index k) const {
    open(position).take(k), open(motion).take(k);
    if (spin[0].field != nullptr) open(spin).take(k);
  }
  __device__ void operator()(Index entry) const { put(entry); }
};

// field(number, pointer): the `Field` of an array.
template <template <class> class Field, class MakeField>
RunGhostItem<Field> ghost_item(const VerletRequest& r, const Ghost* ghosts, bool rotates,
                               const MakeField& field) {
  RunGhostItem<Field> item{};
  item.ghosts = ghosts, item.control = r.control;
  for (int k = 0; k < 2; ++k) {
    item.position[k] = field(0, r.position[k]), item.velocity[k] = field(1, r.velocity[k]);
    if (rotates) item.spin[k] = field(2, r.spin[k]);
  }
  return item;
}

template <template <class> class Field, class MakeField>
MixedGhostItem<Field> ghost_item(const MixedRequest& r, const Ghost* ghosts, bool rotates,
                                 const MakeField& field) {
  MixedGhostItem<Field> item{};
  item.ghosts = ghosts, item.control = r.control, item.grid = r.grid;
  for (int k = 0; k < 2; ++k) {
    item.position[k] = field(0, r.state.position[k]), item.motion[k] = field(1, r.state.motion[k]);
    if (rotates) item.spin[k] = field(2, r.state.spin[k]);
  }
  return item;
}

// Messages of the fields that a step reads, by the parities of the step. All ranks have as many.
std::vector<HaloMessage> messages_of(const RunGhostItem<GhostField>& item, bool rotates, int position,
                                     int velocity) {
  std::vector<HaloMessage> messages{item.position[position].message(), item.velocity[velocity].message()};
  if (rotates) messages.push_back(item.spin[velocity].message());
  return messages;
}

std::vector<HaloMessage> messages_of(const MixedGhostItem<GhostField>& item, bool rotates, int position,
                                     int) {
  std::vector<HaloMessage> messages{item.position[position].message(), item.motion[position].message()};
  if (rotates) messages.push_back(item.spin[position].message());
  return messages;
}

// The step of a batch that the clock of the halo measures: the second, because the first one waits for the
// host, and later ones may be past a stop, where nothing hides the halo exchange.
Index timed_step(Index steps) { return std::min<Index>(1, steps - 1); }

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
             {SCREE_LOSS_KINDS(SCREE_LOSS_POINTER, now)}};
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
          {items_.history.surface_views_in_run(false), items_.history.surface_views_in_run(true)},
          workspace_.driven ? workspace_.driven->poses() : PosesInRun{}};
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
    if (items_.halo_stream.halo.peers() != nullptr)
      return queue_with_peers(key, steps, queue_surfaces, queue_ghosts, queue_interior, queue_boundary);
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
    HaloClock* clock = k == timed_step(steps) ? &items_.halo_stream.clock : nullptr;
    items_.queue_around_halo([&](Device on) { queue_ghosts(on, k); }, queue_interior, queue_boundary, clock);
    control_.close(halo);
    items_.rows_after_halo();
  }
  require_cuda(cudaGetLastError(), "explicit step");
}

// The same where the GPUs exchange ghosts without the host. A step is then a fixed set of launches, so that
// batches are graphs as on one rank, after a step that is timed, which a graph cannot be. The exchange is
// queued before the interior fills the GPU, and does not wait for the contacts with surfaces.
template <class QueueSurfaces, class QueueGhosts, class QueueInterior, class QueueBoundary>
void StepQueue::queue_with_peers(const std::string& key, Index steps, const QueueSurfaces& queue_surfaces,
                                 const QueueGhosts& queue_ghosts, const QueueInterior& queue_interior,
                                 const QueueBoundary& queue_boundary) {
  const Device rows = items_.device(), halo{items_.halo_stream.stream};
  const auto queue_step = [&](HaloClock* clock) {
    items_.halo_after_rows();
    if (clock != nullptr) clock->begin(halo.stream);
    queue_ghosts(halo, 0);
    if (clock != nullptr) clock->end(halo.stream);
    if (!items_.parts.apart()) queue_surfaces(rows), items_.halo_after_rows();
    queue_interior(rows);
    if (clock != nullptr) clock->interior_done(rows.stream);
    queue_boundary(halo);
    items_.halo_after_rows();
    control_.close(halo);
    items_.rows_after_halo();
  };
  const Index timed = timed_step(steps), one_by_one = timed + 1 + (steps - timed - 1) % StepGraph::kSteps;
  for (Index k = 0; k < one_by_one; ++k) queue_step(k == timed ? &items_.halo_stream.clock : nullptr);
  workspace_.graph.queue(items_.stream, key, steps - one_by_one, [&] { queue_step(nullptr); });
  require_cuda(cudaGetLastError(), "explicit step");
}

// What refreshes the ghosts of the k-th step from now; adds to the key what its launches depend on. r: the
// request of a step in double or in mixed precision. The host knows which arrays hold the ghosts that queued
// steps read: after a stop nothing is read any more.
template <class Request>
auto StepQueue::ghost_queue(const Request& r, std::string& key) {
  DeviceHalo& halo = items_.halo_stream.halo;
  const Peers* const peers = halo.peers();
  const bool rotates = items_.model.rotates();
  const auto in_message = [&](int number, auto* of) { return halo.field(number, of, items_.owned); };
  const auto in_mailbox = [&](int number, auto* of) { return peers->field(number, of, items_.owned); };
  const auto sent = ghost_item<GhostField>(r, halo.ghosts(), rotates, in_message);
  decltype(ghost_item<PeerField>(r, nullptr, rotates, in_mailbox)) written{};
  if (peers != nullptr) written = ghost_item<PeerField>(r, halo.ghosts(), rotates, in_mailbox);
  key += key_of(sent) + key_of(written) + key_of(halo.entries()) + key_of(halo.size());
  return [this, &halo, peers, rotates, sent, written](Device on, Index k) {
    if (peers != nullptr) return peers->exchange(on, written, &control_.on_device()->stop);
    for_each(on, halo.entries(), sent);
    const int position = (control_.position_parity() + k) % 2,
              velocity = (control_.velocity_parity() + k) % 2;
    halo.exchange(on, messages_of(sent, rotates, position, velocity));
  };
}

void StepQueue::queue_double(Index steps, const MovingSurfaces* moving) {
  const VerletRequest r = request();
  std::string key = key_of(r) + key_of(items_.parts.interior());
  const auto queue_ghosts = ghost_queue(r, key);
  DeviceSurfaces& surfaces = items_.surfaces;
  const bool in_run = moving == nullptr && surfaces.any_placed();
  DrivenSurfaces* const driven = in_run ? workspace_.driven.get() : nullptr;
  const auto queue_rows = [&](Device on, const StepRows& rows) {
    VerletRequest of_rows = r;
    of_rows.rows = rows;
    items_.kernels->verlet_advance(on, of_rows);
    if (driven != nullptr) driven->join(on);
  };
  const DeviceContactKernels& kernels = *items_.kernels;
  const auto no_surfaces = [](Device) {};
  if (moving != nullptr)
    return queue_successively(
        key, steps,
        [&](Device on) {
          if (moving->loads_found != nullptr) moving->loads_found->hold(on.stream);
        },
        queue_ghosts, queue_rows, &moving->boundary_done);
  if (!in_run) return queue_successively(key, steps, no_surfaces, queue_ghosts, queue_rows);
  surfaces.reserve_in_run(items_.device(), steps);
  const OpenStepQuery query = surface_query(r);
  // In one launch the previous step's rows are the kernel before, and nothing else is to be waited for.
  const bool after_rows = r.rows.follows && !items_.parts.apart() && driven == nullptr;
  const Follows follows = after_rows ? Follows::kernel : Follows::anything;
  const auto queue_surfaces = [&](Device on) {
    surfaces.find_loads_in_run(on, kernels, query, h_, follows);
    if (driven != nullptr) driven->queue_sums(on);
  };
  queue_successively(
      key + surfaces.key_of_loads(kernels, query, h_) + (driven != nullptr ? driven->key() : ""), steps,
      queue_surfaces, queue_ghosts, queue_rows);
}

void StepQueue::queue_mixed(Index steps) {
  if (!mixed_) convert_to_mixed();
  MixedRequest r{};
  r.in = pruned_views(items_.now.position.data()), r.rows = items_.parts.whole();
  r.active = items_.layout.active;
  r.gravity = items_.model.gravity;
  r.state = mixed_views(), r.grid = mixed_->quanta, r.h = h_;
  r.orientation = items_.now.orientation.data();
  r.box = items_.subdomain.box(), r.drifting = items_.now.drifting.data(), r.control = control_.on_device();
  r.first_step = items_.history.first_step();
  r.rolling_loss = items_.now.rolling_loss.data(), r.twisting_loss = items_.now.twisting_loss.data();
  std::string key = key_of(r) + key_of(items_.parts.interior());
  const auto queue_ghosts = ghost_queue(r, key);
  const auto queue_rows = [&](Device on, const StepRows& rows) {
    MixedRequest of_rows = r;
    of_rows.rows = rows;
    items_.kernels->mixed_advance(on, of_rows);
  };
  queue_successively(
      key, steps, [](Device) {}, queue_ghosts, queue_rows);
}

}  // namespace scree
