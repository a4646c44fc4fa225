#include <cmath>

#include "cuda_control.cuh"

namespace scree {
namespace {

// Opens the first step of a run.
struct RunStartItem {
  VerletStartItem start;
  Index active;
  OpenBox box;
  const std::uint8_t* drifting;
  VerletControl* control;

  __device__ Real operator()(Index i) const {
    const Real squared = start(i);
    if (!box.inside(xyz(start.state.position[i])) && !drifting[i]) control->outside = 1;
    return i < active ? squared : 0;
  }
};

// What the ranks reduce after opening the first step.
__global__ void started_kernel(VerletControl* c, const Real* largest) {
  c->shared[0] = *largest, c->shared[1] = c->outside;
}

__global__ void open_kernel(VerletControl* c) {
  c->outside = c->shared[1] != 0;
  c->move(std::sqrt(c->shared[0]));
  c->judge(c->outside != 0);
}

// Closes a step after the ranks have reduced what each found.
__global__ void close_kernel(VerletControl* c) {
  if (c->stop) return;
  c->outside = c->shared[1] != 0;
  c->close(c->shared[0]);
}

// Reduces what each rank found, and closes the step. In one launch of a warp, with a lane per rank. The
// largest displacement was rounded up to float by the last block of the step.
__global__ void close_with_peers_kernel(VerletControl* c, const __grid_constant__ PeerLinks peers) {
  if (c->stop) return;
  const unsigned largest_bits = __float_as_uint(static_cast<float>(c->shared[0]));
  const unsigned found = exchange_values(peers, largest_bits << 1 | (c->shared[1] != 0));
  // Without their sign the bits of floats are ordered as the numbers, and a NaN's exceed them all.
  const Real largest = __uint_as_float(__reduce_max_sync(~0u, found >> 1));
  const bool outside = __any_sync(~0u, found & 1) != 0;
  if (threadIdx.x > 0) return;
  c->outside = outside;
  c->close(largest);
}

// Continues after a stop: with another last step, or another list.
__global__ void resume_kernel(VerletControl* c, Index last, Real bound, Real half_skin, bool new_list,
                              int position_parity, int velocity_parity) {
  c->last = last, c->half_skin = half_skin;
  if (new_list) c->moved = VerletControl::kNoRows, c->choose_rows();
  c->bound = bound;
  c->parity[0] = position_parity, c->parity[1] = velocity_parity;
  c->judge(c->outside != 0);
}

}  // namespace

void RunControl::start(const VerletRequest& step) {
  VerletControl& c = items_.results.host().control;
  c = {};
  c.bound = list_.bound(), c.half_skin = list_.skin() / 2, c.moved = VerletControl::kNoRows;
  c.last = kEndless, c.substeps = items_.model.integrator.substeps, c.alone = items_.ranks.alone();
  copy_async(on_device(), &c, 1, items_.stream);
  known_list_ = list_.builds();
  items_.history.begin_run();
  h_ = step.state.h;
  list_.open_run(h_);
  VerletViews state = step.state;
  state.position = items_.now.position.data(), state.velocity = items_.now.velocity.data();
  Real* largest = items_.results.at(&Results::largest);
  max_over(items_.device(), items_.owned,
           RunStartItem{{state}, step.active, step.box, step.drifting, step.control}, largest);
  started_kernel<<<1, 1, 0, items_.stream>>>(on_device(), largest);
  items_.halo_stream.halo.max(items_.device(), on_device()->shared, 2);
  open_kernel<<<1, 1, 0, items_.stream>>>(on_device());
  require_cuda(cudaGetLastError(), "explicit step");
  wait_for(items_.stream);  // until the host's copy of the control block is free again
}

const VerletControl& RunControl::wait() {
  const VerletControl& c = items_.results.fetch(&Results::control);
  items_.halo_stream.clock.read(items_.balance.halo);
  parity_[0] = c.parity[0], parity_[1] = c.parity[1];
  items_.history.closed(c.closed), list_.follow(h_);
  list_.set_bound(c.bound);
  return c;
}

void RunControl::resume(Index last) {
  const bool new_list = known_list_ != list_.builds();
  resume_kernel<<<1, 1, 0, items_.stream>>>(on_device(), last, list_.bound(), list_.skin() / 2, new_list,
                                            parity_[0], parity_[1]);
  known_list_ = list_.builds();
  require_cuda(cudaGetLastError(), "explicit step");
}

void RunControl::close(Device on) {
  DeviceHalo& halo = items_.halo_stream.halo;
  if (const Peers* peers = halo.peers()) {
    close_with_peers_kernel<<<1, 32, 0, on.stream>>>(on_device(), peers->links());
    return;
  }
  halo.max(on, on_device()->shared, 2);
  close_kernel<<<1, 1, 0, on.stream>>>(on_device());
}

}  // namespace scree
