// Explicit steps beside bodies: one at a time, the contacts of the bodies' shapes on a stream of their own.
#include "backend_parts.cuh"

namespace scree {
namespace {

// Brings a shape from pinned memory to its places among the items: sooner done than two copies.
struct PlaceItem {
  const Vec4* places;  // positions, then velocities
  Index shapes;
  Vec4 *position, *velocity;

  SCREE_HD void operator()(Index s) const { position[s] = places[s], velocity[s] = places[shapes + s]; }
};

}  // namespace

// Whether the list covers the shapes where they are placed now.
bool CudaBackend::shapes_covered() const {
  Real squared = 0;
  const DisplacementItem moved{h_list_shapes_.data(), side_.position().data()};
  for (Index s = 0; s < shape_items(); ++s) squared = std::max(squared, moved(s));
  return squared < list_skin_ * list_skin_ / 4;
}

// Queues, beside the step's own kernel, the shapes' contacts with the open step.
void CudaBackend::queue_shape_contacts() {
  Vec4* position = (parity_[0] == 0 ? now_ : other_).position.data() + layout_.first_shape;
  Vec4* velocity = (parity_[1] == 0 ? now_ : other_).velocity.data() + layout_.first_shape;
  for_each({shape_stream_}, shape_items(), PlaceItem{stage_shapes(), shape_items(), position, velocity});
  places_copied_.record(shape_stream_);
  step_queued_.hold(shape_stream_);
  kernels_->shapes({shape_stream_}, views(position - layout_.first_shape, velocity - layout_.first_shape),
                   {position, velocity}, shape_items(), h_shape_contacts_.data());
  copy_async(&h_results_.data()->control, result(&Results::control), 1, shape_stream_);
}

StepsTaken CudaBackend::run_with_shapes(Real h, Index most, bool keep_open, StageTimers& timers) {
  StepsTaken run{0, true};
  for (; run.closed < most && run.open; ++run.closed)
    run.open = step_with_shapes(h, keep_open || run.closed + 1 < most, timers);
  return run;
}

// One step with bodies; returns whether the next is open. The host waits for the contacts of the shapes only,
// and solves for the bodies' motion while the particles' kernel runs.
bool CudaBackend::step_with_shapes(Real h, bool keep_open, StageTimers& timers) {
  for (;;) {
    if (layout_changed_ || !shapes_covered()) build(model_.contact.skin, timers), resume_control();
    const auto scope = timers.time(Stage::contact_force);
    step_queued_.record(stream_);
    queue_shape_contacts();
    places_copied_.hold(stream_);
    if (keep_open) queue_steps(h, 1);
    if (idle_work_) idle_work_();
    fetch_shape_contacts(ContactSpan::instant, shape_stream_);
    const VerletControl& control = h_results_[0].control;
    const VerletControl::Closed& before = control.closed_steps[closed_ % VerletControl::kClosedSteps];
    if (before.expired) {  // what was queued has done nothing
      bound_ = list_skin_;
      renew_list(timers);
      continue;
    }
    side_.book_losses(h);
    if (!keep_open || before.leaves) {
      bound_ = control.bound;
      finish(h);
      return false;
    }
    parity_[0] ^= 1, parity_[1] ^= 1;
    level_ = Level::opened, ++closed_;
    return true;
  }
}

// Beside the step that was queued last: its kernel reads the same arrays.
void CudaBackend::shape_contacts() {
  const auto n = static_cast<std::size_t>(shape_items());
  if (n == 0) return;
  const bool in_now[2] = {level_ == Level::opened ? parity_[0] == 1 : parity_[0] == 0,
                          level_ == Level::state ? parity_[1] == 0 : parity_[1] == 1};
  const Vec4* position = (in_now[0] ? now_ : other_).position.data();
  const Vec4* velocity = (in_now[1] ? now_ : other_).velocity.data();
  shape_places_.resize(2 * n);
  copy_async(shape_places_.data(), stage_shapes(), 2 * n, shape_stream_);
  places_copied_.record(shape_stream_);
  kernels_->shapes({shape_stream_}, views(position, velocity),
                   {shape_places_.data(), shape_places_.data() + n}, shape_items(), h_shape_contacts_.data());
  fetch_shape_contacts(ContactSpan::instant, shape_stream_);
}

}  // namespace scree
