// The implicit step of the GPU's backend: the schedule of src/dem/cpu_implicit.cpp and block_solver.cpp.
#include <cmath>

#include "backend_parts.cuh"
#include "dem/block_solver.hpp"

namespace scree {

StepViews CudaBackend::step_views() {
  return {now_.position.data(),
          now_.velocity.data(),
          now_.acceleration.data(),
          other_.position.data(),
          other_.velocity.data(),
          other_.acceleration.data(),
          now_.force.data(),
          hht_,
          h_,
          subdomain_.snap_constant()};
}

StepForces CudaBackend::step_forces() {
  return {step_force_.data(), end_force_.data(), force_magnitude_.data()};
}

StepStart CudaBackend::step_start() const {
  return {other_.position.data(), other_.velocity.data(), h_, model_.integrator.resolve_events};
}

ContactMatrix CudaBackend::matrix() {
  return {matrix_count_.data(), matrix_entries_.data(), matrix_diagonal_.data()};
}

void CudaBackend::size_step_arrays() {
  const auto owned = static_cast<std::size_t>(owned_), slots = static_cast<std::size_t>(list_.slots());
  matrix_entries_.resize(slots);
  for (DeviceArray<Vec4>& direction : direction_) direction.resize(static_cast<std::size_t>(layout_.items));
  step_force_.resize(owned), end_force_.resize(owned), force_magnitude_.resize(owned),
      stiffening_.resize(owned), matrix_count_.resize(owned);
  residual_.resize(owned), right_hand_side_.resize(owned), correction_.resize(owned);
  matrix_diagonal_.resize(owned), inverse_block_.resize(owned);
}

namespace {

// Smallest id of the particles of which `is` holds; *id starts from kNoId.
template <class Is>
struct SmallestIdItem {
  const std::int64_t* row_key;
  Is is;
  long long* id;
  __device__ void operator()(Index i) const {
    if (is(i)) atomicMin(id, static_cast<long long>(id_of(row_key[i])));
  }
};

struct IsNotFinite {
  const Vec3* force;
  __device__ bool operator()(Index i) const { return !is_finite(force[i]); }
};

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

// One step of the solve: takes the direction d into the solution and the residual, and finds the next
// direction.
struct SolverItem {
  SubtractMatrixItem<SlicedRows> subtract;
  DirectionItem direction;  // weights of the next one
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

__device__ void decide(SolverControl* c) {
  c->stop = std::sqrt(c->largest) <= c->tolerance;
  c->largest = 0;
  ++c->products;
}

__global__ void decide_kernel(SolverControl* c) {
  if (!c->stop) decide(c);
}

// For the particles [first, end).
__global__ void solver_kernel(Index first, Index end, const __grid_constant__ SolverItem item,
                              SolverControl* c) {
  if (c->stop) return;
  const Index i = first + thread_index();
  block_max(i < end ? item(i) : 0, &c->largest);
  if (threadIdx.x > 0) return;
  if (c->alone && is_last_block(&c->finished_blocks, gridDim.x)) decide(c);
}

}  // namespace

void CudaBackend::report_not_finite(const Vec3* force) const {
  require_cuda(cudaMemsetAsync(result(&Results::worst_id), 0x7f, sizeof(long long), stream_),
               "cudaMemsetAsync");
  for_each(device(), owned_,
           SmallestIdItem<IsNotFinite>{now_.row_key.data(), {force}, result(&Results::worst_id)});
  if (const long long id = smallest_id(); id < kNoId)
    throw SimulationError("stage contact_force: the force on particle " + std::to_string(id) +
                          " is not finite");
}

GlobalId CudaBackend::worst_particle() {
  max_over(device(), owned_, NormItem{residual_.data()}, result(&Results::largest));
  halo_.max(device(), result(&Results::largest), 1);
  require_cuda(cudaMemsetAsync(result(&Results::worst_id), 0x7f, sizeof(long long), stream_),
               "cudaMemsetAsync");
  for_each(
      device(), owned_,
      SmallestIdItem<IsLargest>{
          now_.row_key.data(), {residual_.data(), result(&Results::largest)}, result(&Results::worst_id)});
  const long long worst = smallest_id();
  return worst < kNoId ? worst : -1;
}

void CudaBackend::initial_forces() {
  refresh_ghosts(now_.position.data(), now_.velocity.data());
  kernels_->forces(device(), views(), model_.gravity, owned_, now_.force.data(), now_.loss_power.data());
  for_each(device(), owned_,
           StartAccelerationItem{now_.force.data(), now_.velocity.data(), now_.acceleration.data()});
  find_shape_contacts();
  if (is_verlet(model_))
    side_.book_losses(0);
  else
    now_.loss_power.zero(stream_);
}

void CudaBackend::begin_step(Real h) {
  h_ = h;
  line_search_ = {};
  in_implicit_step_ = true;
  const auto n = static_cast<std::size_t>(owned_), shapes = static_cast<std::size_t>(shape_items());
  std::swap(now_.position, other_.position), std::swap(now_.velocity, other_.velocity);
  copy_async(other_.acceleration.data(), now_.acceleration.data(), n, stream_);
  copy_async(now_.position.data() + layout_.first_shape, other_.position.data() + layout_.first_shape, shapes,
             stream_);
  copy_async(now_.velocity.data() + layout_.first_shape, other_.velocity.data() + layout_.first_shape, shapes,
             stream_);
  for_each(device(), owned_, NewmarkItem{step_views()});
  ghosts_stale_ = true;
}

void CudaBackend::rollback() {
  if (!in_implicit_step_) return;
  std::swap(now_.position, other_.position), std::swap(now_.velocity, other_.velocity);
  copy_async(now_.acceleration.data(), other_.acceleration.data(), static_cast<std::size_t>(owned_), stream_);
  refresh_ghosts(now_.position.data(), now_.velocity.data());
  in_implicit_step_ = ghosts_stale_ = false;
}

Real CudaBackend::step_displacement() {
  const DisplacementItem moved{other_.position.data(), now_.position.data()};
  const DisplacementItem shapes{moved.from + layout_.first_shape, moved.to + layout_.first_shape};
  max_over(device(), layout_.active, moved, result(&Results::largest));
  max_over(device(), shape_items(), shapes, result(&Results::displacement));
  const Real particles = fetch(&Results::largest);
  return std::sqrt(ranks_.max(std::max(particles, fetch(&Results::displacement))));
}

ParticleNorms CudaBackend::contact_force() {
  SystemRequest r;
  r.in = views(), r.gravity = model_.gravity;
  r.weights = {newmark_position_gain(hht_, h_), newmark_velocity_gain(hht_, h_)};
  r.start = step_start();
  r.forces = step_forces(), r.matrix = matrix(), r.step = step_views();
  r.residual = residual_.data(), r.stiffening = stiffening_.data(), r.inverse_block = inverse_block_.data();
  r.largest = result(&Results::norms);
  require_cuda(cudaMemsetAsync(r.largest, 0, sizeof(StepNorms), stream_), "cudaMemsetAsync");
  const auto queue_rows = [&](Device on, Index first, Index end) {
    r.first = first, r.end = end;
    kernels_->system(on, r);
  };
  const auto queue_ghosts = [&](Device on) {
    halo_.update_motion(on, now_.position.data(), now_.velocity.data(), owned_);
  };
  if (ghosts_stale_) {
    halo_after_rows();
    queue_beside_halo(queue_ghosts, queue_rows, &halo_clock_);
    rows_after_halo();
    ghosts_stale_ = false;
  } else {
    queue_rows(device(), 0, owned_);
  }
  if (shape_items() > 0) {
    kernels_->shapes(device(), views(), shape_items(), r.start, h_shape_contacts_.data());
    fetch_shape_contacts(ContactSpan::step, stream_);
  }
  if (line_search_.is_open()) queue_sums(SlopeItem{residual_.data(), correction_.data()}, &Results::slope);
  copy_async(&h_results_.data()->slope, result(&Results::slope), 1, stream_);
  StepNorms largest = fetch(&Results::norms);
  halo_clock_.read(balance_.halo);
  Real maxima[4] = {largest.residual, largest.correction_bound, largest.force, largest.stiffening};
  ranks_.max(maxima);
  largest.residual = maxima[0], largest.correction_bound = maxima[1];
  largest.force = maxima[2], largest.stiffening = maxima[3];
  if (!std::isfinite(largest.residual)) report_not_finite(residual_.data());

  force_scale_ = largest.force, largest_stiffening_ = largest.stiffening;
  right_hand_side_norm_ = largest.residual;
  if (line_search_.is_open()) line_search_.look(totals(h_results_[0].slope)[0]);
  return {scaled_residual(largest), largest.correction_bound, line_search_.overshoots()};
}

CorrectItem CudaBackend::correct_item(Real share) {
  return {now_.acceleration.data(), correction_.data(), now_.position.data(), share,
          newmark_position_gain(hht_, h_)};
}

void CudaBackend::shorten_correction() {
  max_over(device(), owned_, correct_item(line_search_.shorten()), result(&Results::largest));
  for_each(device(), owned_, NewmarkItem{step_views()});
  ghosts_stale_ = true;
}

// The bodies have already taken their correction: as a known part of the solution it moves to the right.
void CudaBackend::subtract_shape_steps(SubtractMatrixItem<SlicedRows> matrix) {
  const auto n = static_cast<std::size_t>(shape_items());
  if (n == 0) return;
  shape_step_.upload(side_.step(), stream_);
  for_each(device(), layout_.items,
           ShapeDirectionItem{shape_step_.data(), newmark_position_gain(hht_, h_), layout_.first_shape,
                              direction_[0].data()});
  matrix.d = direction_[0].data();
  for_each(device(), owned_, matrix);
  max_over(device(), owned_, NormItem{residual_.data()}, result(&Results::largest));
  right_hand_side_norm_ = ranks_.max(fetch(&Results::largest));
  // Without a correction the bodies alone would notice.
  if (!std::isfinite(right_hand_side_norm_)) report_not_finite(residual_.data());
}

// Solves for correction_ in batches of products, so that the host seldom waits; returns the number of
// products.
int CudaBackend::solve(const SubtractMatrixItem<SlicedRows>& matrix, Real tolerance) {
  constexpr int kBatch = 8;
  h_solver_[0] = {tolerance, 0, 0, 0, 0, ranks_.alone()};
  copy_async(solver_.data(), h_solver_.data(), 1, stream_);
  // Ghosts are refreshed, shapes do not move.
  const std::size_t shapes = static_cast<std::size_t>(shape_items()) * sizeof(Vec4);
  for (DeviceArray<Vec4>& direction : direction_)
    if (shapes > 0)
      require_cuda(cudaMemsetAsync(direction.data() + layout_.first_shape, 0, shapes, stream_),
                   "cudaMemsetAsync");
  ChebyshevWeights weights = solver_weights(largest_stiffening_);
  const auto direction = [&] {
    return DirectionItem{inverse_block_.data(), residual_.data(), weights.from_last, weights.from_residual};
  };
  for_each(device(), owned_, FirstDirectionItem{direction(), direction_[0].data(), correction_.data()});
  halo_after_rows();
  for (int product = 0; product < kMostProducts; ++product) {
    DeviceArray<Vec4>&d = direction_[product % 2], &next = direction_[1 - product % 2];
    const DirectionGhostItem ghosts{halo_.ghosts(), halo_.field(0, d.data(), owned_)};
    weights.advance();
    SolverItem item{matrix, direction(), next.data(), correction_.data()};
    item.subtract.d = d.data(), item.subtract.residual = residual_.data();
    const auto queue_ghosts = [&](Device on) {
      for_each(on, halo_.entries(), ghosts);
      halo_.exchange(on, ghosts.direction);
    };
    const auto queue_rows = [&](Device on, Index first, Index end) {
      const unsigned blocks = std::max(1u, blocks_for(end - first));
      solver_kernel<<<blocks, launches().block, 0, on.stream>>>(first, end, item, solver_.data());
    };
    queue_beside_halo(queue_ghosts, queue_rows, nullptr);
    if (!ranks_.alone()) {
      halo_.max({halo_stream_}, &solver_.data()->largest, 1);
      decide_kernel<<<1, 1, 0, halo_stream_>>>(solver_.data());
      rows_after_halo();
    }
    require_cuda(cudaGetLastError(), "linear solve");
    if (product % kBatch != kBatch - 1) continue;
    copy_async(h_solver_.data(), solver_.data(), 1, stream_);
    if (idle_work_) idle_work_();
    wait_for(stream_);
    if (h_solver_[0].stop) break;
  }
  return h_solver_[0].products;
}

ParticleCorrection CudaBackend::particle_correct() {
  const SubtractMatrixItem<SlicedRows> system{
      matrix(), list_.rows(), now_.velocity.data(), hht_inertia_weight(hht_), nullptr, residual_.data()};
  subtract_shape_steps(system);
  const Real right_hand_side = right_hand_side_norm_;
  ParticleCorrection out;
  line_search_ = {};
  if (right_hand_side > 0) {
    copy_async(right_hand_side_.data(), residual_.data(), static_cast<std::size_t>(owned_), stream_);
    out.iterations =
        solve(system, solver_tolerance(model_.integrator.residual_tolerance, force_scale_, right_hand_side));
    max_over(device(), owned_, correct_item(1), result(&Results::largest));
    queue_sums(SlopeItem{right_hand_side_.data(), correction_.data()}, &Results::slope);
  }
  for_each(device(), owned_, NewmarkItem{step_views()});
  ghosts_stale_ = true;
  if (right_hand_side > 0) {
    copy_async(&h_results_.data()->largest, result(&Results::largest), 1, stream_);
    line_search_.open(totals(fetch(&Results::slope))[0]);
    out.correction = ranks_.max(h_results_[0].largest);
  }
  return out;
}

Real CudaBackend::error() {
  max_over(device(), owned_, StepErrorItem{step_views()}, result(&Results::largest));
  return ranks_.max(fetch(&Results::largest));
}

void CudaBackend::accept() {
  kernels_->books(device(), views(), owned_, step_start(), now_.contact_loss.data(),
                  now_.integrator_loss.data());
  for_each(device(), owned_,
           AcceptItem{step_views(), step_forces(), now_.force.data(), now_.integrator_loss.data()});
  if (const auto shapes = static_cast<std::size_t>(shape_items()); shapes > 0) {
    kernels_->shape_books(device(), views(), shape_items(), step_start(), h_shape_books_.data());
    wait_for(stream_);
    side_.book_step({h_shape_books_.data(), shapes});
  }
  in_implicit_step_ = false;
}

}  // namespace scree
