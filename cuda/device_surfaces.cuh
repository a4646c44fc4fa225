// Contacts of a rank's particles with surfaces on the device: who is near which, what they do to each other,
// and what those on bodies sum to.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "brick_grid.cuh"
#include "cell_sort.cuh"
#include "contact_kernels.cuh"
#include "dem/surfaces/surface_sums.hpp"
#include "dem/surfaces/surfaces.hpp"
#include "dem/surfaces/triangle_sums.hpp"
#include "device.cuh"
#include "device_meshes.cuh"
#include "device_triangle_works.cuh"

namespace scree {

// Which surfaces are in the particles' rows.
struct SurfaceList {
  const Index *offsets, *surfaces;  // [particles + 1], [entries]
  const std::int8_t* images;        // [entries]
  const PlacedSurface* placed;      // where they are now
  const SurfaceFrame* frames;
  const MeshView* meshes;
  SurfaceNumbers numbers;
};

class DeviceSurfaces {
 public:
  // Where the search finds the particles, in the order of their cells.
  struct Particles {
    const Vec4* position;  // x, y, z, radius
    const int* material;
    Index owned, active;
    const BrickGrid* grid;
    const Index* starts;  // [cells + 1] into the active ones
    Real largest_radius;  // [m]
    Index* numbers;       // room for one per owned particle
    RememberedRows remembered;
  };

  // period: of the space [m].
  DeviceSurfaces(const Model& model, Vec3 period, cudaStream_t stream);

  // Fills the rows. places: of the surfaces now. Waits for the device.
  void build(Device device, const Particles& particles, const SurfacePlaces& places, Real skin);
  bool any_placed() const { return placed_count_ > 0; }
  bool any_at_rest() const { return any_placed() && at_rest_; }  // SurfaceSet::at_rest()
  Index entries() const { return entries_; }
  SurfaceNumbers numbers() const { return {planes_.data(), ground_}; }
  SurfaceList list() const {
    return {offsets_.data(), surfaces_.data(),      images_.data(), places_.data(),
            frames_.data(),  meshes_.rows().meshes, numbers()};
  }

  // Which of the two sets of loads: those of the step, which the particles read, or of another look at the
  // bodies.
  enum class Loads { of_step, of_look };
  // Queues the copy of the surfaces' new places, which no longer change once it is done.
  void place(Device device, const SurfacePlaces& places);
  void keep_start(Device device);  // of an implicit step
  // Queues the contacts with the surfaces on bodies, placed as they are, of particles as `look` has them;
  // their sums are on the way to the host, too.
  void find_loads(Device device, const DeviceContactKernels& kernels, Loads which, const SurfaceLook& look);
  // Of surfaces at rest, for a run of explicit steps of length h: the loads of whatever step is open when the
  // kernels run, with the books at triangles. key: all that their launches depend on.
  void make_room_in_run(Device device, Index steps);  // before so many of them are queued
  void find_loads_in_run(Device device, const DeviceContactKernels& kernels, const OpenStepLook& look,
                         Real h);
  std::string key_of_loads(const DeviceContactKernels& kernels, const OpenStepLook& look, Real h) const;
  // Over an implicit step; `look`: at its end, with what contacts will remember if it is accepted.
  void find_steps(Device device, const DeviceContactKernels& kernels, const StepStart& start,
                  const SurfaceLook& look);
  // The same where contacts rub.
  void find_rubs(Device device, const DeviceContactKernels& kernels, const RubbingStart& start,
                 const SurfaceLook& look);
  // Queues what is shown of the contacts, per entry, of the loads of the step, which were found at an instant
  // with the particles as `look` has them.
  const ShownContact* find_shown(Device device, const DeviceContactKernels& kernels, const SurfaceLook& look);
  // Queues the books at the triangles of a step that is closed, of the contacts found last: of the loads of
  // the explicit step of length h, or over the implicit one.
  void book_loads(Device device, const DeviceContactKernels& kernels, Real h);
  void book_steps(Device device, const DeviceContactKernels& kernels);
  void book_rubs(Device device, const DeviceContactKernels& kernels);
  DeviceTriangleWorks& works() { return works_; }
  const SurfaceRub* rubs() const { return rubs_.data(); }  // per entry, of the last find_rubs()
  // The sums of the last contacts found, once the stream is done: a surface may come in several parts.
  std::vector<InstantSums> load_sums() const;
  std::vector<StepSums> step_sums() const;
  // Of the loads of the step, what they do to the triangles of meshes. For snapshots: all contacts are
  // brought to the host. planes: there. Waits.
  std::vector<TriangleSums> triangle_sums(Device device, std::span<const WallPlane> planes) const;

  // For the items' views: everything of them but particles and rows.
  template <class Rows>
  ContactViews<Rows> views(const Vec4* position, const Vec4* velocity, const int* material,
                           const Rows& rows) const {
    return {position,         velocity,  material,         rows,         offsets_.data(),
            surfaces_.data(), numbers(), loads_[0].data(), steps_.data()};
  }

 private:
  void find_entries(Device device, const Particles& particles, const SurfacePlaces& places, Real skin);
  void group_by_surface(Device device);
  SurfaceChunks chunk_list() const { return {chunks_.data(), static_cast<Index>(h_chunks_.size())}; }
  SurfaceViews entry_views(const DeviceContactKernels& kernels, const SurfaceLook& look) const;

  PeriodicBox box_;
  Real reach_;  // Contact::reach [m]
  DeviceArray<WallPlane> planes_;
  Index ground_, placed_count_;
  bool at_rest_;
  std::vector<Index> placed_planes_, plane_numbers_;  // among the placed surfaces
  DeviceMeshes meshes_;
  DeviceTriangleWorks works_;
  bool moves_;  // whether particles rotate
  Index entries_ = 0, placed_entries_ = 0;
  DeviceArray<Index> offsets_, surfaces_, particles_;
  DeviceArray<std::int8_t> images_;
  DeviceArray<unsigned char> space_;  // of library calls
  CellSort by_surface_;
  std::vector<SurfaceChunk> h_chunks_;
  DeviceArray<SurfaceChunk> chunks_;
  const int* material_ = nullptr;
  PinnedArray<PlacedSurface> h_placed_;
  PinnedArray<SurfaceFrame> h_frames_;
  Event placed_;
  DeviceArray<PlacedSurface> places_, start_places_;
  DeviceArray<SurfaceFrame> frames_;
  DeviceArray<SurfaceLoad> loads_[2];
  DeviceArray<SurfaceStep> steps_;
  DeviceArray<ShownContact> shown_;  // empty unless it was asked for
  DeviceArray<SurfaceRub> rubs_;     // empty unless contacts rub in implicit steps
  // Written by the device, of chunks with contacts but for their number.
  PinnedArray<InstantSums> h_load_sums_;
  PinnedArray<StepSums> h_step_sums_;
  PinnedArray<Index> h_index_;
};

}  // namespace scree
