// The explicit step of the serial backend.
#include <cmath>
#include <utility>

#include "base/for_each.hpp"
#include "dem/cpu_backend.hpp"

namespace scree {

VerletViews CpuBackend::verlet_views(Real h, std::vector<Vec4>& position, std::vector<Vec4>& velocity) {
  return {position.data(),
          velocity.data(),
          store_.acceleration.data(),
          store_.contact_loss.data(),
          store_.loss_power.data(),
          h,
          subdomain_.snap_constant()};
}

void CpuBackend::verlet_start(Real h) {
  const VerletStartItem item{verlet_views(h, store_.position, store_.velocity)};
  step_bound_ = std::sqrt(max_over(Serial{}, layout_.owned, item));
  closed_ = 0;
  share_step();
}

// What all ranks must know of the open step.
void CpuBackend::share_step() {
  Real shared[2] = {step_bound_, ends_step() && any_outside() ? Real(1) : Real(0)};
  ranks_.max(shared);
  step_bound_ = shared[0], outside_ = shared[1] != 0;
}

VerletRun CpuBackend::verlet_run(Real h, Index most, bool keep_open, StageTimers& timers) {
  VerletRun run{0, true};
  while (run.closed < most && run.open) {
    if (list_displacement() > 1) build_list(model_.contact.skin, timers);
    const auto refresh = [&] {
      const auto scope = timers.time(Stage::update_halo);
      refresh_ghosts();
    };
    refresh();
    {
      const auto scope = timers.time(Stage::contact_force);
      run.open = (keep_open || run.closed + 1 < most) && !outside_;
      run.open ? verlet_advance(h) : verlet_finish(h);
      ++run.closed, ++closed_;
      if (run.open) share_step();
    }
    if (!run.open) refresh();  // with the velocities at the end of the step
  }
  return run;
}

// Particles as the last step left them before it opened the next: with the velocities that the law saw.
void CpuBackend::shape_contacts() {
  find_shape_contacts(views(opened_ ? spare_position_ : store_.position, spare_velocity_));
}

void CpuBackend::verlet_advance(Real h) {
  find_shape_contacts(views());
  side_.book_losses(h);
  step_bound_ = std::sqrt(kernels_->verlet_advance(views(), model_.gravity, layout_.owned,
                                                   verlet_views(h, spare_position_, spare_velocity_)));
  std::swap(store_.position, spare_position_);
  std::swap(store_.velocity, spare_velocity_);
  opened_ = true;
}

void CpuBackend::verlet_finish(Real h) {
  find_shape_contacts(views());
  side_.book_losses(h);
  const Real squared =
      kernels_->verlet_finish(views(), model_.gravity, layout_.owned,
                              verlet_views(h, spare_position_, spare_velocity_), store_.force.data());
  if (!std::isfinite(ranks_.max(squared))) report_not_finite(store_.force);
  std::swap(store_.velocity, spare_velocity_);
  opened_ = false;
}

}  // namespace scree
