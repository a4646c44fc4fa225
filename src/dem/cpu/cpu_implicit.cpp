#include "dem/cpu/cpu_implicit.hpp"

#include <algorithm>
#include <cmath>

#include "dem/schedule/implicit_schedule.hpp"
#include "dem/schedule/six_freedoms.hpp"
#include "dem/schedule/three_freedoms.hpp"

namespace scree {

CpuImplicitOperations::CpuImplicitOperations(CpuItems& items, CpuImplicitArrays& arrays, Real h)
    : items_(items), arrays_(arrays), h_(h) {
  const ParticleStore& store = items.store;
  start().position = store.position, start().velocity = store.velocity;
  start().angular_velocity = store.angular_velocity;
  start().acceleration = store.acceleration, start().angular_acceleration = store.angular_acceleration;
  items.side.store_start();
  arrays_.step.resize(
      {static_cast<std::size_t>(owned()), static_cast<std::size_t>(items.layout.items),
       items.list.neighbors.size(), items.list.surfaces.surfaces.size(), items.kernels->traits().rolls},
      store.rotates);
}

Real CpuImplicitOperations::largest_displacement() {
  const DisplacementItem moved{start().position.data(), now().position.data()};
  return std::sqrt(max_over(Serial{}, items_.layout.active, moved));
}

void CpuImplicitOperations::iterate_changed() {
  items_.refresh_ghosts();
  if (now().rotates) items_.halo.update(std::span<Vec4>(arrays().six.mean_spin), owned());
}

void CpuImplicitOperations::find_surface_steps(const FrictionStart& start) {
  if (has_surfaces())
    items_.surfaces.find_steps(side().poses(), now(), items_.list.surfaces, start, items_.history.views());
}

void CpuImplicitOperations::take_surface_steps() {
  if (has_surfaces()) side().take_steps(items_.surfaces.step_sums(items_.list.surfaces), h_);
}

void CpuImplicitOperations::take_larger(const StepNorms& one) {
  // A NaN persists, as in max_over.
  const auto take = [](Real& largest, Real value) {
    if (value > largest || std::isnan(value)) largest = value;
  };
  take(largest_.residual, one.residual), take(largest_.correction_bound, one.correction_bound);
  take(largest_.force, one.force), take(largest_.stiffness_ratio, one.stiffness_ratio);
}

void CpuImplicitOperations::take_larger(const FrictionNorms& one) {
  take_larger(static_cast<const StepNorms&>(one));
  largest_.phase_squared = std::max(largest_.phase_squared, one.phase_squared);
}

FrictionNorms CpuImplicitOperations::norms() {
  const FrictionNorms& own = largest_;
  Real maxima[5] = {own.residual, own.correction_bound, own.force, own.stiffness_ratio, own.phase_squared};
  items_.ranks.max(maxima);
  return {{maxima[0], maxima[1], maxima[2], maxima[3]}, maxima[4]};
}

void CpuImplicitOperations::lag_limits(const FrictionStart& start) {
  constexpr Real kNoContact = -1;
  std::vector<Real>&neighbors = arrays().six.neighbor_limits, &surfaces = arrays().six.surface_limits;
  neighbors.assign(items_.list.neighbors.size(), kNoContact);
  surfaces.assign(items_.list.surfaces.surfaces.size(), kNoContact);
  items_.kernels->run(items_.views(), owned(), LimitRequest{start, {neighbors.data(), surfaces.data()}});
}

void CpuImplicitOperations::account_contacts(const FrictionStart& start) {
  const LossRequest request{start,
                            {now().contact_loss.data(),
                             now().integrator_loss.data(),
                             {SCREE_LOSS_KINDS(SCREE_LOSS_POINTER, now())}}};
  items_.kernels->run(items_.views(), owned(), request);
  items_.surfaces.accumulate_step_works(side().poses(), now(), items_.list.surfaces);
  items_.history.accepted();
}

void CpuImplicitOperations::undo() {
  const auto restore = [&](const std::vector<Vec4>& from, std::vector<Vec4>& to) {
    std::copy_n(from.begin(), owned(), to.begin());
  };
  restore(start().position, now().position), restore(start().velocity, now().velocity);
  now().acceleration = start().acceleration;
  if (now().rotates) {
    restore(start().angular_velocity, now().angular_velocity);
    now().angular_acceleration = start().angular_acceleration;
  }
  items_.refresh_ghosts();
}

std::unique_ptr<ImplicitStep> open_cpu_step(CpuItems& items, CpuImplicitArrays& arrays, Real h) {
  using On = CpuImplicitOperations;
  if (items.store.rotates && items.kernels->traits().rolls)
    return std::make_unique<ImplicitSchedule<On, RollingFreedoms>>(items, arrays, h);
  if (items.store.rotates) return std::make_unique<ImplicitSchedule<On, SixFreedoms>>(items, arrays, h);
  return std::make_unique<ImplicitSchedule<On, ThreeFreedoms>>(items, arrays, h);
}

}  // namespace scree
