// Bodies with surfaces beside particles on the GPU. The bodies are few and stay on the host (`HostSurfaces`):
// the device gets the poses of their surfaces, and writes the sums of their contacts to pinned memory, for
// which the host waits.
#pragma once

#include <functional>
#include <vector>

#include "cuda_items.cuh"
#include "dem/host/host_surfaces.hpp"

namespace scree {

class CudaBodies {
 public:
  explicit CudaBodies(CudaItems& items) : items_(items), side_(items.model, items.subdomain, items.ranks) {}

  HostSurfaces& side() { return side_; }
  const HostSurfaces& side() const { return side_; }
  bool have_surfaces() const { return side_.size() > 0; }
  const Stream& stream() const { return stream_; }  // stream of its own, concurrent with the particles'

  // Copies the poses of the surfaces from the host to the device.
  void put();
  SurfaceMoves upload_moves();  // on the device, from the last copy

  // Contacts in the present state, which forces and reports read, and their sums on the host. Waits.
  void find_loads();
  // Queues the output values of these contacts, per entry.
  const ShownContact* find_shown();
  // Over an implicit step: queues the contacts, which the particles' system reads; then takes their sums on
  // the host, and waits.
  void find_steps(const FrictionStart& start);
  void take_steps(Real h);

  // Queues the poses of the surfaces and the contacts of particles in the state of `query`, in the order of
  // the particles' stream. take_loads() waits for their sums, and with them for the report. Nothing is queued
  // or reported where no particle of this rank is near a surface.
  void queue_loads(const SurfaceQuery& query, const ControlReport& report);
  // The same on a stream of their own, after `ready`. The kernel of the step reads them after loads_found().
  void queue_loads_after(const Event& ready, const SurfaceQuery& query, const ControlReport& report);
  const Event& loads_found() const { return loads_found_; }
  void take_loads(Real h);
  // Once the host knows that this step of length h is closed: accumulates the losses of its contacts at
  // triangles.
  void accumulate_load_works(Real h);
  // The same as queue_loads() concurrently, while the step's kernel may still read its own loads. Waits;
  // before that calls `meanwhile`.
  void find_loads_concurrently(const SurfaceQuery& query, const std::function<void()>& meanwhile);
  void reduce_wrench(std::vector<BodyWrench>& end) const { side_.reduce(end); }

 private:
  void send_and_find(cudaStream_t on, DeviceSurfaces::Loads which, const SurfaceQuery& query,
                     const ControlReport& report);

  CudaItems& items_;
  HostSurfaces side_;
  Stream stream_{Priority::urgent};
  cudaStream_t loads_on_ = nullptr;  // stream of the last loads
  Event loads_found_, works_accumulated_;
  DeviceArray<Vec3> step_, step_rotation_;
};

}  // namespace scree
