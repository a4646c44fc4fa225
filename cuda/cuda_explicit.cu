#include <algorithm>
#include <cmath>

#include "cuda_explicit.cuh"

namespace scree {
namespace {

// The most steps queued before the host reads the control block: enough to hide the latency of reading it.
constexpr Index kQueuedSteps = 128;
// A list is rebuilt at once if the exact displacement exceeds this fraction of what it covers.
constexpr Real kRebuildFraction = 0.9;

}  // namespace

CudaExplicitRun::CudaExplicitRun(CudaItems& items, CudaBodies& bodies, CudaList& list,
                                 RunWorkspace& workspace, Real h)
    : items_(items),
      bodies_(bodies),
      list_(list),
      workspace_(workspace),
      control_(items, list),
      queue_(items, list, control_, workspace, h),
      h_(h) {
  items.other.grow(items.now.position.size(), static_cast<std::size_t>(items.owned));
  bodies_.side().close_step();
  control_.start(queue_.request());
  items.open_run = this;
}

CudaExplicitRun::~CudaExplicitRun() {
  if (items_.open_run == this) items_.open_run = nullptr;
}

StepsTaken CudaExplicitRun::take_steps(Index most, bool keep_open, StageTimers& timers) {
  const bool follows = bodies_.have_surfaces() && !items_.surfaces.all_placed_static();
  return follows ? take_steps_with_bodies(most, keep_open, timers)
                 : take_steps_without_bodies(most, keep_open, timers);
}

StepsTaken CudaExplicitRun::take_steps_without_bodies(Index most, bool keep_open, StageTimers& timers) {
  const VerletControl* c = &control_.wait();
  const Index start = c->closed, last = start + most - (keep_open ? 0 : 1);
  const auto leaves = [&] { return c->closed_steps[c->closed % VerletControl::kClosedSteps].leaves; };
  for (;;) {
    if (renew_list(timers)) c = &control_.wait();
    if (c->closed == last || leaves()) break;
    const auto scope = timers.time(Stage::contact_force);
    control_.resume(last);
    queue_.queue(std::min(last - c->closed, steps_ahead(*c)));
    items_.idle();
    c = &control_.wait();
  }
  const Index closed = c->closed - start;
  if (keep_open && !leaves()) return {closed, true};
  const auto scope = timers.time(Stage::contact_force);
  if (bodies_.have_surfaces())
    queue_loads(), bodies_.accumulate_load_works(h_), bodies_.loads_found().hold(items_.stream);
  finish();
  return {closed + 1, false};
}

// After a stop: whether the list was the reason, and was rebuilt or turned out to cover the particles still.
bool CudaExplicitRun::renew_list(StageTimers& timers) {
  const bool covers_surfaces = list_.frame().covers_surfaces();
  if (list_.current() && covers_surfaces && list_.bound() < list_.skin() / 2) return false;
  if (!covers_surfaces || !(list_.displacement() < kRebuildFraction))
    list_.build(list_.choose_skin(), timers);
  control_.resume();
  return true;
}

// Steps to queue before the host reads the control block again: little more than the list is likely to cover.
// Those after a stop do nothing but still cost their launches and, on several ranks, their halo exchange.
Index CudaExplicitRun::steps_ahead(const VerletControl& control) const {
  if (items_.halo_stream.halo.waits()) return 1;
  const Real covered =
      std::min((control.half_skin - control.bound) / control.displacement, list_.frame().steps_left(h_));
  return covered < kQueuedSteps - 1 ? static_cast<Index>(covered) + 1 : kQueuedSteps;
}

void CudaExplicitRun::commit_open_step() {
  control_.wait();
  queue_.gather_open_step();
  control_.resume();
}

// Closes the open step without opening another, once the host knows which arrays hold it; afterwards the
// state is synchronous: positions and velocities belong to the same time.
void CudaExplicitRun::finish() {
  if (queue_.in_mixed()) commit_open_step();
  ParticleArrays& now = items_.now;
  SecondArrays& other = items_.other;
  const VerletRequest r = queue_.request();
  items_.update_halo(items_.device(), control_.open_position(), control_.open_velocity(),
                     r.spin[control_.velocity_parity()]);
  items_.kernels->verlet_finish(items_.device(), r, items_.results.at(&Results::largest));
  items_.history.closed_last(), bodies_.side().close_step();
  if (!std::isfinite(items_.ranks.max(items_.results.fetch(&Results::largest))))
    items_.report_not_finite(now.force.data());
  if (control_.position_parity() == 1) std::swap(now.position, other.position);
  if (control_.velocity_parity() == 0) {  // the velocity arrays have been swapped
    std::swap(now.velocity, other.velocity);
    std::swap(now.angular_velocity, other.angular_velocity);
    items_.history.commit_next();
  }
  control_.reset_parity();
  items_.open_run = nullptr;
  items_.law_velocity = other.velocity.data(), items_.law_spin = other.angular_velocity.data();
  closed_step_ = {now.position.data(), other.velocity.data(), other.angular_velocity.data()};
  bodies_.put();
  items_.refresh_ghosts();
}

}  // namespace scree
