// Explicit steps beside bodies: one at a time, the contacts of the bodies' shapes on a stream of their own.
#include "cuda_explicit.cuh"

namespace scree {

StepsTaken CudaExplicitRun::take_steps_with_shapes(Index most, bool keep_open, StageTimers& timers) {
  StepsTaken taken{0, true};
  for (; taken.closed < most && taken.open; ++taken.closed)
    taken.open = step_with_shapes(keep_open || taken.closed + 1 < most, timers);
  return taken;
}

// One step with bodies; returns whether the next is open. The host waits for the contacts of the shapes only,
// and solves for the bodies' motion while the particles' kernel runs.
bool CudaExplicitRun::step_with_shapes(bool keep_open, StageTimers& timers) {
  for (;;) {
    if (!list_.current() || !shapes_.covered_by(list_.skin()))
      list_.build(items_.model.contact.skin, timers), control_.resume();
    const auto scope = timers.time(Stage::contact_force);
    queue_shape_contacts();
    if (keep_open) queue_.queue(1);
    items_.idle();
    shapes_.take_contacts();
    const VerletControl& control = control_.seen();
    const VerletControl::Closed& before = control.closed_steps[closed_ % VerletControl::kClosedSteps];
    if (before.expired) {  // what was queued has done nothing
      list_.set_bound(list_.skin());
      renew_list(timers);
      continue;
    }
    shapes_.side().book_losses(h_);
    if (!keep_open || before.leaves) {
      list_.set_bound(control.bound);
      finish();
      return false;
    }
    closed_step_ = {control_.open_position(), control_.open_velocity()};
    control_.turn();
    ++closed_;
    return true;
  }
}

// Queues, beside the step's own kernel, the shapes' contacts with the open step.
void CudaExplicitRun::queue_shape_contacts() {
  workspace_.step_queued.record(items_.stream);
  shapes_.queue_contacts(control_.open_position(), control_.open_velocity(), workspace_.step_queued);
  items_.results.copy(&Results::control, shapes_.stream());
  shapes_.hold_until_placed(items_.stream);
}

// Beside the step that was queued last: its kernel reads the same arrays.
void CudaExplicitRun::shape_contacts() {
  shapes_.find_contacts_beside(closed_step_.position, closed_step_.velocity);
}

}  // namespace scree
