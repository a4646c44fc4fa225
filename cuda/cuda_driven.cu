// Explicit steps beside walls with prescribed motion and conveyors: queued as far ahead as beside walls at
// rest. The host computes the poses of the walls in these steps beforehand, and reads the sums of the
// contacts afterwards.
#include <algorithm>
#include <utility>

#include "cuda_explicit.cuh"

namespace scree {
namespace {

// The motion of the walls' parents at the end of a step.
std::span<const BodyMotion> at_end(std::span<const BodyMotion> motion, std::size_t parents, Index step) {
  return motion.subspan(static_cast<std::size_t>(step) * parents, parents);
}

}  // namespace

StepsTaken CudaExplicitRun::take_driven_steps(std::span<const BodyMotion> motion, bool keep_open,
                                              std::vector<BodyWrench>& wrenches, StageTimers& timers) {
  HostSurfaces& side = bodies_.side();
  if (!workspace_.driven) workspace_.driven = std::make_unique<DrivenSurfaces>();
  const std::size_t parents = side.motion().size();
  const Index start = closed_,
              last = start + static_cast<Index>(motion.size() / parents) - (keep_open ? 0 : 1);
  std::vector<StepLoads> loads;
  const bool open = closed_ == last || take_ahead(motion, last, loads, timers);
  const Index closed = closed_ - start;
  {
    const auto scope = timers.time(Stage::reduce_wrench);
    wrenches = wrenches_of_steps(std::move(loads), closed, side.surfaces(), items_.ranks);
  }
  if (open && keep_open) return {closed, true};
  side.set_motion(at_end(motion, parents, closed)), side.update_poses();
  step_with_bodies(false, timers);
  const auto scope = timers.time(Stage::reduce_wrench);
  std::vector<BodyWrench> of_last(parents);
  std::vector<std::int64_t> unused;
  reduce_wrench(of_last, unused);
  wrenches.insert(wrenches.end(), of_last.begin(), of_last.end());
  return {closed + 1, false};
}

// Closes steps until `last` are closed since the start of the run, and opens the next one after each. Returns
// false if a particle is outside where the open step ends. motion: from the open step on.
bool CudaExplicitRun::take_ahead(std::span<const BodyMotion> motion, Index last,
                                 std::vector<StepLoads>& loads, StageTimers& timers) {
  HostSurfaces& side = bodies_.side();
  const std::vector<BodyMotion> before = side.motion();
  const std::size_t parents = before.size();
  const VerletControl* c = &control_.wait();
  for (const Index start = closed_; closed_ < last;) {
    const auto ahead = motion.subspan(static_cast<std::size_t>(closed_ - start) * parents);
    side.set_motion(ahead.first(parents)), side.update_poses();
    if (renew_list_beside_walls(timers)) c = &control_.wait();
    if (c->closed_steps[closed_ % VerletControl::kClosedSteps].leaves) return false;
    const auto scope = timers.time(Stage::contact_force);
    control_.resume(last);
    queue_driven(ahead, std::min({last - closed_, steps_ahead(*c), DrivenSurfaces::kRows}));
    items_.idle();
    c = &control_.wait();
    for (; closed_ < c->closed; ++closed_) workspace_.driven->take(closed_, closed_ - start, loads);
    side.return_to(closed_ > start ? at_end(motion, parents, closed_ - start - 1) : std::span(before));
  }
  return true;
}

// Like renew_list(), for the present poses of the walls.
bool CudaExplicitRun::renew_list_beside_walls(StageTimers& timers) {
  if (list_.current() && bodies_.side().list_displacement() < list_.skin() / 2) return renew_list(timers);
  list_.build(list_.choose_skin(), timers);
  control_.resume();
  return true;
}

// Queues up to `most` steps, fewer if the list does not cover the motion of the walls in them. The poses of
// some steps are computed while the device takes those before. motion: from the first of these steps on.
void CudaExplicitRun::queue_driven(std::span<const BodyMotion> motion, Index most) {
  static_assert(StepGraph::kSteps % 2 == 0);  // each part begins in the arrays that the host knows
  HostSurfaces& side = bodies_.side();
  DrivenSurfaces& driven = *workspace_.driven;
  driven.prepare(side, items_.surfaces, list_.builds(), items_.stream);
  bool covered = true;
  for (Index first = 0; first < most && covered;) {
    Index n = 0;
    for (; n < StepGraph::kSteps && first + n < most; ++n) {
      side.set_motion(at_end(motion, side.motion().size(), first + n)), side.update_poses();
      covered = first + n == 0 || side.list_displacement() < list_.skin() / 2;
      if (!covered) break;
      driven.put(closed_ + first + n, side);
      side.close_step();
    }
    if (n == 0) return;
    driven.upload(closed_ + first, n, items_.stream);
    queue_.queue(n);
    first += n;
  }
}

}  // namespace scree
