// The particles and ghosts of one rank on its GPU: what the objects of the backend share.
#pragma once

#include <functional>
#include <memory>

#include "contact_kernels.cuh"
#include "cuda_results.cuh"
#include "device_arena.cuh"
#include "device_halo.cuh"
#include "device_history.cuh"
#include "device_list.cuh"
#include "device_surfaces.cuh"
#include "for_each.cuh"
#include "model/data/model.hpp"
#include "particle_arrays.cuh"
#include "partition/decomposition.hpp"
#include "partition/subdomain.hpp"
#include "step_parts.cuh"

namespace scree {

class CudaExplicitRun;

// The halo exchange and the boundary rows on a stream of their own, concurrent with the interior rows. The
// host does not wait for boundary rows, but it does for the contacts of bodies, whose stream is urgent.
struct HaloStream {
  HaloStream(const Ranks& ranks, Transport transport) : halo(ranks, transport) {}

  DeviceHalo halo;
  Stream stream{Priority::high};
  HaloClock clock;
  Event rows_done, done;
};

struct CudaItems {
  // idle_work: as passed to the backend.
  CudaItems(const Model& of, const Ranks& on, const std::function<void()>& idle_work,
            std::unique_ptr<DeviceContactKernels> law);
  CudaItems(const CudaItems&) = delete;
  CudaItems& operator=(const CudaItems&) = delete;

  Device device() const { return {stream}; }
  DeviceViews views() { return views(now.position.data(), now.velocity.data(), now.angular_velocity.data()); }
  DeviceViews views(const Vec4* position, const Vec4* velocity, const Vec4* spin);
  // What `history` reads of the list, while there is one.
  DeviceHistory::Listed listed() const {
    return {now.position.data(), now.row_key.data(), owned, list, surfaces};
  }
  void idle() const {
    if (idle_work) idle_work();
  }
  // Moves particle order[i] to i for i = 0 ... n - 1; the others are removed.
  void reorder(const Index* order, Index n);
  // Scratch memory for one `Index` per particle while a list is built.
  Index* list_scratch() { return reinterpret_cast<Index*>(other.position.data()); }

  void refresh_ghosts(Device on) {
    update_halo(on, now.position.data(), now.velocity.data(), now.angular_velocity.data());
  }
  // spin: unused unless particles rotate.
  void update_halo(Device on, Vec4* position, Vec4* velocity, Vec4* spin) {
    halo_stream.halo.update_motion(on, position, velocity,
                                   model.rotates() ? std::optional(spin) : std::nullopt, owned);
  }
  void refresh_ghosts() { refresh_ghosts(device()); }
  // Orders the streams: what is queued on the halo stream after the fork waits for the rows queued so far,
  // and what is queued on the main stream after the join waits for the halo.
  void fork_halo_stream() {
    halo_stream.rows_done.record(stream), halo_stream.rows_done.hold(halo_stream.stream);
  }
  void join_halo_stream() { halo_stream.done.record(halo_stream.stream), halo_stream.done.hold(stream); }
  // The same for a halo exchange, for which a single rank does not use the second stream.
  void halo_after_rows();
  void rows_after_halo();
  template <class QueueGhosts, class QueueRows>
  void queue_overlapping_halo(const QueueGhosts& queue_ghosts, const QueueRows& queue_rows, HaloClock* clock);
  template <class QueueGhosts, class QueueInterior, class QueueBoundary>
  void queue_around_halo(const QueueGhosts& queue_ghosts, const QueueInterior& queue_interior,
                         const QueueBoundary& queue_boundary, HaloClock* clock);

  // Queues sums of terms over the particles; see `DeviceResults::totals`.
  template <int N, class Item>
  void queue_sums(const Item& item, ExactSums<N> Results::*sums);
  // Smallest id among the particles of all ranks for which `is` holds; `kNoId` if there is none.
  template <class Is>
  long long smallest_id(const Is& is);
  // Throws `SimulationError` naming the particle of smallest id, over all ranks, whose force is not finite.
  void report_not_finite(const Vec3* force);

  const Model& model;
  Ranks ranks;
  Subdomain subdomain;
  HhtCoefficients hht;
  const std::function<void()>& idle_work;
  Stream stream;  // main stream of the particles
  std::unique_ptr<DeviceContactKernels> kernels;
  DeviceSurfaces surfaces;

  // `now` holds the state, `other` the second arrays.
  ParticleArrays now;
  SecondArrays other;
  bool in_mixed = false;  // whether explicit runs are in mixed precision
  MixedArrays mixed;
  Index owned = 0;
  ItemLayout layout;   // its list of ghosts is empty
  Index interior = 0;  // number of leading particles, in whole thread blocks, that have no ghost neighbours
                       // and are no ghosts elsewhere
  StepParts parts;     // split of explicit steps
  HaloStream halo_stream;
  DeviceList list;
  // Arrays of explicit steps that depend on the list; while a list is built, scratch arrays.
  DeviceArena arena;
  DeviceHistory history;
  LoadBalance balance;
  DeviceResults results;
  DeviceArray<unsigned char> space;  // scratch of library calls

  // The explicit run with an open step, whose arrays may differ from those of `now`; null without one.
  CudaExplicitRun* open_run = nullptr;
  // Velocities at which the law was evaluated in the last explicit step, valid until the next list; null
  // where they are those of the state.
  const Vec4 *law_velocity = nullptr, *law_spin = nullptr;
};

template <class Is>
struct SmallestIdItem {
  const std::int64_t* row_key;
  Is is;
  long long* id;
  __device__ void operator()(Index i) const {
    if (is(i)) atomicMin(id, static_cast<long long>(id_of(row_key[i])));
  }
};

template <class Is>
long long CudaItems::smallest_id(const Is& is) {
  long long* id = results.clear_id();
  for_each(device(), owned, SmallestIdItem<Is>{now.row_key.data(), is, id});
  return results.smallest_id();
}

template <int N, class Item>
void CudaItems::queue_sums(const Item& item, ExactSums<N> Results::*sums) {
  exact_sums(device(), owned, item, results.at(sums),
             [&](Real* largest) { halo_stream.halo.max(device(), largest, N); });
}

// Queues a pass over the particles that reads their ghosts: queue_ghosts(device) the halo exchange,
// queue_rows(device, first, end) the kernel. With several ranks the interior, which has no ghost neighbours,
// is computed during the halo exchange, and the boundary as soon as the ghosts have arrived.
template <class QueueGhosts, class QueueRows>
void CudaItems::queue_overlapping_halo(const QueueGhosts& queue_ghosts, const QueueRows& queue_rows,
                                       HaloClock* clock) {
  if (ranks.alone()) {
    queue_ghosts(device());
    queue_rows(device(), 0, owned);
    return;
  }
  queue_around_halo(
      queue_ghosts,
      [&](Device on) {
        if (interior > 0) queue_rows(on, 0, interior);
      },
      [&](Device on) { queue_rows(on, interior, owned); }, clock);
}

// The same for several ranks, where queue_interior(device) queues the interior and queue_boundary(device) the
// boundary. At the call both streams are ordered after what the pass reads; afterwards the halo stream is
// ordered after the interior, so that the next halo exchange starts before the next rows fill the GPU. clock:
// measures the exchange, if not null.
template <class QueueGhosts, class QueueInterior, class QueueBoundary>
void CudaItems::queue_around_halo(const QueueGhosts& queue_ghosts, const QueueInterior& queue_interior,
                                  const QueueBoundary& queue_boundary, HaloClock* clock) {
  if (clock != nullptr) clock->begin(halo_stream.stream);
  queue_interior(device());
  if (clock != nullptr) clock->interior_done(stream);
  queue_ghosts({halo_stream.stream});
  if (clock != nullptr) clock->end(halo_stream.stream);
  queue_boundary({halo_stream.stream});
  fork_halo_stream();
}

}  // namespace scree
