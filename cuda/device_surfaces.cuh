// Contacts of a rank's particles with surfaces on the device: neighbour rows, contacts, and the sums over
// those on bodies.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cell_block_grid.cuh"
#include "cell_sort.cuh"
#include "contact_kernels.cuh"
#include "dem/history/keyed_rows.hpp"
#include "dem/surfaces/surface_sums.hpp"
#include "dem/surfaces/surfaces.hpp"
#include "dem/surfaces/triangle_sums.hpp"
#include "device.cuh"
#include "device_meshes.cuh"
#include "device_poses.cuh"
#include "device_triangle_works.cuh"
#include "surface_load_sums.cuh"

namespace scree {

class DeviceSurfaces {
 public:
  // Where the search finds the particles, sorted by cell.
  struct Particles {
    const Vec4* position;  // x, y, z, radius
    const int* material;
    Index owned, active;
    const CellBlockGrid* grid;
    const Index* starts;  // [cells + 1] first active particle of each cell
    Real largest_radius;  // [m]
    Index* numbers;       // scratch for one value per owned particle
    StoredRows stored_contacts;
  };

  // period: of the domain [m].
  DeviceSurfaces(const Model& model, Vec3 period, cudaStream_t stream);

  // Fills the rows. poses: the present ones of the surfaces. Waits for the device. To be followed by
  // complete(), which waits, too: what is queued in between needs the rows alone.
  void build(Device device, const Particles& particles, const SurfacePoses& poses, Real skin);
  void complete(Device device);
  bool any_placed() const { return placed_count_ > 0; }
  // Whether any particle of this rank is near a posed surface.
  bool any_near() const { return placed_entries_ > 0; }
  bool all_placed_static() const { return any_placed() && all_static_; }  // as `SurfaceSet::is_static`
  Index entries() const { return entries_; }
  SurfaceNumbers numbers() const { return {planes_.data(), ground_}; }
  SurfaceList list() const {
    return {offsets_.data(), surfaces_.data(),      images_.data(), poses_.placed(),
            poses_.frames(), meshes_.rows().meshes, numbers()};
  }

  // Selects one of two sets of loads: that of the step, which the particles read, or of a second evaluation
  // for the bodies.
  enum class Loads { of_step, of_query };
  // Queues the copy of the surfaces' new poses, as in DevicePoses; send(): if there are any.
  void upload(Device device, const SurfacePoses& poses);
  void send(Device device, const SurfacePoses& poses) { poses_.send(device, poses); }
  void store_start(Device device);  // at the start of an implicit step
  // Queues the contacts of particles in the state of `query` with the surfaces on bodies at their present
  // poses, and their sums, which the device writes to the memory of the host. follows: what is queued before
  // on the stream; report: as in SurfaceLoadSums; there is none if no particle is near.
  void find_loads(Device device, Follows follows, const DeviceContactKernels& kernels, Loads which,
                  const SurfaceQuery& query, const ControlReport& report = {});
  // For surfaces at rest or with prescribed motion in a run of explicit steps of length h: queues the loads
  // of the step that is open when the kernels run, and the losses at triangles. follows: what is queued
  // before on the stream. key: everything that the launches depend on.
  void reserve_in_run(Device device, Index steps);  // before that many steps are queued
  void find_loads_in_run(Device device, const DeviceContactKernels& kernels, const OpenStepQuery& query,
                         Real h, Follows follows);
  std::string key_of_loads(const DeviceContactKernels& kernels, const OpenStepQuery& query, Real h) const;
  // For kernels that sum the loads of the step, evaluated last.
  SurfaceChunks chunk_list() const { return {chunks_.data(), static_cast<Index>(h_chunks_.size())}; }
  std::span<const SurfaceChunk> chunks() const { return h_chunks_; }  // on the host, ordered by surface
  const Index* by_surface() const { return by_surface_.order(); }
  const SurfaceLoad* loads() const { return loads_[0].data(); }
  // Over an implicit step; `query` is its end, with the history that results if the step is accepted.
  void find_steps(Device device, const DeviceContactKernels& kernels, const FrictionStart& start,
                  const SurfaceQuery& query);
  // Queues output values per entry from the loads of the step, which were evaluated at an instant for
  // particles in the state of `query`.
  const ShownContact* find_shown(Device device, const DeviceContactKernels& kernels,
                                 const SurfaceQuery& query);
  // Queues the losses at triangles over a closed step from the contacts evaluated last: over the explicit
  // step of length h, or over the implicit step.
  void accumulate_load_works(Device device, const DeviceContactKernels& kernels, Real h);
  void accumulate_step_works(Device device, const DeviceContactKernels& kernels);
  DeviceTriangleWorks& works() { return works_; }
  // Per entry, from the last find_steps() where particles rotate.
  const SurfaceFriction* friction_steps() const { return friction_steps_.data(); }
  // Of the contacts of the last find_loads(); waiting for them does not wait for the stream.
  const SurfaceLoadSums& load_sums() const { return load_sums_; }
  // Sums of the contacts evaluated last over an implicit step, once the stream is done: a surface may appear
  // in several parts.
  std::vector<StepSums> step_sums() const;
  // Forces and losses at the triangles of meshes, from the loads of the step. For snapshots: all contacts are
  // copied to the host. planes: on the host. Waits.
  std::vector<TriangleSums> triangle_sums(Device device, std::span<const WallPlane> planes) const;

  // All members of the items' views except particles and rows.
  template <class Rows>
  ContactViews<Rows> views(const Vec4* position, const Vec4* velocity, const int* material,
                           const Rows& rows) const {
    return {position,         velocity,  material,         rows,         offsets_.data(),
            surfaces_.data(), numbers(), loads_[0].data(), steps_.data()};
  }

 private:
  void find_entries(Device device, const Particles& particles, const SurfacePoses& poses, Real skin);
  void group_by_surface(Device device);
  SurfaceViews entry_views(const DeviceContactKernels& kernels, const SurfaceQuery& query) const;
  // What is before the loads, where that is before the contacts with meshes.
  Follows after_touches(Follows before) const { return meshes_.groups() > 0 ? Follows::kernel : before; }

  PeriodicBox box_;
  Real interaction_range_;  // `Contact::interaction_range` [m]
  DeviceArray<WallPlane> planes_;
  Index ground_, placed_count_;
  bool all_static_;
  std::vector<Index> placed_planes_, plane_numbers_;  // of planes: index among the placed surfaces, number
  DeviceMeshes meshes_;
  DeviceTriangleWorks works_;
  bool moves_;  // whether particles rotate
  Index entries_ = 0, placed_entries_ = 0;
  DeviceArray<Index> offsets_, surfaces_, particles_;
  DeviceArray<std::int8_t> images_;
  DeviceArray<unsigned char> space_;  // scratch of library calls
  CellSort by_surface_;
  std::vector<SurfaceChunk> h_chunks_;
  DeviceArray<SurfaceChunk> chunks_;
  const int* material_ = nullptr;
  DevicePoses poses_;
  DeviceArray<SurfaceLoad> loads_[2];
  DeviceArray<SurfaceStep> steps_;
  DeviceArray<ShownContact> shown_;              // empty unless output values were asked for
  DeviceArray<SurfaceFriction> friction_steps_;  // empty unless implicit steps have friction
  SurfaceLoadSums load_sums_;
  // Written by the device for chunks with contacts; the number of contacts is written for all.
  PinnedArray<StepSums> h_step_sums_;
  PinnedArray<Index> h_index_, h_starts_;  // h_starts_: of the entries of each placed surface
};

}  // namespace scree
