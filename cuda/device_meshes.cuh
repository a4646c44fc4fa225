// Meshes on the device: which particles are near which triangles, and where they touch.
#pragma once

#include <span>
#include <vector>

#include "cell_block_grid.cuh"
#include "contact_kernels.cuh"
#include "dem/search/surface_rows.hpp"
#include "dem/surface_contact/surface_items.hpp"
#include "dem/surfaces/mesh_rows.hpp"
#include "dem/surfaces/surfaces.hpp"
#include "device.cuh"
#include "mesh/cached_contact.hpp"
#include "model/data/model.hpp"
#include "packed_history_views.cuh"

namespace scree {

// A particle near a mesh image, before it has a row.
struct NearMesh {
  Index particle, cells;  // cells: index of the `CellsNear`
};

// Where the search finds particles, sorted by cell, and the poses of surfaces; device pointers.
struct MeshSearch {
  const Vec4* position;
  CellBlockGrid grid;
  const Index* starts;  // [cells + 1]
  Real skin;            // range past touching of the search at static surfaces [m]
  Vec3 period;
  const SurfacePose* placed;
  const SurfaceFrame* frames;
  StoredRows stored_contacts;
};

// Cells whose particles may be near a mesh image, which is displaced by the shift.
struct CellsNear {
  Index placed, number;  // index among the placed surfaces, number of the surface
  Real skin;             // range past touching of the search [m]
  Vec3 shift;
  std::int8_t image;
  CellRange range;

  // Tiles of 4 x 4 x 2 cells, one for each lane of a warp, that contain all of them.
  std::int64_t tiles() const {
    return std::int64_t{along(range.lower.x, range.upper.x, 2)} * along(range.lower.y, range.upper.y, 2) *
           along(range.lower.z, range.upper.z, 1);
  }
  // A cell of a tile; x is -1 if it is none of these cells.
  __device__ CellIndex cell(Index tile, Index lane) const {
    const CellIndex &low = range.lower, &up = range.upper;
    const Index nx = along(low.x, up.x, 2), ny = along(low.y, up.y, 2);
    const CellIndex c{(((low.x >> 2) + tile % nx) << 2) + (lane & 3),
                      (((low.y >> 2) + tile / nx % ny) << 2) + (lane >> 2 & 3),
                      (((low.z >> 1) + tile / (nx * ny)) << 1) + (lane >> 4)};
    const bool inside =
        c.x >= low.x && c.x <= up.x && c.y >= low.y && c.y <= up.y && c.z >= low.z && c.z <= up.z;
    return inside ? c : CellIndex{-1, -1, -1};
  }

 private:
  SCREE_HD static Index along(Index lower, Index upper, int shift) {
    return (upper >> shift) - (lower >> shift) + 1;
  }
};

struct SearchedCells;

class DeviceMeshes {
 public:
  DeviceMeshes(const Model& model, cudaStream_t stream);
  bool exist() const { return !meshes_.empty(); }

  // For a new list, in this order. The first finds the particles near meshes, adds the numbers of their
  // entries to counts[particle], and waits; poses: those on the host; largest_radius: of the particles [m].
  // The second writes these entries to the rows, from next[particle] on, which it advances. The third, with
  // the rows sorted, finds which entries belong together.
  void find(Device device, const MeshSearch& search, const SurfacePoses& poses, Real largest_radius,
            Index* counts);
  void fill(Device device, Index* next, Index* surfaces, std::int8_t* images);
  void group(Device device, const Index* offsets, const Index* surfaces, const std::int8_t* images);

  // Queues the contacts at the present instant, into the entries' arrays. follows: what is queued before.
  void touch(Device device, const SurfaceViews& views, Follows follows);
  // The same for the explicit step that is open when the kernel runs.
  void touch_in_run(Device device, const SurfaceViews& views, const OpenStepQuery& query, Follows follows);
  // The same over an implicit step.
  void touch_over_step(Device device, const SurfaceViews& views, const Vec4* start_position,
                       const SurfacePose* start_surface_poses);
  // Size the arrays for that many entries; the second one those of implicit steps.
  void reserve_entries(Index entries);
  void reserve_over_step(Index entries);

  // Host copies of what `triangle_sums` reads; waits.
  std::vector<MeshGroup> download_groups(cudaStream_t stream) const { return groups_.download(stream); }
  std::vector<MeshTouch> download_touches(cudaStream_t stream) const { return touches_.download(stream); }

  Index groups() const { return count_; }
  MeshRows rows() const { return {groups_.data(), triangles_.data(), views_.data()}; }
  const MeshTouch* touches() const { return touches_.data(); }
  const MeshTouchBefore* before() const { return before_.data(); }

 private:
  // The arrays of a `MeshView`.
  struct Arrays {
    DeviceArray<Vec3> vertices;
    DeviceArray<MeshTriangle> triangles;
    DeviceArray<MeshPart> parts;
    DeviceArray<MeshFeature> features;
    DeviceArray<Index> tests, patches, first_neighbour, neighbours;
    DeviceArray<MeshBox> boxes;
  };

  std::vector<CellsNear> cells_near_meshes(const MeshSearch& search, const SurfacePoses& poses,
                                           Real largest_radius) const;
  bool find_groups(Device device, const MeshSearch& search, const SearchedCells& cells, std::int64_t tiles);
  void resize_groups(std::size_t groups, std::size_t triangles);

  std::vector<Arrays> meshes_;
  DeviceArray<MeshView> views_;
  SurfaceSet surfaces_;
  bool open_surfaces_;
  Index multiprocessors_ = static_cast<Index>(multiprocessors());
  std::vector<Index> instances_;  // indices of the meshes among the placed surfaces
  Index count_ = 0;               // number of groups
  DeviceArray<CellsNear> cells_;
  DeviceArray<std::int64_t> first_tile_;
  DeviceArray<NearMesh> particles_, near_;  // near boxes of meshes; per group
  DeviceArray<MeshGroup> groups_;
  DeviceArray<CachedContact> cached_contacts_;
  DeviceArray<Index> triangles_, cursors_;
  PinnedArray<Index> h_counts_;
  DeviceArray<MeshTouch> touches_;
  DeviceArray<MeshTouchBefore> before_;
};

}  // namespace scree
