#include "dem/cpu/cpu_friction.hpp"

#include <algorithm>
#include <cmath>

#include "base/for_each.hpp"

namespace scree {

void CpuFrictionArrays::resize(const CpuItems& items) {
  const auto owned = static_cast<std::size_t>(items.layout.owned),
             all = static_cast<std::size_t>(items.layout.items);
  mean_spin.resize(all), direction.resize(all);
  const bool rolls = items.kernels->rolls();
  entries.resize(items.list.neighbors.size(), rolls);
  surface_entries.resize(items.list.surfaces.surfaces.size());
  if (rolls) surface_rolling.resize(surface_entries.size());
  start_torque.resize(owned), step_torque.resize(owned), end_torque.resize(owned);
  phase_squared.resize(owned), surface_count.resize(owned);
  mass.resize(owned), inverse_block.resize(BlockSlices::size(owned)), residual.resize(owned),
      correction.resize(owned);
}

CpuFrictionStep::CpuFrictionStep(CpuItems& items, CpuImplicitArrays& motion, CpuFrictionArrays& arrays,
                                 Real h)
    : CpuImplicitStep(items, motion, h), friction_(arrays) {
  friction_.resize(items);
  friction_.start_spin = items.store.angular_velocity;
  friction_.start_acceleration = items.store.angular_acceleration;
}

RotationViews CpuFrictionStep::rotation_views() {
  return {items_.store.angular_velocity.data(), friction_.mean_spin.data(),
          items_.store.angular_acceleration.data(), friction_.start_spin.data(),
          friction_.start_acceleration.data()};
}

StepTorques CpuFrictionStep::step_torques() {
  return {friction_.start_torque.data(), friction_.step_torque.data(), friction_.end_torque.data()};
}

FrictionStart CpuFrictionStep::friction_start() {
  LaggedLimits lagged;
  if (lagged_) lagged = {friction_.neighbor_limits.data(), friction_.surface_limits.data()};
  return {step_start(), friction_.start_spin.data(), friction_.mean_spin.data(), lagged,
          items_.surfaces.friction_steps()};
}

void CpuFrictionStep::find_friction_steps() {
  if (items_.side.size() == 0) return;
  const SurfaceRows& rows = items_.list.surfaces;
  items_.surfaces.find_friction_steps(items_.side.poses(), items_.store, rows, friction_start(),
                                      items_.history.views());
  items_.side.take_steps(items_.surfaces.friction_step_sums(rows), h_);
}

FrictionMatrix CpuFrictionStep::matrix() {
  return {arrays_.matrix_count.data(), friction_.surface_count.data(), friction_.entries.views(),
          friction_.surface_entries.data(), friction_.surface_rolling.data()};
}

// Moves and rotates the particles according to their accelerations.
void CpuFrictionStep::rotate_particles() {
  for_each(Serial{}, items_.layout.owned, SpinUpdateItem{step_views(), rotation_views()});
  move_particles();
  items_.halo.update(std::span<Vec4>(friction_.mean_spin), items_.layout.owned);
}

void CpuFrictionStep::predict() { rotate_particles(); }

void CpuFrictionStep::undo() {
  std::copy_n(friction_.start_spin.begin(), items_.layout.owned, items_.store.angular_velocity.begin());
  items_.store.angular_acceleration = friction_.start_acceleration;
  CpuImplicitStep::undo();
}

// Maxima over the particles of all ranks.
FrictionNorms CpuFrictionStep::largest_norms() {
  FrictionNorms largest{};
  bool finite = true;
  const FrictionNormsItem of{step_views(),
                             friction_.residual.data(),
                             friction_.mass.data(),
                             arrays_.force_magnitude.data(),
                             arrays_.stiffness_ratio.data(),
                             friction_.phase_squared.data(),
                             items_.kernels->rolls() ? friction_.start_acceleration.data() : nullptr};
  for (Index i = 0; i < items_.layout.owned; ++i) {
    const FrictionNorms one = of(i);
    finite = finite && std::isfinite(one.residual);
    largest.residual = std::max(largest.residual, one.residual);
    largest.correction_bound = std::max(largest.correction_bound, one.correction_bound);
    largest.force = std::max(largest.force, one.force);
    largest.stiffness_ratio = std::max(largest.stiffness_ratio, one.stiffness_ratio);
    largest.phase_squared = std::max(largest.phase_squared, one.phase_squared);
  }
  Real maxima[6] = {largest.residual,        largest.correction_bound, largest.force,
                    largest.stiffness_ratio, largest.phase_squared,    finite ? Real(0) : Real(1)};
  items_.ranks.max(maxima);
  if (maxima[5] != 0) report_not_finite();
  largest.residual = maxima[0], largest.correction_bound = maxima[1], largest.force = maxima[2];
  largest.stiffness_ratio = maxima[3], largest.phase_squared = maxima[4];
  return largest;
}

void CpuFrictionStep::report_not_finite() {
  for (Index i = 0; i < items_.layout.owned; ++i)
    arrays_.residual[i] = friction_.residual[i].move + friction_.residual[i].turn;
  items_.report_not_finite(arrays_.residual);
}

ParticleNorms CpuFrictionStep::contact_force() {
  const Index n = items_.layout.owned;
  find_friction_steps();
  items_.kernels->friction_system(items_.views(), n,
                                  {items_.model.gravity, newton_weights(), friction_start(), step_forces(),
                                   step_torques(), matrix(), friction_.phase_squared.data()});
  const PackedRows rows{items_.list.offsets.data(), items_.list.neighbors.data()};
  with_rolling(items_.kernels->rolls(), [&](auto rolls) {
    const FrictionResidualItem<decltype(rolls)::value> residual{step_views(),
                                                                rotation_views(),
                                                                step_forces(),
                                                                step_torques(),
                                                                friction_.residual.data(),
                                                                friction_.mass.data(),
                                                                {friction_.inverse_block.data()},
                                                                arrays_.stiffness_ratio.data()};
    for (Index i = 0; i < n; ++i)
      residual(i, matrix(), rows, items_.list.surfaces.offsets[static_cast<std::size_t>(i)]);
  });
  const FrictionNorms largest = largest_norms();
  force_scale_ = largest.force, largest_stiffness_ratio_ = largest.stiffness_ratio,
  phase_squared_ = largest.phase_squared;
  scaled_residual_ = scaled_residual(largest);
  if (search_.is_open()) search_.update(scaled_residual_);
  return {scaled_residual_, largest.correction_bound, search_.overshoots()};
}

GlobalId CpuFrictionStep::worst_particle() {
  Real own = 0;
  for (const Twist& r : friction_.residual) own = std::max(own, largest_part(r));
  const Real largest = items_.ranks.max(own);
  GlobalId worst = CpuItems::kNone;
  for (Index i = 0; i < items_.layout.owned; ++i)
    if (largest_part(friction_.residual[static_cast<std::size_t>(i)]) == largest)
      worst = std::min(worst, id_of(items_.store.row_key[static_cast<std::size_t>(i)]));
  worst = items_.ranks.min(worst);
  return worst == CpuItems::kNone ? -1 : worst;
}

FrictionCorrectItem CpuFrictionStep::correct_item(Real share) {
  return {items_.store.acceleration.data(),     items_.store.angular_acceleration.data(),
          friction_.correction.data(),          unit_,
          items_.store.position.data(),         share,
          newmark_position_gain(items_.hht, h_)};
}

void CpuFrictionStep::shorten_correction() {
  for_each(Serial{}, items_.layout.owned, correct_item(search_.shorten()));
  rotate_particles();
}

// The matrix is not consistent with lagged limits, which have no derivative.
bool CpuFrictionStep::is_consistent() const { return !lagged_ && ::scree::is_consistent(phase_squared_); }

// Prepares the right-hand side for the solve and returns its largest component [N]. The bodies have already
// taken their correction, see `CpuImplicitStep`.
Real CpuFrictionStep::right_hand_side() {
  if (items_.side.size() == 0) return scaled_residual_ * force_scale_;
  for_each(Serial{}, items_.layout.owned,
           FrictionShiftItem{matrix(),
                             items_.list.surfaces.offsets.data(),
                             items_.list.surfaces.surfaces.data(),
                             items_.surfaces.numbers(),
                             items_.surfaces.friction_steps(),
                             newton_weights(),
                             is_consistent(),
                             {items_.side.step().data(), items_.side.step_rotation().data()},
                             friction_.residual.data()});
  const Real largest =
      items_.ranks.max(max_over(Serial{}, items_.layout.owned, TwistSizeItem{friction_.residual.data()}));
  if (!std::isfinite(largest)) report_not_finite();
  return largest;
}

int CpuFrictionStep::solve(Real tolerance) {
  return with_rolling(items_.kernels->rolls(),
                      [&](auto rolls) { return solve<decltype(rolls)::value>(tolerance); });
}

template <bool kRolls>
int CpuFrictionStep::solve(Real tolerance) {
  const Index n = items_.layout.owned;
  std::vector<Twistf>& d = friction_.direction;
  std::fill_n(d.begin(), n, Twistf{});
  std::fill(friction_.correction.begin(), friction_.correction.end(), Twistf{});
  const SubtractFrictionItem<PackedRows, kRolls> subtract{
      matrix(),
      {items_.list.offsets.data(), items_.list.neighbors.data()},
      items_.list.surfaces.offsets.data(),
      friction_.mass.data(),
      is_consistent(),
      d.data(),
      unit_,
      friction_.residual.data()};
  return iterate_chebyshev(largest_stiffness_ratio_, tolerance, [&](const ChebyshevWeights& weights) {
    const TwistDirectionItem direction{{friction_.inverse_block.data()},
                                       friction_.residual.data(),
                                       weights.from_last,
                                       weights.from_residual / unit_};
    for (Index i = 0; i < n; ++i) {
      d[i] = direction.next(i, d[i]);
      friction_.correction[i] += d[i];
    }
    items_.halo.update(std::span<Twistf>(d), n);
    for_each(Serial{}, n, subtract);
    Real largest = 0;
    for (const Twist& r : friction_.residual) largest = std::max(largest, largest_part(r));
    return items_.ranks.max(largest);
  });
}

ParticleCorrection CpuFrictionStep::particle_correct() {
  ParticleCorrection out;
  search_ = {};
  const Real largest = right_hand_side();
  if (largest > 0) {
    unit_ = direction_unit(largest);
    out.iterations = solve(
        tolerance_.next(is_consistent(), items_.model.integrator.residual_tolerance, force_scale_, largest));
    out.correction = items_.ranks.max(max_over(Serial{}, items_.layout.owned, correct_item(1)));
    search_.open(std::max(scaled_residual_, largest / force_scale_));
  }
  rotate_particles();
  return out;
}

void CpuFrictionStep::lag_limits() {
  friction_.neighbor_limits.assign(items_.list.neighbors.size(), -1);
  friction_.surface_limits.assign(items_.list.surfaces.surfaces.size(), -1);
  items_.kernels->store_lagged_limits(items_.views(), items_.layout.owned, friction_start(),
                                      {friction_.neighbor_limits.data(), friction_.surface_limits.data()});
  lagged_ = true, search_ = {};
}

Real CpuFrictionStep::error() {
  return items_.ranks.max(
      max_over(Serial{}, items_.layout.owned, RotationErrorItem{step_views(), rotation_views()}));
}

void CpuFrictionStep::accept() {
  ParticleStore& store = items_.store;
  const Index n = items_.layout.owned;
  find_friction_steps();
  items_.kernels->friction_losses(
      items_.views(), n, friction_start(),
      {store.contact_loss.data(), store.integrator_loss.data(), store.friction_loss.data(),
       store.rolling_loss.data(), store.twisting_loss.data()});
  items_.history.accepted();
  items_.side.book_step();
  items_.surfaces.accumulate_friction_works(items_.side.poses(), store, items_.list.surfaces);
  for_each(Serial{}, n, BalanceItem{step_views(), rotation_views(), step_forces(), step_torques()});
  for_each(Serial{}, n,
           AcceptItem{step_views(), step_forces(), store.force.data(), store.integrator_loss.data()});
  for_each(Serial{}, n,
           AcceptRotationItem{step_views(), rotation_views(), step_torques(), store.orientation.data(),
                              store.integrator_loss.data()});
}

}  // namespace scree
