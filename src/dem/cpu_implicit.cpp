// The implicit step of the serial backend.
#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/for_each.hpp"
#include "base/reproducible_sum.hpp"
#include "dem/cpu_backend.hpp"

namespace scree {
StepViews CpuBackend::step_views() {
  return {store_.position.data(),
          store_.velocity.data(),
          store_.acceleration.data(),
          start_position_.data(),
          start_velocity_.data(),
          start_acceleration_.data(),
          start_force_.data(),
          hht_,
          h_,
          subdomain_.snap_constant()};
}

void CpuBackend::initial_forces() {
  refresh_ghosts();
  kernels_->forces(views(), model_.gravity, layout_.owned, store_.force.data(), store_.loss_power.data());
  for_each(Serial{}, layout_.owned,
           StartAccelerationItem{store_.force.data(), store_.velocity.data(), store_.acceleration.data()});
  find_shape_contacts(views());
  if (is_verlet(model_))
    side_.book_losses(0);
  else
    std::fill(store_.loss_power.begin(), store_.loss_power.end(), 0);
}

void CpuBackend::begin_step(Real h) {
  h_ = h;
  line_search_ = {};
  in_implicit_step_ = true;
  start_position_ = store_.position;
  start_velocity_ = store_.velocity;
  start_acceleration_ = store_.acceleration;
  start_force_ = store_.force;
  for_each(Serial{}, layout_.owned, NewmarkItem{step_views()});
  refresh_ghosts();
}

void CpuBackend::rollback() {
  if (!in_implicit_step_) return;
  std::copy(start_position_.begin(), start_position_.begin() + layout_.owned, store_.position.begin());
  std::copy(start_velocity_.begin(), start_velocity_.begin() + layout_.owned, store_.velocity.begin());
  store_.acceleration = start_acceleration_;
  store_.force = start_force_;
  refresh_ghosts();
  in_implicit_step_ = false;
}

Real CpuBackend::step_displacement() {
  const DisplacementItem moved{start_position_.data(), store_.position.data()};
  const DisplacementItem shapes{moved.from + layout_.first_shape, moved.to + layout_.first_shape};
  const Real particles = max_over(Serial{}, layout_.active, moved);
  return std::sqrt(
      ranks_.max(std::max(particles, max_over(Serial{}, layout_.items - layout_.first_shape, shapes))));
}

StepForces CpuBackend::step_forces() {
  return {step_force_.data(), end_force_.data(), force_magnitude_.data()};
}

StepStart CpuBackend::step_start() const {
  return {start_position_.data(), start_velocity_.data(), h_, model_.integrator.resolve_events};
}

ParticleNorms CpuBackend::contact_force() {
  const Index n = layout_.owned;
  const NewtonWeights weights{newmark_position_gain(hht_, h_), newmark_velocity_gain(hht_, h_)};
  const ContactMatrix matrix{matrix_count_.data(), matrix_entries_.data(), matrix_diagonal_.data()};
  kernels_->system(views(), model_.gravity, n, weights, step_start(), step_forces(), matrix);
  kernels_->shapes(views(), layout_.items - layout_.first_shape, step_start(), side_.contacts().data());
  for_each(Serial{}, n,
           ResidualItem{step_views(), step_force_.data(), matrix, residual_.data(), inverse_block_.data(),
                        stiffening_.data()});

  Real residual = 0, bound = 0, force = 0, stiffening = 0;
  bool finite = true;
  const StepNormsItem of{step_views(), residual_.data(), force_magnitude_.data(), stiffening_.data()};
  for (Index i = 0; i < n; ++i) {
    const StepNorms one = of(i);
    finite = finite && std::isfinite(one.residual);
    residual = std::max(residual, one.residual);
    bound = std::max(bound, one.correction_bound);
    force = std::max(force, one.force);
    stiffening = std::max(stiffening, one.stiffening);
  }
  Real maxima[5] = {residual, bound, force, stiffening, finite ? Real(0) : Real(1)};
  ranks_.max(maxima);
  if (maxima[4] != 0) report_not_finite(residual_);
  StepNorms largest;
  largest.residual = maxima[0], largest.correction_bound = maxima[1];
  largest.force = force_scale_ = maxima[2], largest.stiffening = largest_stiffening_ = maxima[3];
  if (line_search_.is_open()) line_search_.look(along_correction(residual_));
  return {scaled_residual(largest), largest.correction_bound, line_search_.overshoots()};
}

GlobalId CpuBackend::worst_particle() const {
  Real own = 0;
  for (Index i = 0; i < layout_.owned; ++i) own = std::max(own, norm(residual_[i]));
  const Real largest = ranks_.max(own);
  GlobalId worst = kNone;
  for (Index i = 0; i < layout_.owned; ++i)
    if (norm(residual_[i]) == largest) worst = std::min(worst, id_of(store_.row_key[i]));
  worst = ranks_.min(worst);
  return worst == kNone ? -1 : worst;
}

Real CpuBackend::along_correction(const std::vector<Vec3>& residual) const {
  Real sum[1];
  reproducible_sums(layout_.owned, SlopeItem{residual.data(), correction_.data()}, sum, ranks_);
  return sum[0];
}

CorrectItem CpuBackend::correct_item(Real share) {
  return {store_.acceleration.data(), correction_.data(), store_.position.data(), share,
          newmark_position_gain(hht_, h_)};
}

void CpuBackend::shorten_correction() {
  for_each(Serial{}, layout_.owned, correct_item(line_search_.shorten()));
  for_each(Serial{}, layout_.owned, NewmarkItem{step_views()});
  refresh_ghosts();
}

void CpuBackend::reduce_wrench(ContactWrenches& step, std::vector<BodyWrench>& end) {
  side_.reduce(layout_, ranks_, step, end);
}

void CpuBackend::reduce_wrench(std::vector<BodyWrench>& end) { side_.reduce(layout_, ranks_, end); }

ParticleCorrection CpuBackend::particle_correct() {
  const Index n = layout_.owned;
  const SubtractMatrixItem<PackedRows> matrix{
      {matrix_count_.data(), matrix_entries_.data(), matrix_diagonal_.data()},
      {list_.offsets.data(), list_.neighbors.data()},
      store_.velocity.data(),
      hht_inertia_weight(hht_),
      direction_.data(),
      residual_.data()};
  // The bodies have already taken their correction: as a known part of the solution it moves to the right.
  if (layout_.items > layout_.first_shape) {
    for_each(Serial{}, layout_.items,
             ShapeDirectionItem{side_.step().data(), newmark_position_gain(hht_, h_), layout_.first_shape,
                                direction_.data()});
    for_each(Serial{}, n, matrix);
    std::fill(direction_.begin() + layout_.first_shape, direction_.end(), Vec4{});
  }
  right_hand_side_ = residual_;
  const Real right_hand_side = ranks_.max(max_over(Serial{}, n, NormItem{residual_.data()}));
  // The shapes' displacements may be what is not finite: without a correction the bodies alone would notice.
  if (!std::isfinite(right_hand_side)) report_not_finite(residual_);
  const Real tolerance =
      solver_tolerance(model_.integrator.residual_tolerance, force_scale_, right_hand_side);
  const BlockSolver::System system{matrix, inverse_block_,      residual_, halo_,
                                   ranks_, largest_stiffening_, tolerance};
  ParticleCorrection out;
  line_search_ = {};
  if (right_hand_side > 0) {
    out.iterations = solver_.solve(system, direction_, correction_);
    out.correction = ranks_.max(max_over(Serial{}, n, correct_item(1)));
    line_search_.open(along_correction(right_hand_side_));
  }
  for_each(Serial{}, n, NewmarkItem{step_views()});
  refresh_ghosts();
  return out;
}

Real CpuBackend::error() {
  return ranks_.max(max_over(Serial{}, layout_.owned, StepErrorItem{step_views()}));
}

void CpuBackend::accept() {
  kernels_->books(views(), layout_.owned, step_start(), store_.contact_loss.data(),
                  store_.integrator_loss.data());
  std::vector<ContactBooks> shapes(static_cast<std::size_t>(layout_.items - layout_.first_shape));
  kernels_->shape_books(views(), layout_.items - layout_.first_shape, step_start(), shapes.data());
  side_.book_step(shapes);
  for_each(Serial{}, layout_.owned,
           AcceptItem{step_views(), step_forces(), store_.force.data(), store_.integrator_loss.data()});
  in_implicit_step_ = false;
}

}  // namespace scree
