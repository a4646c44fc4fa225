#include "dem/cpu/cpu_implicit.hpp"

#include <algorithm>
#include <cmath>

#include "base/for_each.hpp"
#include "base/reproducible_sum.hpp"

namespace scree {

void CpuImplicitArrays::resize(const ItemLayout& layout, std::size_t list_entries) {
  const auto owned = static_cast<std::size_t>(layout.owned);
  matrix_entries.resize(list_entries), direction.resize(static_cast<std::size_t>(layout.items));
  step_force.resize(owned), end_force.resize(owned), force_magnitude.resize(owned);
  stiffness_ratio.resize(owned), matrix_count.resize(owned);
  residual.resize(owned), right_hand_side.resize(owned), correction.resize(owned);
  matrix_diagonal.resize(owned), inverse_block.resize(owned);
}

CpuImplicitStep::CpuImplicitStep(CpuItems& items, CpuImplicitArrays& arrays, Real h)
    : items_(items), arrays_(arrays), h_(h) {
  arrays_.resize(items.layout, items.list.neighbors.size());
  arrays_.start_position = items.store.position;
  arrays_.start_velocity = items.store.velocity;
  arrays_.start_acceleration = items.store.acceleration;
  arrays_.start_force = items.store.force;
  items.side.store_start();
}

StepViews CpuImplicitStep::step_views() {
  return {items_.store.position.data(),
          items_.store.velocity.data(),
          items_.store.acceleration.data(),
          arrays_.start_position.data(),
          arrays_.start_velocity.data(),
          arrays_.start_acceleration.data(),
          arrays_.start_force.data(),
          items_.hht,
          h_,
          items_.subdomain.snap_constant()};
}

StepForces CpuImplicitStep::step_forces() {
  return {arrays_.step_force.data(), arrays_.end_force.data(), arrays_.force_magnitude.data()};
}

StepStart CpuImplicitStep::step_start() const {
  return {arrays_.start_position.data(), arrays_.start_velocity.data(), h_,
          items_.model.integrator.resolve_events};
}

NewtonWeights CpuImplicitStep::newton_weights() const {
  return {newmark_position_gain(items_.hht, h_), newmark_velocity_gain(items_.hht, h_)};
}

ContactMatrix CpuImplicitStep::matrix() {
  return {arrays_.matrix_count.data(), arrays_.matrix_entries.data(), arrays_.matrix_diagonal.data()};
}

// Moves the particles according to their accelerations.
void CpuImplicitStep::move_particles() {
  for_each(Serial{}, items_.layout.owned, NewmarkItem{step_views()});
  items_.refresh_ghosts();
}

void CpuImplicitStep::predict() { move_particles(); }

void CpuImplicitStep::undo() {
  ParticleStore& store = items_.store;
  const Index owned = items_.layout.owned;
  std::copy_n(arrays_.start_position.begin(), owned, store.position.begin());
  std::copy_n(arrays_.start_velocity.begin(), owned, store.velocity.begin());
  store.acceleration = arrays_.start_acceleration;
  store.force = arrays_.start_force;
  items_.refresh_ghosts();
}

Real CpuImplicitStep::step_displacement() {
  const DisplacementItem moved{arrays_.start_position.data(), items_.store.position.data()};
  const Real particles = std::sqrt(max_over(Serial{}, items_.layout.active, moved));
  return items_.ranks.max(std::max(particles, items_.side.step_displacement()));
}

// Maxima over the particles of all ranks. Throws like `report_not_finite` where a residual is not finite.
StepNorms CpuImplicitStep::largest_norms() {
  Real residual = 0, bound = 0, force = 0, stiffness_ratio = 0;
  bool finite = true;
  const StepNormsItem of{step_views(), arrays_.residual.data(), arrays_.force_magnitude.data(),
                         arrays_.stiffness_ratio.data()};
  for (Index i = 0; i < items_.layout.owned; ++i) {
    const StepNorms one = of(i);
    finite = finite && std::isfinite(one.residual);
    residual = std::max(residual, one.residual);
    bound = std::max(bound, one.correction_bound);
    force = std::max(force, one.force);
    stiffness_ratio = std::max(stiffness_ratio, one.stiffness_ratio);
  }
  Real maxima[5] = {residual, bound, force, stiffness_ratio, finite ? Real(0) : Real(1)};
  items_.ranks.max(maxima);
  if (maxima[4] != 0) items_.report_not_finite(arrays_.residual);
  StepNorms largest;
  largest.residual = maxima[0], largest.correction_bound = maxima[1];
  largest.force = maxima[2], largest.stiffness_ratio = maxima[3];
  return largest;
}

void CpuImplicitStep::find_steps() {
  if (items_.side.size() == 0) return;
  const SurfaceRows& rows = items_.list.surfaces;
  items_.surfaces.find_steps(items_.side.poses(), items_.store, rows, step_start(), items_.history.views());
  items_.side.take_steps(items_.surfaces.step_sums(rows), h_);
}

ParticleNorms CpuImplicitStep::contact_force() {
  const Index n = items_.layout.owned;
  find_steps();
  items_.kernels->system(items_.views(), items_.model.gravity, n, newton_weights(), step_start(),
                         step_forces(), matrix());
  for_each(Serial{}, n,
           ResidualItem{step_views(), arrays_.step_force.data(), matrix(), arrays_.residual.data(),
                        arrays_.inverse_block.data(), arrays_.stiffness_ratio.data()});
  const StepNorms largest = largest_norms();
  force_scale_ = largest.force, largest_stiffness_ratio_ = largest.stiffness_ratio;
  if (line_search_.is_open()) line_search_.update(along_correction(arrays_.residual));
  return {scaled_residual(largest), largest.correction_bound, line_search_.overshoots()};
}

GlobalId CpuImplicitStep::worst_particle() {
  const std::vector<Vec3>& residual = arrays_.residual;
  const Index n = items_.layout.owned;
  Real own = 0;
  for (Index i = 0; i < n; ++i) own = std::max(own, norm(residual[i]));
  const Real largest = items_.ranks.max(own);
  GlobalId worst = CpuItems::kNone;
  for (Index i = 0; i < n; ++i)
    if (norm(residual[i]) == largest) worst = std::min(worst, id_of(items_.store.row_key[i]));
  worst = items_.ranks.min(worst);
  return worst == CpuItems::kNone ? -1 : worst;
}

void CpuImplicitStep::reduce_wrench(ContactWrenches& step, std::vector<BodyWrench>& end) {
  items_.side.reduce(step, end);
}

Real CpuImplicitStep::along_correction(const std::vector<Vec3>& residual) const {
  Real sum[1];
  reproducible_sums(items_.layout.owned, SlopeItem{residual.data(), arrays_.correction.data()}, sum,
                    items_.ranks);
  return sum[0];
}

CorrectItem CpuImplicitStep::correct_item(Real share) {
  return {items_.store.acceleration.data(), arrays_.correction.data(), items_.store.position.data(), share,
          newmark_position_gain(items_.hht, h_)};
}

void CpuImplicitStep::shorten_correction() {
  for_each(Serial{}, items_.layout.owned, correct_item(line_search_.shorten()));
  move_particles();
}

// The bodies have already taken their correction: as a known part of the solution it moves to the right-hand
// side.
void CpuImplicitStep::subtract_surface_steps() {
  if (items_.side.size() == 0) return;
  for_each(Serial{}, items_.layout.owned,
           SurfaceShiftItem<PackedRows>{items_.views(),
                                        newton_weights(),
                                        {items_.side.step().data(), items_.side.step_rotation().data()},
                                        arrays_.residual.data()});
}

ParticleCorrection CpuImplicitStep::particle_correct() {
  const Index n = items_.layout.owned;
  const Ranks& ranks = items_.ranks;
  std::vector<Vec3>& residual = arrays_.residual;
  const SubtractMatrixItem<PackedRows> system_matrix{
      matrix(),
      {items_.list.offsets.data(), items_.list.neighbors.data()},
      items_.store.velocity.data(),
      hht_inertia_weight(items_.hht),
      arrays_.direction.data(),
      residual.data()};
  subtract_surface_steps();
  arrays_.right_hand_side = residual;
  const Real right_hand_side = ranks.max(max_over(Serial{}, n, NormItem{residual.data()}));
  // The surfaces' displacements may be not finite: without a correction of the particles only the bodies
  // would report it.
  if (!std::isfinite(right_hand_side)) items_.report_not_finite(residual);
  const Real tolerance =
      solver_tolerance(items_.model.integrator.residual_tolerance, force_scale_, right_hand_side);
  const BlockSolver::System system{system_matrix, arrays_.inverse_block,    residual, items_.halo,
                                   ranks,         largest_stiffness_ratio_, tolerance};
  ParticleCorrection out;
  line_search_ = {};
  if (right_hand_side > 0) {
    out.iterations = BlockSolver().solve(system, arrays_.direction, arrays_.correction);
    out.correction = ranks.max(max_over(Serial{}, n, correct_item(1)));
    line_search_.open(along_correction(arrays_.right_hand_side));
  }
  move_particles();
  return out;
}

Real CpuImplicitStep::error() {
  return items_.ranks.max(max_over(Serial{}, items_.layout.owned, StepErrorItem{step_views()}));
}

void CpuImplicitStep::accept() {
  ParticleStore& store = items_.store;
  find_steps();
  items_.kernels->step_losses(items_.views(), items_.layout.owned, step_start(), store.contact_loss.data(),
                              store.integrator_loss.data());
  items_.history.accepted();
  items_.side.book_step();
  items_.surfaces.accumulate_step_works(items_.side.poses(), store, items_.list.surfaces);
  for_each(Serial{}, items_.layout.owned,
           AcceptItem{step_views(), step_forces(), store.force.data(), store.integrator_loss.data()});
}

}  // namespace scree
