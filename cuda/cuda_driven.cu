// Explicit steps beside walls with prescribed motion and conveyors: queued as far ahead as beside walls at
// rest. The host computes the poses of the walls in these steps beforehand, and reads the sums of the
// contacts afterwards.
#include <algorithm>

#include "cuda_explicit.cuh"

namespace scree {

// The motion of the walls' parents at the end of a step.
static std::span<const BodyMotion> at_end(std::span<const BodyMotion> motion, std::size_t parents,
                                          Index step) {
  return motion.subspan(static_cast<std::size_t>(step) * parents, parents);
}

StepsTaken CudaExplicitRun::take_driven_steps(std::span<const BodyMotion> motion, bool keep_open,
                                              std::vector<BodyWrench>& wrenches, StageTimers& timers) {
  HostSurfaces& side = bodies_.side();
  if (!workspace_.driven) workspace_.driven = std::make_unique<DrivenSurfaces>();
  const std::vector<BodyMotion> before = side.motion();
  const std::size_t parents = before.size();
  const auto steps = static_cast<Index>(motion.size() / parents);
  const VerletControl* c = &control_.wait();
  const Index start = c->closed, last = start + steps - (keep_open ? 0 : 1);
  std::vector<StepLoads> loads;
  bool open = true;
  while (open && c->closed - start < steps) {
    const Index first = c->closed - start;
    side.set_motion(at_end(motion, parents, first)), side.update_poses();
    if (renew_list_beside_walls(timers)) c = &control_.wait();
    open = c->closed < last + (keep_open ? 1 : 0) &&
           !c->closed_steps[c->closed % VerletControl::kClosedSteps].leaves;
    if (!open) break;
    const auto scope = timers.time(Stage::contact_force);
    control_.resume(last);
    queue_driven(motion.subspan(static_cast<std::size_t>(first) * parents),
                 std::min(last - c->closed, steps_ahead(*c)));
    items_.idle();
    c = &control_.wait();
    const Index closed = c->closed - start;
    for (Index step = first; step < closed; ++step) workspace_.driven->take(start + step, step, loads);
    side.return_to(closed > 0 ? at_end(motion, parents, closed - 1) : std::span(before));
  }
  const Index closed = c->closed - start;
  {
    const auto scope = timers.time(Stage::reduce_wrench);
    wrenches = wrenches_of_steps(std::move(loads), closed, side.surfaces(), items_.ranks);
  }
  if (open) return {closed, true};
  close_driven(c->closed, wrenches, timers);
  return {closed + 1, false};
}

// Like renew_list(), for the present poses of the walls.
bool CudaExplicitRun::renew_list_beside_walls(StageTimers& timers) {
  if (list_.current() && bodies_.side().list_displacement() < list_.skin() / 2) return renew_list(timers);
  list_.build(items_.model.contact.skin, timers);
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
  const Index closed = control_.seen().closed;
  bool covered = true;
  for (Index first = 0; first < most && covered;) {
    Index n = 0;
    for (; n < StepGraph::kSteps && first + n < most; ++n) {
      side.set_motion(at_end(motion, side.motion().size(), first + n)), side.update_poses();
      covered = first + n == 0 || side.list_displacement() < list_.skin() / 2;
      if (!covered) break;
      driven.put(closed + first + n, side);
      side.close_step();
    }
    if (n == 0) return;
    driven.upload(closed + first, n, items_.stream);
    queue_.queue(n);
    first += n;
  }
}

// Closes the open step, whose poses the walls have, without opening another. step: number of closed steps.
void CudaExplicitRun::close_driven(Index step, std::vector<BodyWrench>& wrenches, StageTimers& timers) {
  closed_ = step;
  step_with_bodies(false, timers);
  const auto scope = timers.time(Stage::reduce_wrench);
  std::vector<BodyWrench> of_step(bodies_.side().surfaces().parents());
  std::vector<std::int64_t> unused;
  reduce_wrench(of_step, unused);
  wrenches.insert(wrenches.end(), of_step.begin(), of_step.end());
}

}  // namespace scree
