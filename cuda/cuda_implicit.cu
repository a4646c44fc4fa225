// The same schedule as src/dem/cpu/cpu_implicit.cpp and block_solver.cpp, with kernels.
#include <cmath>

#include "cuda_bodies.cuh"
#include "cuda_implicit.cuh"

namespace scree {
namespace {

struct IsLargest {
  const Vec3* residual;
  const Real* largest;
  __device__ bool operator()(Index i) const { return norm(residual[i]) == *largest; }
};

struct DirectionGhostItem {
  const Ghost* ghosts;
  GhostField<Vec4> direction;
  SCREE_HD void operator()(Index entry) const { direction.put(entry, direction.field[ghosts[entry].source]); }
};

struct FirstDirectionItem {
  DirectionItem direction;
  Vec4* d;
  Vec3* solution;
  SCREE_HD void operator()(Index i) const {
    d[i] = vec4(direction.next(i, {}), 0);
    solution[i] = {};
  }
};

// One step of the solve: adds the direction d to the solution, updates the residual, and computes the next
// direction.
struct SolverItem {
  SubtractMatrixItem<SlicedRows> subtract;
  DirectionItem direction;  // weights of the next direction
  Vec4* next;
  Vec3* solution;

  SCREE_HD Real operator()(Index i) const {
    const Vec3 d = xyz(subtract.d[i]);
    solution[i] += d;
    subtract(i);
    next[i] = vec4(direction.next(i, d), 0);
    return dot(subtract.residual[i], subtract.residual[i]);
  }
};

}  // namespace

void CudaImplicitArrays::resize(const CudaItems& items) {
  const auto owned = static_cast<std::size_t>(items.owned),
             slots = static_cast<std::size_t>(items.list.slots());
  step_force.resize(owned), end_force.resize(owned), force_magnitude.resize(owned);
  stiffness_ratio.resize(owned), matrix_count.resize(owned), residual.resize(owned);
  if (items.model.rotates()) return friction.resize(items);
  matrix_entries.resize(slots);
  for (DeviceArray<Vec4>& d : direction) d.resize(static_cast<std::size_t>(items.layout.items));
  right_hand_side.resize(owned), correction.resize(owned);
  matrix_diagonal.resize(owned), inverse_block.resize(owned);
}

// The state at the start of the step is kept by swapping the arrays.
CudaImplicitStep::CudaImplicitStep(CudaItems& items, CudaBodies& bodies, CudaImplicitArrays& arrays, Real h)
    : items_(items), bodies_(bodies), arrays_(arrays), h_(h) {
  std::swap(items.now.position, items.other.position), std::swap(items.now.velocity, items.other.velocity);
}

StepViews CudaImplicitStep::step_views() {
  ParticleArrays& now = items_.now;
  SecondArrays& start = items_.other;
  return {now.position.data(),
          now.velocity.data(),
          now.acceleration.data(),
          start.position.data(),
          start.velocity.data(),
          start.acceleration.data(),
          now.force.data(),
          items_.hht,
          h_,
          items_.subdomain.snap_constant()};
}

StepForces CudaImplicitStep::step_forces() {
  return {arrays_.step_force.data(), arrays_.end_force.data(), arrays_.force_magnitude.data()};
}

StepStart CudaImplicitStep::step_start() const {
  return {items_.other.position.data(), items_.other.velocity.data(), h_,
          items_.model.integrator.resolve_events};
}

NewtonWeights CudaImplicitStep::newton_weights() const {
  return {newmark_position_gain(items_.hht, h_), newmark_velocity_gain(items_.hht, h_)};
}

ContactMatrix CudaImplicitStep::matrix() {
  return {arrays_.matrix_count.data(), arrays_.matrix_entries.data(), arrays_.matrix_diagonal.data()};
}

void CudaImplicitStep::predict() {
  const auto n = static_cast<std::size_t>(items_.owned);
  ParticleArrays& now = items_.now;
  SecondArrays& start = items_.other;
  copy_async(start.acceleration.data(), now.acceleration.data(), n, items_.stream);
  bodies_.side().store_start(), items_.surfaces.store_start(items_.device());
  for_each(items_.device(), items_.owned, NewmarkItem{step_views()});
  ghosts_stale_ = true;
}

void CudaImplicitStep::undo() {
  ParticleArrays& now = items_.now;
  SecondArrays& start = items_.other;
  std::swap(now.position, start.position), std::swap(now.velocity, start.velocity);
  copy_async(now.acceleration.data(), start.acceleration.data(), static_cast<std::size_t>(items_.owned),
             items_.stream);
  items_.refresh_ghosts();
}

Real CudaImplicitStep::step_displacement() {
  DeviceResults& results = items_.results;
  const DisplacementItem moved{items_.other.position.data(), items_.now.position.data()};
  max_over(items_.device(), items_.layout.active, moved, results.at(&Results::largest));
  const Real particles = std::sqrt(results.fetch(&Results::largest));
  return items_.ranks.max(std::max(particles, bodies_.side().step_displacement()));
}

// Forces, Newton matrix and residual, after a refresh of the ghosts where the iterate has changed.
void CudaImplicitStep::queue_forces() {
  SystemRequest r;
  r.in = items_.views(), r.gravity = items_.model.gravity;
  r.weights = newton_weights();
  r.start = step_start();
  r.forces = step_forces(), r.matrix = matrix(), r.step = step_views();
  r.residual = arrays_.residual.data(), r.stiffness_ratio = arrays_.stiffness_ratio.data();
  r.inverse_block = arrays_.inverse_block.data();
  r.largest = items_.results.at(&Results::norms);
  require_cuda(cudaMemsetAsync(r.largest, 0, sizeof(StepNorms), items_.stream), "cudaMemsetAsync");
  const auto queue_rows = [&](Device on, Index first, Index end) {
    r.first = first, r.end = end;
    items_.kernels->system(on, r);
  };
  if (!ghosts_stale_) return queue_rows(items_.device(), 0, items_.owned);
  items_.halo_after_rows();
  items_.queue_overlapping_halo([&](Device on) { items_.refresh_ghosts(on); }, queue_rows,
                                &items_.halo_stream.clock);
  items_.rows_after_halo();
  ghosts_stale_ = false;
}

// Maxima over the particles of all ranks; waits. Throws through `report_not_finite` where a residual is not
// finite.
StepNorms CudaImplicitStep::largest_norms() {
  StepNorms largest = items_.results.fetch(&Results::norms);
  items_.halo_stream.clock.read(items_.balance.halo);
  Real maxima[4] = {largest.residual, largest.correction_bound, largest.force, largest.stiffness_ratio};
  items_.ranks.max(maxima);
  largest.residual = maxima[0], largest.correction_bound = maxima[1];
  largest.force = maxima[2], largest.stiffness_ratio = maxima[3];
  if (!std::isfinite(largest.residual)) items_.report_not_finite(arrays_.residual.data());
  return largest;
}

ParticleNorms CudaImplicitStep::contact_force() {
  bodies_.find_steps(step_start());
  queue_forces();
  bodies_.take_steps(h_);
  DeviceResults& results = items_.results;
  if (line_search_.is_open())
    items_.queue_sums(SlopeItem{arrays_.residual.data(), arrays_.correction.data()}, &Results::slope);
  results.copy(&Results::slope);
  const StepNorms largest = largest_norms();
  force_scale_ = largest.force, largest_stiffness_ratio_ = largest.stiffness_ratio;
  right_hand_side_norm_ = largest.residual;
  if (line_search_.is_open()) line_search_.update(results.totals(results.host().slope)[0]);
  return {scaled_residual(largest), largest.correction_bound, line_search_.overshoots()};
}

GlobalId CudaImplicitStep::worst_particle() {
  Real* largest = items_.results.at(&Results::largest);
  max_over(items_.device(), items_.owned, NormItem{arrays_.residual.data()}, largest);
  items_.halo_stream.halo.max(items_.device(), largest, 1);
  const long long worst = items_.smallest_id(IsLargest{arrays_.residual.data(), largest});
  return worst < kNoId ? worst : -1;
}

void CudaImplicitStep::reduce_wrench(ContactWrenches& step, std::vector<BodyWrench>& end) {
  bodies_.side().reduce(step, end);
}

CorrectItem CudaImplicitStep::correct_item(Real share) {
  return {items_.now.acceleration.data(), arrays_.correction.data(), items_.now.position.data(), share,
          newmark_position_gain(items_.hht, h_)};
}

void CudaImplicitStep::shorten_correction() {
  max_over(items_.device(), items_.owned, correct_item(line_search_.shorten()),
           items_.results.at(&Results::largest));
  for_each(items_.device(), items_.owned, NewmarkItem{step_views()});
  ghosts_stale_ = true;
}

// The bodies have applied their correction already: as a known part of the solution it moves to the
// right-hand side.
void CudaImplicitStep::subtract_surface_steps() {
  if (!bodies_.have_surfaces()) return;
  for_each(items_.device(), items_.owned,
           SurfaceShiftItem<SlicedRows>{items_.views(), newton_weights(), bodies_.upload_moves(),
                                        arrays_.residual.data()});
  max_over(items_.device(), items_.owned, NormItem{arrays_.residual.data()},
           items_.results.at(&Results::largest));
  right_hand_side_norm_ = items_.ranks.max(items_.results.fetch(&Results::largest));
  // Without a correction of the particles only the bodies have moved.
  if (!std::isfinite(right_hand_side_norm_)) items_.report_not_finite(arrays_.residual.data());
}

// Solves for the correction in batches of matrix-vector products, so that the host seldom waits; returns the
// number of products.
int CudaImplicitStep::solve(const SubtractMatrixItem<SlicedRows>& matrix, Real tolerance) {
  Vec3 *residual = arrays_.residual.data(), *correction = arrays_.correction.data();
  DeviceHalo& halo = items_.halo_stream.halo;
  const auto direction = [&](const ChebyshevWeights& weights) {
    return DirectionItem{arrays_.inverse_block.data(), residual, weights.from_last, weights.from_residual};
  };
  const auto begin = [&](const ChebyshevWeights& weights) {
    for_each(items_.device(), items_.owned,
             FirstDirectionItem{direction(weights), arrays_.direction[0].data(), correction});
  };
  const auto ghosts = [&](Device on, int product) {
    const DirectionGhostItem item{halo.ghosts(),
                                  halo.field(0, arrays_.direction[product % 2].data(), items_.owned)};
    for_each(on, halo.entries(), item);
    halo.exchange(on, item.direction);
  };
  const auto item = [&](int product, const ChebyshevWeights& weights) {
    SolverItem out{matrix, direction(weights), arrays_.direction[1 - product % 2].data(), correction};
    out.subtract.d = arrays_.direction[product % 2].data(), out.subtract.residual = residual;
    return out;
  };
  return solve_on_device(items_, arrays_.solver, largest_stiffness_ratio_, tolerance, begin, ghosts, item);
}

ParticleCorrection CudaImplicitStep::particle_correct() {
  Vec3 *residual = arrays_.residual.data(), *right_hand_side = arrays_.right_hand_side.data();
  DeviceResults& results = items_.results;
  const SubtractMatrixItem<SlicedRows> system{
      matrix(), items_.list.rows(), items_.now.velocity.data(), hht_inertia_weight(items_.hht), nullptr,
      residual};
  subtract_surface_steps();
  const Real norm = right_hand_side_norm_;
  ParticleCorrection out;
  line_search_ = {};
  if (norm > 0) {
    copy_async(right_hand_side, residual, static_cast<std::size_t>(items_.owned), items_.stream);
    out.iterations =
        solve(system, solver_tolerance(items_.model.integrator.residual_tolerance, force_scale_, norm));
    max_over(items_.device(), items_.owned, correct_item(1), results.at(&Results::largest));
    items_.queue_sums(SlopeItem{right_hand_side, arrays_.correction.data()}, &Results::slope);
  }
  for_each(items_.device(), items_.owned, NewmarkItem{step_views()});
  ghosts_stale_ = true;
  if (norm > 0) {
    results.copy(&Results::largest);
    line_search_.open(results.totals(results.fetch(&Results::slope))[0]);
    out.correction = items_.ranks.max(results.host().largest);
  }
  return out;
}

Real CudaImplicitStep::error() {
  max_over(items_.device(), items_.owned, StepErrorItem{step_views()}, items_.results.at(&Results::largest));
  return items_.ranks.max(items_.results.fetch(&Results::largest));
}

void CudaImplicitStep::accept() {
  ParticleArrays& now = items_.now;
  bodies_.find_steps(step_start());
  items_.kernels->step_losses(items_.device(), items_.views(), items_.owned, step_start(),
                              now.contact_loss.data(), now.integrator_loss.data());
  items_.surfaces.accumulate_step_works(items_.device(), *items_.kernels);
  items_.history.accepted();
  for_each(items_.device(), items_.owned,
           AcceptItem{step_views(), step_forces(), now.force.data(), now.integrator_loss.data()});
  bodies_.take_steps(h_);
  bodies_.side().book_step();
}

}  // namespace scree
