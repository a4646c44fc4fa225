// The schedule of the linear solves of implicit steps: `iterate_chebyshev` of dem/implicit/block_solver.hpp
// on the device.
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

// begin(weights) queues the first directions. For every product, ghosts(on, product) queues the ghosts of its
// directions, and item(product, weights), with the weights of the next directions, computes a particle's part
// and returns the square of its residual. Returns the number of products.
template <class Begin, class Ghosts, class MakeItem>
int solve_on_device(CudaItems& items, SolverProgress& progress, Real largest_stiffness_ratio, Real tolerance,
                    const Begin& begin, const Ghosts& ghosts, const MakeItem& item) {
  constexpr int kBatch = 8;
  SolverControl* control = progress.device.data();
  SolverControl& h_control = progress.host[0];
  h_control = {tolerance, 0, 0, 0, 0, items.ranks.alone()};
  copy_async(control, &h_control, 1, items.stream);
  ChebyshevWeights weights = solver_weights(largest_stiffness_ratio);
  begin(weights);
  items.halo_after_rows();
  for (int product = 0; product < kMostProducts; ++product) {
    weights.advance();
    const auto of_product = item(product, weights);
    using Item = std::remove_const_t<decltype(of_product)>;
    const auto queue_rows = [&](Device on, Index first, Index end) {
      const unsigned blocks = std::max(1u, blocks_for(end - first));
      solver_kernel<Item><<<blocks, launches().block, 0, on.stream>>>(first, end, of_product, control);
    };
    items.queue_overlapping_halo([&](Device on) { ghosts(on, product); }, queue_rows, nullptr);
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
