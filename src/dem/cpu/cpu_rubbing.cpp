#include "dem/cpu/cpu_rubbing.hpp"

#include <algorithm>
#include <cmath>

#include "base/for_each.hpp"

namespace scree {

void CpuRubbingArrays::resize(const CpuItems& items) {
  const auto owned = static_cast<std::size_t>(items.layout.owned),
             all = static_cast<std::size_t>(items.layout.items);
  mean_spin.resize(all), direction.resize(all);
  entries.resize(items.list.neighbors.size()), surface_entries.resize(items.list.surfaces.surfaces.size());
  start_torque.resize(owned), step_torque.resize(owned), end_torque.resize(owned);
  sharpness.resize(owned), surface_count.resize(owned);
  mass.resize(owned), inverse_block.resize(BlockSlices::size(owned)), residual.resize(owned),
      correction.resize(owned);
}

CpuRubbingStep::CpuRubbingStep(CpuItems& items, CpuImplicitArrays& motion, CpuRubbingArrays& arrays, Real h)
    : CpuImplicitStep(items, motion, h), rubbing_(arrays) {
  rubbing_.resize(items);
  rubbing_.start_spin = items.store.angular_velocity;
  rubbing_.start_acceleration = items.store.angular_acceleration;
}

TurningViews CpuRubbingStep::turning_views() {
  return {items_.store.angular_velocity.data(), rubbing_.mean_spin.data(),
          items_.store.angular_acceleration.data(), rubbing_.start_spin.data(),
          rubbing_.start_acceleration.data()};
}

StepTorques CpuRubbingStep::step_torques() {
  return {rubbing_.start_torque.data(), rubbing_.step_torque.data(), rubbing_.end_torque.data()};
}

RubbingStart CpuRubbingStep::rubbing_start() {
  FrozenLimits frozen;
  if (frozen_) frozen = {rubbing_.neighbor_limits.data(), rubbing_.surface_limits.data()};
  return {step_start(), rubbing_.start_spin.data(), rubbing_.mean_spin.data(), frozen,
          items_.surfaces.rubs()};
}

void CpuRubbingStep::find_rubs() {
  if (items_.side.size() == 0) return;
  const SurfaceRows& rows = items_.list.surfaces;
  items_.surfaces.find_rubs(items_.side.places(), items_.store, rows, rubbing_start(),
                            items_.history.views());
  items_.side.take_steps(items_.surfaces.rub_sums(rows), h_);
}

RubbingMatrix CpuRubbingStep::matrix() {
  return {arrays_.matrix_count.data(), rubbing_.surface_count.data(), rubbing_.entries.views(),
          rubbing_.surface_entries.data()};
}

// Moves and rotates the particles according to their accelerations.
void CpuRubbingStep::turn_particles() {
  for_each(Serial{}, items_.layout.owned, TurnItem{step_views(), turning_views()});
  move_particles();
  items_.halo.update(std::span<Vec4>(rubbing_.mean_spin), items_.layout.owned);
}

void CpuRubbingStep::predict() { turn_particles(); }

void CpuRubbingStep::undo() {
  std::copy_n(rubbing_.start_spin.begin(), items_.layout.owned, items_.store.angular_velocity.begin());
  items_.store.angular_acceleration = rubbing_.start_acceleration;
  CpuImplicitStep::undo();
}

// Maxima over the particles of all ranks.
RubbingNorms CpuRubbingStep::largest_norms() {
  RubbingNorms largest{};
  bool finite = true;
  const RubbingNormsItem of{step_views(),
                            rubbing_.residual.data(),
                            rubbing_.mass.data(),
                            arrays_.force_magnitude.data(),
                            arrays_.stiffening.data(),
                            rubbing_.sharpness.data()};
  for (Index i = 0; i < items_.layout.owned; ++i) {
    const RubbingNorms one = of(i);
    finite = finite && std::isfinite(one.residual);
    largest.residual = std::max(largest.residual, one.residual);
    largest.correction_bound = std::max(largest.correction_bound, one.correction_bound);
    largest.force = std::max(largest.force, one.force);
    largest.stiffening = std::max(largest.stiffening, one.stiffening);
    largest.sharpness = std::max(largest.sharpness, one.sharpness);
  }
  Real maxima[6] = {largest.residual,   largest.correction_bound, largest.force,
                    largest.stiffening, largest.sharpness,        finite ? Real(0) : Real(1)};
  items_.ranks.max(maxima);
  if (maxima[5] != 0) report_not_finite();
  largest.residual = maxima[0], largest.correction_bound = maxima[1], largest.force = maxima[2];
  largest.stiffening = maxima[3], largest.sharpness = maxima[4];
  return largest;
}

void CpuRubbingStep::report_not_finite() {
  for (Index i = 0; i < items_.layout.owned; ++i)
    arrays_.residual[i] = rubbing_.residual[i].move + rubbing_.residual[i].turn;
  items_.report_not_finite(arrays_.residual);
}

ParticleNorms CpuRubbingStep::contact_force() {
  const Index n = items_.layout.owned;
  find_rubs();
  items_.kernels->rubbing_system(items_.views(), n,
                                 {items_.model.gravity, newton_weights(), rubbing_start(), step_forces(),
                                  step_torques(), matrix(), rubbing_.sharpness.data()});
  const RubbingResidualItem residual{step_views(),
                                     turning_views(),
                                     step_forces(),
                                     step_torques(),
                                     rubbing_.residual.data(),
                                     rubbing_.mass.data(),
                                     {rubbing_.inverse_block.data()},
                                     arrays_.stiffening.data()};
  const PackedRows rows{items_.list.offsets.data(), items_.list.neighbors.data()};
  for (Index i = 0; i < n; ++i)
    residual(i, matrix(), rows, items_.list.surfaces.offsets[static_cast<std::size_t>(i)]);
  const RubbingNorms largest = largest_norms();
  force_scale_ = largest.force, largest_stiffening_ = largest.stiffening, sharpness_ = largest.sharpness;
  scaled_residual_ = scaled_residual(largest);
  if (search_.is_open()) search_.look(scaled_residual_);
  return {scaled_residual_, largest.correction_bound, search_.overshoots()};
}

GlobalId CpuRubbingStep::worst_particle() {
  Real own = 0;
  for (const Twist& r : rubbing_.residual) own = std::max(own, largest_part(r));
  const Real largest = items_.ranks.max(own);
  GlobalId worst = CpuItems::kNone;
  for (Index i = 0; i < items_.layout.owned; ++i)
    if (largest_part(rubbing_.residual[static_cast<std::size_t>(i)]) == largest)
      worst = std::min(worst, id_of(items_.store.row_key[static_cast<std::size_t>(i)]));
  worst = items_.ranks.min(worst);
  return worst == CpuItems::kNone ? -1 : worst;
}

RubbingCorrectItem CpuRubbingStep::correct_item(Real share) {
  return {items_.store.acceleration.data(),     items_.store.angular_acceleration.data(),
          rubbing_.correction.data(),           unit_,
          items_.store.position.data(),         share,
          newmark_position_gain(items_.hht, h_)};
}

void CpuRubbingStep::shorten_correction() {
  for_each(Serial{}, items_.layout.owned, correct_item(search_.shorten()));
  turn_particles();
}

// The matrix is not consistent with lagged limits, which have no derivative.
bool CpuRubbingStep::is_consistent() const { return !frozen_ && ::scree::is_consistent(sharpness_); }

// Prepares the right-hand side for the solve and returns its largest component [N]. The bodies have already
// taken their correction, see `CpuImplicitStep`.
Real CpuRubbingStep::right_hand_side() {
  if (items_.side.size() == 0) return scaled_residual_ * force_scale_;
  for_each(Serial{}, items_.layout.owned,
           RubbingShiftItem{matrix(),
                            items_.list.surfaces.offsets.data(),
                            items_.list.surfaces.surfaces.data(),
                            items_.surfaces.numbers(),
                            items_.surfaces.rubs(),
                            newton_weights(),
                            is_consistent(),
                            {items_.side.step().data(), items_.side.step_turn().data()},
                            rubbing_.residual.data()});
  const Real largest =
      items_.ranks.max(max_over(Serial{}, items_.layout.owned, TwistSizeItem{rubbing_.residual.data()}));
  if (!std::isfinite(largest)) report_not_finite();
  return largest;
}

int CpuRubbingStep::solve(Real tolerance) {
  const Index n = items_.layout.owned;
  std::vector<Twistf>& d = rubbing_.direction;
  std::fill_n(d.begin(), n, Twistf{});
  std::fill(rubbing_.correction.begin(), rubbing_.correction.end(), Twistf{});
  const SubtractRubbingItem<PackedRows> subtract{matrix(),
                                                 {items_.list.offsets.data(), items_.list.neighbors.data()},
                                                 items_.list.surfaces.offsets.data(),
                                                 rubbing_.mass.data(),
                                                 is_consistent(),
                                                 d.data(),
                                                 unit_,
                                                 rubbing_.residual.data()};
  return iterate_chebyshev(largest_stiffening_, tolerance, [&](const ChebyshevWeights& weights) {
    const TwistDirectionItem direction{{rubbing_.inverse_block.data()},
                                       rubbing_.residual.data(),
                                       weights.from_last,
                                       weights.from_residual / unit_};
    for (Index i = 0; i < n; ++i) {
      d[i] = direction.next(i, d[i]);
      rubbing_.correction[i] += d[i];
    }
    items_.halo.update(std::span<Twistf>(d), n);
    for_each(Serial{}, n, subtract);
    Real largest = 0;
    for (const Twist& r : rubbing_.residual) largest = std::max(largest, largest_part(r));
    return items_.ranks.max(largest);
  });
}

ParticleCorrection CpuRubbingStep::particle_correct() {
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
  turn_particles();
  return out;
}

void CpuRubbingStep::freeze_limits() {
  rubbing_.neighbor_limits.assign(items_.list.neighbors.size(), -1);
  rubbing_.surface_limits.assign(items_.list.surfaces.surfaces.size(), -1);
  items_.kernels->freeze(items_.views(), items_.layout.owned, rubbing_start(),
                         {rubbing_.neighbor_limits.data(), rubbing_.surface_limits.data()});
  frozen_ = true, search_ = {};
}

Real CpuRubbingStep::error() {
  return items_.ranks.max(
      max_over(Serial{}, items_.layout.owned, TurningErrorItem{step_views(), turning_views()}));
}

void CpuRubbingStep::accept() {
  ParticleStore& store = items_.store;
  const Index n = items_.layout.owned;
  find_rubs();
  items_.kernels->rubbing_books(
      items_.views(), n, rubbing_start(),
      {store.contact_loss.data(), store.integrator_loss.data(), store.friction_loss.data()});
  items_.history.accepted();
  items_.side.book_step();
  items_.surfaces.book_rubs(items_.side.places(), store, items_.list.surfaces);
  for_each(Serial{}, n, BalanceItem{step_views(), turning_views(), step_forces(), step_torques()});
  for_each(Serial{}, n,
           AcceptItem{step_views(), step_forces(), store.force.data(), store.integrator_loss.data()});
  for_each(Serial{}, n,
           AcceptTurnItem{step_views(), turning_views(), step_torques(), store.orientation.data(),
                          store.integrator_loss.data()});
}

}  // namespace scree
