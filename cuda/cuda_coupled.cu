// Explicit steps coupled to bodies: one at a time, with the contacts on their surfaces before it, and those
// at their corrected poses beside it.
#include "cuda_explicit.cuh"

namespace scree {

StepsTaken CudaExplicitRun::take_steps_with_bodies(Index most, bool keep_open, StageTimers& timers) {
  StepsTaken taken{0, true};
  for (; taken.closed < most && taken.open; ++taken.closed)
    taken.open = step_with_bodies(keep_open || taken.closed + 1 < most, timers);
  return taken;
}

// One step with bodies; returns whether the next is open. The host waits only for the contacts with bodies,
// and solves for their motion while the kernel of the particles runs.
bool CudaExplicitRun::step_with_bodies(bool keep_open, StageTimers& timers) {
  for (;;) {
    if (!list_.current() || !list_.frame().covers_surfaces() ||
        !(bodies_.side().list_displacement() < list_.skin() / 2))
      list_.build(list_.choose_skin(), timers), control_.resume(), boundary_apart_ = false;
    const auto scope = timers.time(Stage::contact_force);
    const bool in_order = contacts_in_order(), reported = queue_loads();
    if (!reported) {
      workspace_.step_queued.hold(bodies_.stream());
      items_.results.copy(&Results::control, bodies_.stream());
    }
    if (keep_open) {
      const MovingSurfaces moving{in_order ? nullptr : &bodies_.loads_found(), workspace_.boundary_done};
      queue_.queue(1, &moving), boundary_apart_ = items_.parts.apart();
    }
    do_work();
    items_.idle();
    bodies_.take_loads(h_);
    if (!reported) wait_for(bodies_.stream());
    const VerletControl& control = control_.seen();
    const VerletControl::Closed& before = control.closed_steps[closed_ % VerletControl::kClosedSteps];
    if (before.expired) {  // the queued step has done nothing
      list_.set_bound(list_.skin());
      renew_list(timers), boundary_apart_ = false;
      continue;
    }
    bodies_.side().accumulate_losses(h_), bodies_.accumulate_load_works(h_);
    if (!keep_open || before.leaves) {
      bodies_.loads_found().hold(items_.stream);
      list_.set_bound(control.bound);
      finish();
      return false;
    }
    closed_step_ = {control_.open_position(), control_.open_velocity(), control_.open_spin()};
    control_.turn();
    items_.history.closed(++closed_), list_.follow(h_);
    bodies_.side().close_step();
    return true;
  }
}

// Whether the open step's contacts with surfaces are evaluated on the particles' stream, without events
// between streams. Otherwise they do not wait for interior rows of the previous step, or for the halo.
bool CudaExplicitRun::contacts_in_order() const { return items_.ranks.alone() && !boundary_apart_; }

// Queues the open step's contacts with surfaces, which its kernel reads; their sums go to the host
// concurrently. The particles near surfaces are in the boundary rows of the previous step, so that its
// interior rows may still be under way. Returns whether the control block comes with the sums: it does where
// the contacts wait for all of the previous step, which closed it.
bool CudaExplicitRun::queue_loads() {
  const SurfaceQuery query{control_.open_position(), control_.open_velocity(), control_.open_spin(),
                           items_.history.views(control_.velocity_parity() == 1), h_};
  const ControlReport report{control_.on_device(), &items_.results.host().control};
  const bool reported = items_.surfaces.any_near() && !boundary_apart_;
  if (reported && contacts_in_order()) {
    bodies_.queue_loads(query, report);
    return true;
  }
  workspace_.step_queued.record(items_.stream);
  if (boundary_apart_)
    bodies_.queue_loads_after(workspace_.boundary_done, query, {});
  else
    bodies_.queue_loads_after(workspace_.step_queued, query, report);
  return reported;
}

// Runs concurrently with the step queued last: its kernel reads the same state arrays but has contacts of its
// own. The history that results belongs to the last pose of the bodies, where the next step starts; only this
// stream reads and writes it.
void CudaExplicitRun::shape_contacts() {
  bodies_.side().reopen_step();
  bodies_.find_loads_concurrently({closed_step_.position, closed_step_.velocity, closed_step_.spin,
                                   items_.history.views_before(control_.velocity_parity() == 1), h_},
                                  [this] { do_work(); });
  bodies_.side().close_step();
}

}  // namespace scree
