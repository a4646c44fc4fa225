#include "dem/cpu/cpu_explicit.hpp"

#include <cmath>
#include <utility>

#include "base/for_each.hpp"

namespace scree {

CpuExplicitRun::CpuExplicitRun(CpuItems& items, CpuList& list, Real h) : items_(items), list_(list), h_(h) {
  items.side.close_step();
  const VerletStartItem item{
      views_of(items.store.position, items.store.velocity, items.store.angular_velocity)};
  step_bound_ = std::sqrt(max_over(Serial{}, items.layout.owned, item));
  share_step();
}

VerletViews CpuExplicitRun::views_of(std::vector<Vec4>& position, std::vector<Vec4>& velocity,
                                     std::vector<Vec4>& spin) {
  ParticleStore& store = items_.store;
  return {position.data(),
          velocity.data(),
          store.acceleration.data(),
          store.contact_loss.data(),
          store.loss_power.data(),
          h_,
          items_.subdomain.snap_constant(),
          store.rotates ? spin.data() : nullptr,
          store.angular_acceleration.data(),
          store.orientation.data(),
          {SCREE_LOSS_KINDS(SCREE_LOSS_POINTER, store)}};
}

// Shares the properties of the open step that all ranks need.
void CpuExplicitRun::share_step() {
  const bool ends_step = (closed_ + 1) % items_.model.integrator.substeps == 0;
  Real shared[2] = {step_bound_, ends_step && items_.any_outside() ? Real(1) : Real(0)};
  items_.ranks.max(shared);
  step_bound_ = shared[0], outside_ = shared[1] != 0;
}

StepsTaken CpuExplicitRun::take_steps(Index most, bool keep_open, StageTimers& timers) {
  Index taken = 0;
  while (taken < most && open_) {
    if (!list_.covers(std::exchange(step_bound_, 0), h_)) list_.build(list_.choose_skin(), timers);
    const auto refresh = [&] {
      const auto scope = timers.time(Stage::update_halo);
      items_.refresh_ghosts();
    };
    refresh();
    {
      const auto scope = timers.time(Stage::contact_force);
      open_ = (keep_open || taken + 1 < most) && !outside_;
      open_ ? advance() : finish();
      ++taken, ++closed_;
      if (open_) share_step();
    }
    if (!open_) refresh();  // with the velocities at the end of the step
  }
  return {taken, open_};
}

StepsTaken CpuExplicitRun::take_driven_steps(std::span<const BodyMotion> motion, bool keep_open,
                                             std::vector<BodyWrench>& wrenches, StageTimers& timers) {
  const std::size_t parents = items_.side.surfaces().parents();
  std::vector<BodyWrench> of_step(parents);
  std::vector<std::int64_t> contacts;
  StepsTaken taken{0, true};
  wrenches.clear();
  for (; !motion.empty() && taken.open; ++taken.closed) {
    {
      const auto scope = timers.time(Stage::broadcast_motion);
      list_.set_body_motion(motion.first(parents));
    }
    motion = motion.subspan(parents);
    taken.open = take_steps(1, keep_open || !motion.empty(), timers).open;
    const auto scope = timers.time(Stage::reduce_wrench);
    reduce_wrench(of_step, contacts);
    wrenches.insert(wrenches.end(), of_step.begin(), of_step.end());
  }
  return taken;
}

// Uses the particles as of the last closed step, with the velocities that the law used. The history of the
// step is that of the bodies' last poses, at which the next step begins.
void CpuExplicitRun::shape_contacts() {
  items_.side.reopen_step();
  items_.find_loads(open_ ? items_.spare_position : items_.store.position, items_.spare_velocity,
                    items_.spare_spin, items_.history.views_before(), h_);
  items_.side.close_step();
}

// Contacts with surfaces at the end of the open step, before it is closed.
void CpuExplicitRun::close_loads() {
  items_.find_loads(h_);
  items_.side.accumulate_losses(h_);
  items_.surfaces.accumulate_load_works(items_.side.poses(), items_.store, items_.list.surfaces, h_);
}

void CpuExplicitRun::advance() {
  close_loads();
  ParticleStore& store = items_.store;
  // With friction a particle is not read again once it is advanced, except for contacts with bodies
  // (`shape_contacts`).
  const bool in_place = store.rotates && items_.side.poses().placed.empty();
  const VerletViews next = in_place
                               ? views_of(store.position, store.velocity, store.angular_velocity)
                               : views_of(items_.spare_position, items_.spare_velocity, items_.spare_spin);
  step_bound_ = std::sqrt(items_.kernels->verlet_advance(items_.step_views(), items_.listed_pairs(),
                                                         items_.model.gravity, items_.layout.owned, next));
  items_.history.accepted(), items_.side.close_step();
  if (in_place) return;
  std::swap(store.position, items_.spare_position);
  std::swap(store.velocity, items_.spare_velocity);
  std::swap(store.angular_velocity, items_.spare_spin);
}

void CpuExplicitRun::finish() {
  close_loads();
  std::vector<Vec3>& force = items_.store.force;
  const Real squared = items_.kernels->verlet_finish(
      items_.step_views(), items_.listed_pairs(), items_.model.gravity, items_.layout.owned,
      views_of(items_.spare_position, items_.spare_velocity, items_.spare_spin), force.data());
  items_.history.accepted(), items_.side.close_step();
  if (!std::isfinite(items_.ranks.max(squared))) items_.report_not_finite(force);
  std::swap(items_.store.velocity, items_.spare_velocity);
  std::swap(items_.store.angular_velocity, items_.spare_spin);
}

}  // namespace scree
