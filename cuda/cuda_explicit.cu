// The explicit step of the GPU's backend. Steps are queued ahead of the host: each reads on the device
// whether the list still covers it, and does nothing if not.
#include <cmath>

#include "backend_parts.cuh"

namespace scree {
namespace {

// Steps queued before the host looks at how far they came: long enough to hide the look, short enough that
// little is queued in vain where the list expires.
constexpr Index kQueuedSteps = 128;
// A list whose exact displacement is past this share of what it covers is built anew at once.
constexpr Real kWornList = 0.9;

// Opens the first step of a run.
struct RunStartItem {
  VerletStartItem start;
  Index active;
  OpenBox box;
  const std::uint8_t* drifting;
  VerletControl* control;

  __device__ Real operator()(Index i) const {
    const Real squared = start(i);
    if (!box.inside(xyz(start.state.position[i])) && !drifting[i]) control->outside = 1;
    return i < active ? squared : 0;
  }
};

// What the ranks share of the first step.
__global__ void started_kernel(VerletControl* c, const Real* largest) {
  c->shared[0] = *largest, c->shared[1] = c->outside;
}

__global__ void open_kernel(VerletControl* c) {
  c->outside = c->shared[1] != 0;
  c->move(std::sqrt(c->shared[0]));
  c->judge(c->outside != 0);
}

// Closes a step once the ranks have shared what it found.
__global__ void close_kernel(VerletControl* c) {
  if (c->stop) return;
  c->outside = c->shared[1] != 0;
  c->close(c->shared[0]);
}

// Goes on after a stop: with another end, or another list.
__global__ void resume_kernel(VerletControl* c, Index last, Real bound, Real half_skin, bool new_list,
                              int position_parity, int velocity_parity) {
  c->last = last, c->half_skin = half_skin;
  if (new_list) c->moved = VerletControl::kNoRows, c->choose_rows();
  c->bound = bound;
  c->parity[0] = position_parity, c->parity[1] = velocity_parity;
  c->judge(c->outside != 0);
}

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

struct MixedGhostItem {
  const Ghost* ghosts;
  GhostField<MixedPlace> place[2];
  GhostField<MixedMotion> motion[2];
  QuantumGrid grid;
  const VerletControl* control;

  __device__ void operator()(Index entry) const {
    const bool first = control->parity[0] == 0;
    const Ghost ghost = ghosts[entry];
    const GhostField<MixedPlace>& places = first ? place[0] : place[1];
    const GhostField<MixedMotion>& motions = first ? motion[0] : motion[1];
    places.put(entry, shifted(grid, places.field[ghost.source], ghost.shift));
    motions.put(entry, motions.field[ghost.source]);
  }
};

}  // namespace

PrunedViews CudaBackend::pruned_views(const Vec4* position) {
  const DeviceViews v = views(position, nullptr);
  return {v.position,     v.velocity, v.material, list_.pruned_rows(v.first_shape),
          v.wall_offsets, v.walls,    v.planes,   v.first_shape};
}

// The launch of a step on the particles [first, end): all of them, or one of the step's two parts.
StepRows CudaBackend::step_rows(Index first, Index end) const {
  const bool in_parts = !ranks_.alone() && interior_ > 0;
  const unsigned blocks =
      in_parts ? step_blocks(0, interior_) + step_blocks(interior_, owned_) : step_blocks(0, owned_);
  return {first, end, ranks_.alone(), blocks};
}

VerletRequest CudaBackend::verlet_request(Real h) {
  VerletRequest r{};
  r.in = pruned_views(nullptr);
  r.rows = step_rows(0, owned_), r.active = layout_.active, r.gravity = model_.gravity;
  r.position[0] = now_.position.data(), r.position[1] = other_.position.data();
  r.velocity[0] = now_.velocity.data(), r.velocity[1] = other_.velocity.data();
  r.state = {nullptr,
             nullptr,
             now_.acceleration.data(),
             now_.contact_loss.data(),
             now_.loss_power.data(),
             h,
             subdomain_.snap_constant()};
  r.force = now_.force.data();
  r.box = subdomain_.box();
  r.drifting = now_.drifting.data();
  r.control = result(&Results::control);
  return r;
}

void CudaBackend::verlet_start(Real h) {
  other_.grow(now_.position.size(), static_cast<std::size_t>(owned_), 0, stream_);
  VerletControl& c = h_results_.data()->control;
  c = {};
  c.bound = bound_, c.half_skin = list_skin_ / 2, c.moved = VerletControl::kNoRows;
  c.last = kEndless, c.substeps = model_.integrator.substeps, c.alone = ranks_.alone();
  copy_async(result(&Results::control), &c, 1, stream_);
  const VerletRequest r = verlet_request(h);
  VerletViews state = r.state;
  state.position = now_.position.data(), state.velocity = now_.velocity.data();
  max_over(device(), owned_, RunStartItem{{state}, r.active, r.box, r.drifting, r.control},
           result(&Results::largest));
  started_kernel<<<1, 1, 0, stream_>>>(r.control, result(&Results::largest));
  halo_.max(device(), r.control->shared, 2);
  open_kernel<<<1, 1, 0, stream_>>>(r.control);
  require_cuda(cudaGetLastError(), "explicit step");
  wait_for(stream_);  // the host's copy of the control is free again
  in_run_ = true;
  parity_[0] = parity_[1] = closed_ = 0;
}

const VerletControl& CudaBackend::wait_for_control() {
  const VerletControl& c = fetch(&Results::control);
  halo_clock_.read(balance_.halo);
  parity_[0] = c.parity[0], parity_[1] = c.parity[1];
  bound_ = c.bound;
  return c;
}

// Steps to queue before the host looks again. On one rank those behind a stop cost nothing; on several each
// of them has its halo, so that there are not many more than the list is likely to cover.
Index CudaBackend::steps_ahead(const VerletControl& control) const {
  if (ranks_.alone()) return kQueuedSteps;
  if (halo_.waits()) return 1;
  const Real covered = (control.half_skin - control.bound) / control.displacement;
  return covered < kQueuedSteps - 1 ? static_cast<Index>(covered) + 1 : kQueuedSteps;
}

// Brings the open step into now_.
void CudaBackend::settle() {
  if (!in_run_) return;
  wait_for_control();
  if (in_mixed_) {
    convert_from_mixed();
  } else {
    if (parity_[0] == 1) std::swap(now_.position, other_.position);
    if (parity_[1] == 1) std::swap(now_.velocity, other_.velocity);
  }
  parity_[0] = parity_[1] = 0;
  resume_control();
}

MixedViews CudaBackend::mixed_views() {
  return {{mixed_place_[0].data(), mixed_place_[1].data()},
          {mixed_motion_[0].data(), mixed_motion_[1].data()},
          mixed_fraction_.data(),
          mixed_rest_.data()};
}

void CudaBackend::convert_to_mixed(Real h) {
  const auto items = static_cast<std::size_t>(layout_.items), owned = static_cast<std::size_t>(owned_);
  for (int k = 0; k < 2; ++k) mixed_place_[k].resize(items), mixed_motion_[k].resize(items);
  mixed_fraction_.resize(owned), mixed_rest_.resize(owned);
  quanta_ = make_quantum_grid(builder_.cutoff(list_skin_));
  // Ghosts come with the first step's halo.
  for_each(device(), owned_,
           ToMixedItem{now_.position.data(), now_.velocity.data(), now_.acceleration.data(), mixed_views(),
                       quanta_, subdomain_.box(), h, list_skin_ / 2});
  in_mixed_ = true, mixed_h_ = h, mixed_start_ = h_results_.data()->control.closed;
}

void CudaBackend::convert_from_mixed() {
  for_each(device(), owned_,
           FromMixedItem{mixed_views(), parity_[0], quanta_, now_.position.data(), now_.velocity.data(),
                         now_.acceleration.data(), now_.contact_loss.data(), now_.drifting.data(),
                         model_.gravity, mixed_h_, h_results_.data()->control.closed - mixed_start_});
  in_mixed_ = false;
}

void CudaBackend::resume_control(Index last) {
  resume_kernel<<<1, 1, 0, stream_>>>(result(&Results::control), last, bound_, list_skin_ / 2, new_list_,
                                      parity_[0], parity_[1]);
  new_list_ = false;
  require_cuda(cudaGetLastError(), "explicit step");
}

// After a stop: whether the list is the reason and was renewed, or turned out to cover the particles yet.
bool CudaBackend::renew_list(StageTimers& timers) {
  if (!layout_changed_ && bound_ < list_skin_ / 2) return false;
  if (!(displacement() < kWornList)) build(model_.contact.skin, timers);
  resume_control();
  return true;
}

// Queues steps one after the other. queue_ghosts(device, k): the halo of the k-th from now on;
// queue_rows(device, first, end): the kernel of a step on these particles; key: all that the launches depend
// on. After each step the ranks share what decides whether the next one may be taken.
template <class QueueGhosts, class QueueRows>
void CudaBackend::queue_in_turn(const std::string& key, Index steps, const QueueGhosts& queue_ghosts,
                                const QueueRows& queue_rows) {
  if (ranks_.alone()) {
    graph_.queue(stream_, key, steps, [&] {
      queue_ghosts(device(), 0);
      queue_rows(device(), 0, owned_);
    });
    return;
  }
  const Device halo{halo_stream_};
  VerletControl* control = result(&Results::control);
  halo_after_rows();
  for (Index k = 0; k < steps; ++k) {
    // The first step waits for the host; steps behind a stop do nothing that a halo could hide behind.
    HaloClock* clock = k == std::min<Index>(1, steps - 1) ? &halo_clock_ : nullptr;
    queue_beside_halo([&](Device on) { queue_ghosts(on, k); }, queue_rows, clock);
    halo_.max(halo, control->shared, 2);
    close_kernel<<<1, 1, 0, halo_stream_>>>(control);
    rows_after_halo();
  }
  require_cuda(cudaGetLastError(), "explicit step");
}

// The host knows where the steps that are queued find their ghosts: behind a stop nothing is read any more.
void CudaBackend::queue_steps(Real h, Index steps) {
  const auto bytes = [](const auto& value) {
    return std::string(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  if (!mixed_) {
    const VerletRequest r = verlet_request(h);
    const auto field = [&](int buffer, Vec4* const(&of)[2], int parity) {
      return halo_.field(buffer, of[parity], owned_);
    };
    const RunGhostItem ghosts{halo_.ghosts(),
                              {field(0, r.position, 0), field(0, r.position, 1)},
                              {field(1, r.velocity, 0), field(1, r.velocity, 1)},
                              r.control};
    const auto queue_ghosts = [&](Device on, Index k) {
      for_each(on, halo_.entries(), ghosts);
      halo_.exchange(on, ghosts.position[(parity_[0] + k) % 2], ghosts.velocity[(parity_[1] + k) % 2]);
    };
    const auto queue_rows = [&](Device on, Index first, Index end) {
      VerletRequest of_rows = r;
      of_rows.rows = step_rows(first, end);
      kernels_->verlet_advance(on, of_rows);
    };
    queue_in_turn(bytes(r) + bytes(ghosts) + bytes(halo_.entries()), steps, queue_ghosts, queue_rows);
    return;
  }
  if (!in_mixed_) convert_to_mixed(h);
  MixedRequest r{};
  r.in = pruned_views(now_.position.data()), r.rows = step_rows(0, owned_), r.active = layout_.active;
  r.gravity = model_.gravity;
  r.state = mixed_views(), r.grid = quanta_, r.h = h;
  r.box = subdomain_.box(), r.drifting = now_.drifting.data(), r.control = result(&Results::control);
  const MixedGhostItem ghosts{
      halo_.ghosts(),
      {halo_.field(0, r.state.place[0], owned_), halo_.field(0, r.state.place[1], owned_)},
      {halo_.field(1, r.state.motion[0], owned_), halo_.field(1, r.state.motion[1], owned_)},
      quanta_,
      r.control};
  const auto queue_ghosts = [&](Device on, Index k) {
    for_each(on, halo_.entries(), ghosts);
    const Index parity = (parity_[0] + k) % 2;
    halo_.exchange(on, ghosts.place[parity], ghosts.motion[parity]);
  };
  const auto queue_rows = [&](Device on, Index first, Index end) {
    MixedRequest of_rows = r;
    of_rows.rows = step_rows(first, end);
    kernels_->mixed_advance(on, of_rows);
  };
  queue_in_turn(bytes(r) + bytes(ghosts) + bytes(halo_.entries()), steps, queue_ghosts, queue_rows);
}

// Closes the open step without opening another; now_ holds it afterwards. The host knows the parities.
void CudaBackend::finish(Real h) {
  if (in_mixed_) settle();
  const VerletRequest r = verlet_request(h);
  refresh_ghosts(r.position[parity_[0]], r.velocity[parity_[1]]);
  kernels_->verlet_finish(device(), r, result(&Results::largest));
  if (!std::isfinite(ranks_.max(fetch(&Results::largest)))) report_not_finite(now_.force.data());
  if (parity_[0] == 1) std::swap(now_.position, other_.position);
  if (parity_[1] == 0) std::swap(now_.velocity, other_.velocity);  // velocities changed arrays
  parity_[0] = parity_[1] = 0;
  in_run_ = false, level_ = Level::finished;
  put_shapes(now_);
  refresh_ghosts(now_.position.data(), now_.velocity.data());
}

StepsTaken CudaBackend::verlet_run(Real h, Index most, bool keep_open, StageTimers& timers) {
  return shape_items() > 0 ? run_with_shapes(h, most, keep_open, timers)
                           : run_alone(h, most, keep_open, timers);
}

StepsTaken CudaBackend::run_alone(Real h, Index most, bool keep_open, StageTimers& timers) {
  const VerletControl* c = &wait_for_control();
  const Index start = c->closed, last = start + most - (keep_open ? 0 : 1);
  const auto leaves = [&] { return c->closed_steps[c->closed % VerletControl::kClosedSteps].leaves; };
  for (;;) {
    if (renew_list(timers)) c = &wait_for_control();
    if (c->closed == last || leaves()) break;
    const auto scope = timers.time(Stage::contact_force);
    resume_control(last);
    queue_steps(h, std::min(last - c->closed, steps_ahead(*c)));
    level_ = Level::opened;
    if (idle_work_) idle_work_();
    c = &wait_for_control();
  }
  const Index closed = c->closed - start;
  if (keep_open && !leaves()) return {closed, true};
  const auto scope = timers.time(Stage::contact_force);
  finish(h);
  return {closed + 1, false};
}

}  // namespace scree
