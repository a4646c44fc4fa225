// The same schedule as src/dem/cpu/cpu_friction.cpp, with kernels.
#include <algorithm>
#include <cmath>

#include "cuda_bodies.cuh"
#include "cuda_friction.cuh"

namespace scree {
namespace {

struct IsLargest {
  const Twist* residual;
  const Real* largest;
  __device__ bool operator()(Index i) const { return largest_part(residual[i]) == *largest; }
};

// Whether the translational or the rotational part is not finite.
struct SumOfPartsItem {
  const Twist* twist;
  Vec3* sum;
  SCREE_HD void operator()(Index i) const { sum[i] = twist[i].move + twist[i].turn; }
};

struct TwistGhostItem {
  const Ghost* ghosts;
  GhostField<Twistf> twist;
  SCREE_HD void operator()(Index entry) const { twist.put(entry, twist.field[ghosts[entry].source]); }
};

struct FirstTwistItem {
  TwistDirectionItem direction;
  Twistf *first, *solution;
  SCREE_HD void operator()(Index i) const { first[i] = direction.next(i, {}), solution[i] = {}; }
};

// One step of the solve: adds the direction to the solution, updates the residual, and computes the next
// direction.
template <bool kRolls>
struct FrictionSolverItem {
  SubtractFrictionItem<SlicedRows, kRolls> subtract;
  TwistDirectionItem direction;  // weights of the next direction
  Twistf *next, *solution;

  SCREE_HD Real operator()(Index i) const {
    const Twistf d = subtract.d[i];
    solution[i] += d;
    subtract(i);
    next[i] = direction.next(i, d);
    const Twist left = subtract.residual[i];
    const Real move = dot(left.move, left.move), turn = dot(left.turn, left.turn);
    return move > turn ? move : turn;
  }
};

constexpr int kResidualThreads = 128;

// Residual, diagonal block and norms of a particle from its entries of the Newton matrix.
template <bool kRolls>
__global__ void __launch_bounds__(kResidualThreads)
    residual_kernel(Index n, const __grid_constant__ FrictionResidualItem<kRolls> residual,
                    const FrictionMatrix matrix, const SlicedRows rows, const Index* surface_offsets,
                    const __grid_constant__ FrictionNormsItem of, FrictionNorms* largest) {
  const Index i = thread_index();
  FrictionNorms norms{};
  if (i < n) {
    residual(i, matrix, rows, surface_offsets[i]);
    norms = of(i);
  }
  block_max(norms.residual, &largest->residual);
  block_max(norms.correction_bound, &largest->correction_bound);
  block_max(norms.force, &largest->force);
  block_max(norms.stiffness_ratio, &largest->stiffness_ratio);
  block_max(norms.phase_squared, &largest->phase_squared);
}

}  // namespace

void CudaFrictionArrays::resize(const CudaItems& items) {
  const auto owned = static_cast<std::size_t>(items.owned),
             all = static_cast<std::size_t>(items.layout.items);
  mean_spin.resize(all);
  for (DeviceArray<Twistf>& of : direction) of.resize(all);
  const bool rolls = items.kernels->rolls();
  entries.resize(static_cast<std::size_t>(items.list.slots()), rolls);
  surface_entries.resize(static_cast<std::size_t>(items.surfaces.entries()));
  if (rolls) surface_rolling.resize(static_cast<std::size_t>(items.surfaces.entries()));
  start_torque.resize(owned), step_torque.resize(owned), end_torque.resize(owned);
  phase_squared.resize(owned), surface_count.resize(owned);
  mass.resize(owned), inverse_block.resize(BlockSlices::size(owned)), residual.resize(owned),
      correction.resize(owned);
}

// The state at the start of the step is kept by swapping the arrays.
CudaFrictionStep::CudaFrictionStep(CudaItems& items, CudaBodies& bodies, CudaImplicitArrays& arrays, Real h)
    : CudaImplicitStep(items, bodies, arrays, h), friction_(arrays.friction) {
  std::swap(items.now.angular_velocity, items.other.angular_velocity);
}

RotationViews CudaFrictionStep::rotation_views() {
  ParticleArrays& now = items_.now;
  SecondArrays& start = items_.other;
  return {now.angular_velocity.data(), friction_.mean_spin.data(), now.angular_acceleration.data(),
          start.angular_velocity.data(), start.angular_acceleration.data()};
}

StepTorques CudaFrictionStep::step_torques() {
  return {friction_.start_torque.data(), friction_.step_torque.data(), friction_.end_torque.data()};
}

FrictionStart CudaFrictionStep::friction_start() {
  LaggedLimits lagged;
  if (lagged_) lagged = {friction_.neighbor_limits.data(), friction_.surface_limits.data()};
  return {step_start(), items_.other.angular_velocity.data(), friction_.mean_spin.data(), lagged,
          items_.surfaces.friction_steps()};
}

FrictionMatrix CudaFrictionStep::matrix() {
  return {arrays_.matrix_count.data(), friction_.surface_count.data(), friction_.entries.views(),
          friction_.surface_entries.data(), friction_.surface_rolling.data()};
}

// Predicts positions and orientations from the accelerations.
void CudaFrictionStep::rotate_particles() {
  for_each(items_.device(), items_.owned, SpinUpdateItem{step_views(), rotation_views()});
  for_each(items_.device(), items_.owned, NewmarkItem{step_views()});
  ghosts_stale_ = true;
}

void CudaFrictionStep::predict() {
  copy_async(items_.other.angular_acceleration.data(), items_.now.angular_acceleration.data(),
             static_cast<std::size_t>(items_.owned), items_.stream);
  CudaImplicitStep::predict();
  rotate_particles();
}

void CudaFrictionStep::undo() {
  ParticleArrays& now = items_.now;
  SecondArrays& start = items_.other;
  std::swap(now.angular_velocity, start.angular_velocity);
  copy_async(now.angular_acceleration.data(), start.angular_acceleration.data(),
             static_cast<std::size_t>(items_.owned), items_.stream);
  CudaImplicitStep::undo();
}

void CudaFrictionStep::refresh_ghosts(Device on) {
  items_.refresh_ghosts(on);
  DeviceHalo& halo = items_.halo_stream.halo;
  const SpinGhostItem mean{halo.ghosts(), halo.field(0, friction_.mean_spin.data(), items_.owned)};
  for_each(on, halo.entries(), mean);
  halo.exchange(on, mean.spin);
}

// Forces, Newton matrix and residual, after a refresh of the ghosts where the iterate has changed.
void CudaFrictionStep::queue_system() {
  DeviceFrictionRequest r;
  r.in = items_.views();
  r.of = {items_.model.gravity,
          newton_weights(),
          friction_start(),
          step_forces(),
          step_torques(),
          matrix(),
          friction_.phase_squared.data()};
  const auto queue_rows = [&](Device on, Index first, Index end) {
    r.first = first, r.end = end;
    items_.kernels->friction_system(on, r);
  };
  if (ghosts_stale_) {
    items_.halo_after_rows();
    items_.queue_overlapping_halo([&](Device on) { refresh_ghosts(on); }, queue_rows,
                                  &items_.halo_stream.clock);
    items_.rows_after_halo();
    ghosts_stale_ = false;
  } else {
    queue_rows(items_.device(), 0, items_.owned);
  }
  friction_.norms.zero(items_.stream);
  if (items_.owned == 0) return;
  with_rolling(items_.kernels->rolls(), [&](auto rolls) { queue_residual<decltype(rolls)::value>(); });
}

template <bool kRolls>
void CudaFrictionStep::queue_residual() {
  const FrictionResidualItem<kRolls> residual{step_views(),
                                              rotation_views(),
                                              step_forces(),
                                              step_torques(),
                                              friction_.residual.data(),
                                              friction_.mass.data(),
                                              {friction_.inverse_block.data()},
                                              arrays_.stiffness_ratio.data()};
  const FrictionNormsItem norms{step_views(),
                                friction_.residual.data(),
                                friction_.mass.data(),
                                arrays_.force_magnitude.data(),
                                arrays_.stiffness_ratio.data(),
                                friction_.phase_squared.data(),
                                kRolls ? items_.other.angular_acceleration.data() : nullptr};
  residual_kernel<kRolls><<<blocks_for(items_.owned, kResidualThreads), kResidualThreads, 0, items_.stream>>>(
      items_.owned, residual, matrix(), items_.list.rows(), items_.surfaces.list().offsets, norms,
      friction_.norms.data());
  require_cuda(cudaGetLastError(), "residual with friction");
}

// Maxima over the particles of all ranks; waits.
FrictionNorms CudaFrictionStep::largest_norms() {
  copy_async(friction_.h_norms.data(), friction_.norms.data(), 1, items_.stream);
  wait_for(items_.stream);
  FrictionNorms largest = friction_.h_norms[0];
  items_.halo_stream.clock.read(items_.balance.halo);
  Real maxima[5] = {largest.residual, largest.correction_bound, largest.force, largest.stiffness_ratio,
                    largest.phase_squared};
  items_.ranks.max(maxima);
  largest.residual = maxima[0], largest.correction_bound = maxima[1], largest.force = maxima[2];
  largest.stiffness_ratio = maxima[3], largest.phase_squared = maxima[4];
  if (!std::isfinite(largest.residual)) report_not_finite();
  return largest;
}

void CudaFrictionStep::report_not_finite() {
  for_each(items_.device(), items_.owned, SumOfPartsItem{friction_.residual.data(), arrays_.residual.data()});
  items_.report_not_finite(arrays_.residual.data());
}

ParticleNorms CudaFrictionStep::contact_force() {
  bodies_.find_friction_steps(friction_start());
  queue_system();
  bodies_.take_steps(h_);
  const FrictionNorms largest = largest_norms();
  force_scale_ = largest.force, largest_stiffness_ratio_ = largest.stiffness_ratio,
  phase_squared_ = largest.phase_squared;
  scaled_residual_ = scaled_residual(largest);
  if (search_.is_open()) search_.update(scaled_residual_);
  return {scaled_residual_, largest.correction_bound, search_.overshoots()};
}

GlobalId CudaFrictionStep::worst_particle() {
  Real* largest = items_.results.at(&Results::largest);
  max_over(items_.device(), items_.owned, TwistSizeItem{friction_.residual.data()}, largest);
  items_.halo_stream.halo.max(items_.device(), largest, 1);
  const long long worst = items_.smallest_id(IsLargest{friction_.residual.data(), largest});
  return worst < kNoId ? worst : -1;
}

FrictionCorrectItem CudaFrictionStep::correct_item(Real share) {
  return {items_.now.acceleration.data(),       items_.now.angular_acceleration.data(),
          friction_.correction.data(),          unit_,
          items_.now.position.data(),           share,
          newmark_position_gain(items_.hht, h_)};
}

void CudaFrictionStep::shorten_correction() {
  max_over(items_.device(), items_.owned, correct_item(search_.shorten()),
           items_.results.at(&Results::largest));
  rotate_particles();
}

// With lagged limits no stiffness grows.
bool CudaFrictionStep::is_consistent() const { return !lagged_ && ::scree::is_consistent(phase_squared_); }

// Prepares the residual for the solve and returns its largest component [N]. The bodies have applied their
// correction already: see `CudaImplicitStep`.
Real CudaFrictionStep::right_hand_side() {
  if (!bodies_.have_surfaces()) return scaled_residual_ * force_scale_;
  for_each(items_.device(), items_.owned,
           FrictionShiftItem{matrix(), items_.surfaces.list().offsets, items_.surfaces.list().surfaces,
                             items_.surfaces.numbers(), items_.surfaces.friction_steps(), newton_weights(),
                             is_consistent(), bodies_.upload_moves(), friction_.residual.data()});
  max_over(items_.device(), items_.owned, TwistSizeItem{friction_.residual.data()},
           items_.results.at(&Results::largest));
  const Real largest = items_.ranks.max(items_.results.fetch(&Results::largest));
  if (!std::isfinite(largest)) report_not_finite();
  return largest;
}

int CudaFrictionStep::solve(Real tolerance) {
  return with_rolling(items_.kernels->rolls(),
                      [&](auto rolls) { return solve<decltype(rolls)::value>(tolerance); });
}

template <bool kRolls>
int CudaFrictionStep::solve(Real tolerance) {
  DeviceHalo& halo = items_.halo_stream.halo;
  Twist* residual = friction_.residual.data();
  Twistf* correction = friction_.correction.data();
  const auto direction = [&](const ChebyshevWeights& weights) {
    return TwistDirectionItem{
        {friction_.inverse_block.data()}, residual, weights.from_last, weights.from_residual / unit_};
  };
  const auto twist = [&](int k) { return friction_.direction[k % 2].data(); };
  const auto begin = [&](const ChebyshevWeights& weights) {
    for_each(items_.device(), items_.owned, FirstTwistItem{direction(weights), twist(0), correction});
  };
  const auto ghosts = [&](Device on, int product) {
    const TwistGhostItem item{halo.ghosts(), halo.field(0, twist(product), items_.owned)};
    for_each(on, halo.entries(), item);
    halo.exchange(on, item.twist);
  };
  const auto item = [&](int product, const ChebyshevWeights& weights) {
    return FrictionSolverItem<kRolls>{
        {matrix(), items_.list.rows(), items_.surfaces.list().offsets, friction_.mass.data(), is_consistent(),
         twist(product), unit_, residual},
        direction(weights),
        twist(product + 1),
        correction};
  };
  return solve_on_device(items_, arrays_.solver, largest_stiffness_ratio_, tolerance, begin, ghosts, item);
}

ParticleCorrection CudaFrictionStep::particle_correct() {
  ParticleCorrection out;
  search_ = {};
  const Real largest = right_hand_side();
  if (largest > 0) {
    unit_ = direction_unit(largest);
    out.iterations = solve(
        tolerance_.next(is_consistent(), items_.model.integrator.residual_tolerance, force_scale_, largest));
    max_over(items_.device(), items_.owned, correct_item(1), items_.results.at(&Results::largest));
    search_.open(std::max(scaled_residual_, largest / force_scale_));
  }
  rotate_particles();
  if (largest > 0) out.correction = items_.ranks.max(items_.results.fetch(&Results::largest));
  return out;
}

void CudaFrictionStep::lag_limits() {
  const auto clear = [&](DeviceArray<Real>& limits, std::int64_t n) {  // all bits set, a NaN: no contact
    limits.resize(static_cast<std::size_t>(n));
    const std::size_t bytes = static_cast<std::size_t>(n) * sizeof(Real);
    if (n > 0) require_cuda(cudaMemsetAsync(limits.data(), 0xff, bytes, items_.stream), "cudaMemsetAsync");
  };
  clear(friction_.neighbor_limits, items_.list.entries());
  clear(friction_.surface_limits, items_.surfaces.entries());
  const LaggedLimits to{friction_.neighbor_limits.data(), friction_.surface_limits.data()};
  if (ghosts_stale_) {  // on the halo stream, as in a pass over the rows
    items_.halo_after_rows();
    items_.queue_overlapping_halo([&](Device on) { refresh_ghosts(on); }, [](Device, Index, Index) {},
                                  nullptr);
    items_.rows_after_halo();
    ghosts_stale_ = false;
  }
  items_.kernels->store_lagged_limits(items_.device(), items_.views(), items_.owned, friction_start(), to);
  lagged_ = true, search_ = {};
}

Real CudaFrictionStep::error() {
  max_over(items_.device(), items_.owned, RotationErrorItem{step_views(), rotation_views()},
           items_.results.at(&Results::largest));
  return items_.ranks.max(items_.results.fetch(&Results::largest));
}

void CudaFrictionStep::accept() {
  ParticleArrays& now = items_.now;
  bodies_.find_friction_steps(friction_start());
  items_.kernels->friction_losses(
      items_.device(), items_.views(), items_.owned, friction_start(),
      {now.contact_loss.data(), now.integrator_loss.data(), now.friction_loss.data(), now.rolling_loss.data(),
       now.twisting_loss.data()});
  items_.surfaces.accumulate_friction_works(items_.device(), *items_.kernels);
  items_.history.accepted();
  for_each(items_.device(), items_.owned,
           BalanceItem{step_views(), rotation_views(), step_forces(), step_torques()});
  for_each(items_.device(), items_.owned,
           AcceptItem{step_views(), step_forces(), now.force.data(), now.integrator_loss.data()});
  for_each(items_.device(), items_.owned,
           AcceptRotationItem{step_views(), rotation_views(), step_torques(), now.orientation.data(),
                              now.integrator_loss.data()});
  bodies_.take_steps(h_);
  bodies_.side().book_step();
}

}  // namespace scree
