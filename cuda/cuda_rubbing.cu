// The same schedule as src/dem/cpu_rubbing.cpp, with kernels.
#include <algorithm>
#include <cmath>

#include "cuda_bodies.cuh"
#include "cuda_rubbing.cuh"

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
struct RubbingSolverItem {
  SubtractRubbingItem<SlicedRows> subtract;
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
__global__ void __launch_bounds__(kResidualThreads)
    residual_kernel(Index n, const __grid_constant__ RubbingResidualItem residual, const RubbingMatrix matrix,
                    const SlicedRows rows, const Index* surface_offsets,
                    const __grid_constant__ RubbingNormsItem of, RubbingNorms* largest) {
  const Index i = thread_index();
  RubbingNorms norms{};
  if (i < n) {
    residual(i, matrix, rows, surface_offsets[i]);
    norms = of(i);
  }
  block_max(norms.residual, &largest->residual);
  block_max(norms.correction_bound, &largest->correction_bound);
  block_max(norms.force, &largest->force);
  block_max(norms.stiffening, &largest->stiffening);
  block_max(norms.sharpness, &largest->sharpness);
}

}  // namespace

void CudaRubbingArrays::resize(const CudaItems& items) {
  const auto owned = static_cast<std::size_t>(items.owned),
             all = static_cast<std::size_t>(items.layout.items);
  mean_spin.resize(all);
  for (DeviceArray<Twistf>& of : direction) of.resize(all);
  entries.resize(static_cast<std::size_t>(items.list.slots()));
  surface_entries.resize(static_cast<std::size_t>(items.surfaces.entries()));
  start_torque.resize(owned), step_torque.resize(owned), end_torque.resize(owned);
  sharpness.resize(owned), surface_count.resize(owned);
  mass.resize(owned), inverse_block.resize(BlockSlices::size(owned)), residual.resize(owned),
      correction.resize(owned);
}

// The state at the start of the step is kept by swapping the arrays.
CudaRubbingStep::CudaRubbingStep(CudaItems& items, CudaBodies& bodies, CudaImplicitArrays& arrays, Real h)
    : CudaImplicitStep(items, bodies, arrays, h), rubbing_(arrays.rubbing) {
  std::swap(items.now.angular_velocity, items.other.angular_velocity);
}

TurningViews CudaRubbingStep::turning_views() {
  ParticleArrays& now = items_.now;
  SecondArrays& start = items_.other;
  return {now.angular_velocity.data(), rubbing_.mean_spin.data(), now.angular_acceleration.data(),
          start.angular_velocity.data(), start.angular_acceleration.data()};
}

StepTorques CudaRubbingStep::step_torques() {
  return {rubbing_.start_torque.data(), rubbing_.step_torque.data(), rubbing_.end_torque.data()};
}

RubbingStart CudaRubbingStep::rubbing_start() {
  FrozenLimits frozen;
  if (frozen_) frozen = {rubbing_.neighbor_limits.data(), rubbing_.surface_limits.data()};
  return {step_start(), items_.other.angular_velocity.data(), rubbing_.mean_spin.data(), frozen,
          items_.surfaces.rubs()};
}

RubbingMatrix CudaRubbingStep::matrix() {
  return {arrays_.matrix_count.data(), rubbing_.surface_count.data(), rubbing_.entries.views(),
          rubbing_.surface_entries.data()};
}

// Predicts positions and orientations from the accelerations.
void CudaRubbingStep::turn_particles() {
  for_each(items_.device(), items_.owned, TurnItem{step_views(), turning_views()});
  for_each(items_.device(), items_.owned, NewmarkItem{step_views()});
  ghosts_stale_ = true;
}

void CudaRubbingStep::predict() {
  copy_async(items_.other.angular_acceleration.data(), items_.now.angular_acceleration.data(),
             static_cast<std::size_t>(items_.owned), items_.stream);
  CudaImplicitStep::predict();
  turn_particles();
}

void CudaRubbingStep::undo() {
  ParticleArrays& now = items_.now;
  SecondArrays& start = items_.other;
  std::swap(now.angular_velocity, start.angular_velocity);
  copy_async(now.angular_acceleration.data(), start.angular_acceleration.data(),
             static_cast<std::size_t>(items_.owned), items_.stream);
  CudaImplicitStep::undo();
}

void CudaRubbingStep::refresh_ghosts(Device on) {
  items_.refresh_ghosts(on);
  DeviceHalo& halo = items_.lane.halo;
  const SpinGhostItem mean{halo.ghosts(), halo.field(0, rubbing_.mean_spin.data(), items_.owned)};
  for_each(on, halo.entries(), mean);
  halo.exchange(on, mean.spin);
}

// Forces, Newton matrix and residual, after a refresh of the ghosts where the iterate has changed.
void CudaRubbingStep::queue_system() {
  DeviceRubbingRequest r;
  r.in = items_.views();
  r.of = {items_.model.gravity, newton_weights(), rubbing_start(),          step_forces(),
          step_torques(),       matrix(),         rubbing_.sharpness.data()};
  const auto queue_rows = [&](Device on, Index first, Index end) {
    r.first = first, r.end = end;
    items_.kernels->rubbing_system(on, r);
  };
  if (ghosts_stale_) {
    items_.halo_after_rows();
    items_.queue_beside_halo([&](Device on) { refresh_ghosts(on); }, queue_rows, &items_.lane.clock);
    items_.rows_after_halo();
    ghosts_stale_ = false;
  } else {
    queue_rows(items_.device(), 0, items_.owned);
  }
  rubbing_.norms.zero(items_.stream);
  if (items_.owned == 0) return;
  const RubbingResidualItem residual{step_views(),
                                     turning_views(),
                                     step_forces(),
                                     step_torques(),
                                     rubbing_.residual.data(),
                                     rubbing_.mass.data(),
                                     {rubbing_.inverse_block.data()},
                                     arrays_.stiffening.data()};
  const RubbingNormsItem norms{step_views(),
                               rubbing_.residual.data(),
                               rubbing_.mass.data(),
                               arrays_.force_magnitude.data(),
                               arrays_.stiffening.data(),
                               rubbing_.sharpness.data()};
  residual_kernel<<<blocks_for(items_.owned, kResidualThreads), kResidualThreads, 0, items_.stream>>>(
      items_.owned, residual, matrix(), items_.list.rows(), items_.surfaces.list().offsets, norms,
      rubbing_.norms.data());
  require_cuda(cudaGetLastError(), "residual with friction");
}

// Maxima over the particles of all ranks; waits.
RubbingNorms CudaRubbingStep::largest_norms() {
  copy_async(rubbing_.h_norms.data(), rubbing_.norms.data(), 1, items_.stream);
  wait_for(items_.stream);
  RubbingNorms largest = rubbing_.h_norms[0];
  items_.lane.clock.read(items_.balance.halo);
  Real maxima[5] = {largest.residual, largest.correction_bound, largest.force, largest.stiffening,
                    largest.sharpness};
  items_.ranks.max(maxima);
  largest.residual = maxima[0], largest.correction_bound = maxima[1], largest.force = maxima[2];
  largest.stiffening = maxima[3], largest.sharpness = maxima[4];
  if (!std::isfinite(largest.residual)) report_not_finite();
  return largest;
}

void CudaRubbingStep::report_not_finite() {
  for_each(items_.device(), items_.owned, SumOfPartsItem{rubbing_.residual.data(), arrays_.residual.data()});
  items_.report_not_finite(arrays_.residual.data());
}

ParticleNorms CudaRubbingStep::contact_force() {
  bodies_.find_rubs(rubbing_start());
  queue_system();
  bodies_.take_steps(h_);
  const RubbingNorms largest = largest_norms();
  force_scale_ = largest.force, largest_stiffening_ = largest.stiffening, sharpness_ = largest.sharpness;
  scaled_residual_ = scaled_residual(largest);
  if (search_.is_open()) search_.look(scaled_residual_);
  return {scaled_residual_, largest.correction_bound, search_.overshoots()};
}

GlobalId CudaRubbingStep::worst_particle() {
  Real* largest = items_.results.at(&Results::largest);
  max_over(items_.device(), items_.owned, TwistSizeItem{rubbing_.residual.data()}, largest);
  items_.lane.halo.max(items_.device(), largest, 1);
  const long long worst = items_.smallest_id(IsLargest{rubbing_.residual.data(), largest});
  return worst < kNoId ? worst : -1;
}

RubbingCorrectItem CudaRubbingStep::correct_item(Real share) {
  return {items_.now.acceleration.data(),       items_.now.angular_acceleration.data(),
          rubbing_.correction.data(),           unit_,
          items_.now.position.data(),           share,
          newmark_position_gain(items_.hht, h_)};
}

void CudaRubbingStep::shorten_correction() {
  max_over(items_.device(), items_.owned, correct_item(search_.shorten()),
           items_.results.at(&Results::largest));
  turn_particles();
}

// With lagged limits no stiffness grows.
bool CudaRubbingStep::is_consistent() const { return !frozen_ && ::scree::is_consistent(sharpness_); }

// Prepares the residual for the solve and returns its largest component [N]. The bodies have applied their
// correction already: see `CudaImplicitStep`.
Real CudaRubbingStep::right_hand_side() {
  if (!bodies_.have_surfaces()) return scaled_residual_ * force_scale_;
  for_each(items_.device(), items_.owned,
           RubbingShiftItem{matrix(), items_.surfaces.list().offsets, items_.surfaces.list().surfaces,
                            items_.surfaces.numbers(), items_.surfaces.rubs(), newton_weights(),
                            is_consistent(), bodies_.upload_moves(), rubbing_.residual.data()});
  max_over(items_.device(), items_.owned, TwistSizeItem{rubbing_.residual.data()},
           items_.results.at(&Results::largest));
  const Real largest = items_.ranks.max(items_.results.fetch(&Results::largest));
  if (!std::isfinite(largest)) report_not_finite();
  return largest;
}

int CudaRubbingStep::solve(Real tolerance) {
  DeviceHalo& halo = items_.lane.halo;
  Twist* residual = rubbing_.residual.data();
  Twistf* correction = rubbing_.correction.data();
  const auto direction = [&](const ChebyshevWeights& weights) {
    return TwistDirectionItem{
        {rubbing_.inverse_block.data()}, residual, weights.from_last, weights.from_residual / unit_};
  };
  const auto twist = [&](int k) { return rubbing_.direction[k % 2].data(); };
  const auto begin = [&](const ChebyshevWeights& weights) {
    for_each(items_.device(), items_.owned, FirstTwistItem{direction(weights), twist(0), correction});
  };
  const auto ghosts = [&](Device on, int product) {
    const TwistGhostItem item{halo.ghosts(), halo.field(0, twist(product), items_.owned)};
    for_each(on, halo.entries(), item);
    halo.exchange(on, item.twist);
  };
  const auto item = [&](int product, const ChebyshevWeights& weights) {
    return RubbingSolverItem{{matrix(), items_.list.rows(), items_.surfaces.list().offsets,
                              rubbing_.mass.data(), is_consistent(), twist(product), unit_, residual},
                             direction(weights),
                             twist(product + 1),
                             correction};
  };
  return solve_on_device(items_, arrays_.solver, largest_stiffening_, tolerance, begin, ghosts, item);
}

ParticleCorrection CudaRubbingStep::particle_correct() {
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
  turn_particles();
  if (largest > 0) out.correction = items_.ranks.max(items_.results.fetch(&Results::largest));
  return out;
}

void CudaRubbingStep::freeze_limits() {
  const auto clear = [&](DeviceArray<Real>& limits, std::int64_t n) {  // all bits set, a NaN: no contact
    limits.resize(static_cast<std::size_t>(n));
    const std::size_t bytes = static_cast<std::size_t>(n) * sizeof(Real);
    if (n > 0) require_cuda(cudaMemsetAsync(limits.data(), 0xff, bytes, items_.stream), "cudaMemsetAsync");
  };
  clear(rubbing_.neighbor_limits, items_.list.entries());
  clear(rubbing_.surface_limits, items_.surfaces.entries());
  const FrozenLimits to{rubbing_.neighbor_limits.data(), rubbing_.surface_limits.data()};
  if (ghosts_stale_) {  // on the halo stream, as in a pass over the rows
    items_.halo_after_rows();
    items_.queue_beside_halo([&](Device on) { refresh_ghosts(on); }, [](Device, Index, Index) {}, nullptr);
    items_.rows_after_halo();
    ghosts_stale_ = false;
  }
  items_.kernels->freeze(items_.device(), items_.views(), items_.owned, rubbing_start(), to);
  frozen_ = true, search_ = {};
}

Real CudaRubbingStep::error() {
  max_over(items_.device(), items_.owned, TurningErrorItem{step_views(), turning_views()},
           items_.results.at(&Results::largest));
  return items_.ranks.max(items_.results.fetch(&Results::largest));
}

void CudaRubbingStep::accept() {
  ParticleArrays& now = items_.now;
  bodies_.find_rubs(rubbing_start());
  items_.kernels->rubbing_books(
      items_.device(), items_.views(), items_.owned, rubbing_start(),
      {now.contact_loss.data(), now.integrator_loss.data(), now.friction_loss.data()});
  items_.surfaces.book_rubs(items_.device(), *items_.kernels);
  items_.history.accepted();
  for_each(items_.device(), items_.owned,
           BalanceItem{step_views(), turning_views(), step_forces(), step_torques()});
  for_each(items_.device(), items_.owned,
           AcceptItem{step_views(), step_forces(), now.force.data(), now.integrator_loss.data()});
  for_each(items_.device(), items_.owned,
           AcceptTurnItem{step_views(), turning_views(), step_torques(), now.orientation.data(),
                          now.integrator_loss.data()});
  bodies_.take_steps(h_);
  bodies_.side().book_step();
}

}  // namespace scree
