// The loop of the linear solves of implicit steps on the device; dem/cpu/cpu_solver.hpp is the CPU's.
#pragma once

#include <algorithm>
#include <cmath>

#include "cuda_items.cuh"
#include "dem/implicit/block_solver.hpp"

namespace scree {

// Progress of a linear solve, written by the last block of each matrix-vector product.
struct SolverControl {
  Real tolerance;  // bound of the largest |residual| [N]
  Real largest;    // square of the largest |residual| of this product
  unsigned finished_blocks;
  int products;
  int stop;
  int alone;  // one rank: the last block decides; several ranks do so after a reduction
};

struct SolverProgress {
  DeviceArray<SolverControl> device{1};
  PinnedArray<SolverControl> host{1};
};

__device__ inline void decide(SolverControl* c) {
  c->stop = std::sqrt(c->largest) <= c->tolerance;
  c->largest = 0;
  ++c->products;
}

template <class Item>
__global__ void decide_kernel(SolverControl* c) {
  if (!c->stop) decide(c);
}

// One matrix-vector product, for the particles first ... end - 1. Registers are limited so that three of the
// largest blocks fit on a multiprocessor: the kernel hides latency with many threads.
template <class Item>
__global__ void __launch_bounds__(256, 3)
    solver_kernel(Index first, Index end, const __grid_constant__ Item item, SolverControl* c) {
  if (c->stop) return;
  const Index i = first + thread_index();
  block_max(i < end ? item(i) : 0, &c->largest);
  if (threadIdx.x > 0) return;
  if (c->alone && is_last_block(&c->finished_blocks, gridDim.x)) decide(c);
}

// of: the system, see `solve_on_host`; a product returns the square of a particle's residual. The products
// are queued in batches, so that the host seldom waits. Returns their number.
template <class System>
int solve_on_device(CudaItems& items, SolverProgress& progress, System& of, Real largest_stiffness_ratio,
                    Real tolerance) {
  constexpr int kBatch = 8;
  SolverControl* control = progress.device.data();
  SolverControl& h_control = progress.host[0];
  h_control = {tolerance, 0, 0, 0, 0, items.ranks.alone()};
  copy_async(control, &h_control, 1, items.stream);
  ChebyshevWeights weights = solver_weights(largest_stiffness_ratio);
  for_each(items.device(), items.owned, of.first(weights));
  items.halo_after_rows();
  for (int product = 0; product < kMostProducts; ++product) {
    weights.advance();
    const auto of_product = of.product(product, weights);
    using Item = std::remove_const_t<decltype(of_product)>;
    const auto queue_ghosts = [&](Device on) {
      items.halo_stream.halo.update(on, of.direction(product).data(), items.owned);
    };
    const auto queue_rows = [&](Device on, Index first, Index end) {
      const unsigned blocks = std::max(1u, blocks_for(end - first));
      solver_kernel<Item><<<blocks, launches().block, 0, on.stream>>>(first, end, of_product, control);
    };
    items.queue_overlapping_halo(queue_ghosts, queue_rows, nullptr);
    if (!items.ranks.alone()) {
      items.halo_stream.halo.max({items.halo_stream.stream}, &control->largest, 1);
      decide_kernel<Item><<<1, 1, 0, items.halo_stream.stream>>>(control);
      items.rows_after_halo();
    }
    require_cuda(cudaGetLastError(), "linear solve");
    if (product % kBatch != kBatch - 1) continue;
    copy_async(&h_control, control, 1, items.stream);
    items.idle();
    wait_for(items.stream);
    if (h_control.stop) break;
  }
  return h_control.products;
}

}  // namespace scree
