// The bodies beside the particles on the GPU: their surfaces' places and contacts. Few, they are the host's
// (SurfaceSide); the device gets their places, and what their contacts sum to goes to pinned memory, which
// the host awaits.
#pragma once

#include <vector>

#include "cuda_items.cuh"
#include "dem/host/surface_side.hpp"

namespace scree {

class CudaBodies {
 public:
  explicit CudaBodies(CudaItems& items) : items_(items), side_(items.model, items.subdomain, items.ranks) {}

  SurfaceSide& side() { return side_; }
  const SurfaceSide& side() const { return side_; }
  bool have_surfaces() const { return side_.size() > 0; }
  const Stream& stream() const { return stream_; }  // for what goes on beside the particles

  // Brings the surfaces, as they are placed on the host, to the device.
  void put();
  SurfaceMoves upload_moves();  // by the last placement, on the device

  // Contacts with the state now: what forces and reports read, and the side's sums. Waits.
  void find_loads();
  // Queued, of these: what is shown of them, per entry.
  const ShownContact* find_shown();
  // Over an implicit step: queued, what the particles' system reads; then the side's sums; waits.
  void find_steps(const StepStart& start);
  void find_rubs(const RubbingStart& start);  // where contacts rub
  void take_steps(Real h);

  // Beside an explicit step, behind `ready`: places the surfaces, and queues the contacts with the particles
  // as `look` has them. The step's kernel reads them, behind loads_found(); take_loads() waits for
  // their sums.
  void queue_loads(const SurfaceLook& look, const Event& ready);
  const Event& loads_found() const { return loads_found_; }
  void take_loads(Real h);
  // Where the host knows that this step is closed, and its length h: books what its contacts have lost at
  // triangles.
  void book_loads(Real h);
  // The same where the step's kernel may still read its own. Waits.
  void find_loads_beside(const SurfaceLook& look);
  void reduce_wrench(std::vector<BodyWrench>& end) const { side_.reduce(end); }

 private:
  CudaItems& items_;
  SurfaceSide side_;
  Stream stream_{Priority::urgent};
  Event loads_found_, booked_;
  DeviceArray<Vec3> step_, step_turn_;
};

}  // namespace scree
