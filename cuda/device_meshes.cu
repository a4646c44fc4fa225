#include <algorithm>

#include "base/countable.hpp"
#include "dem/surface_contact/mesh_step_touches.hpp"
#include "dependent_launch.cuh"
#include "device_meshes.cuh"
#include "for_each.cuh"
#include "lane_team.cuh"
#include "mesh/surface_mesh.hpp"
#include "staging.cuh"

namespace scree {
namespace {

// Counters of groups and triangles.
enum Cursor { kGroups, kTriangles, kCursors };

// The cells near meshes, numbered one after the other: cells[k] has the numbers first[k] ... first[k + 1] -
// 1.
struct SearchedCells {
  const CellsNear* cells;
  const std::int64_t* first;
  Index count;  // number of cells[]

  // The k of the cells[k] that contains a numbered cell.
  __device__ Index owner(std::int64_t c) const {
    Index low = 0, high = count;
    while (high - low > 1) {
      const Index middle = low + (high - low) / 2;
      (first[middle] <= c ? low : high) = middle;
    }
    return low;
  }
};

// Makes the groups, in any order, with their triangles and the number of their entries; those beyond the
// capacity are only counted.
struct FindNearItem {
  MeshSearch in;
  const MeshView* meshes;
  SearchedCells searched;
  std::int64_t first_cell;
  Index* cursors;
  NearMesh* near;
  MeshGroup* groups;
  Index* triangles;
  std::size_t capacity[kCursors];

  __device__ void operator()(Index k) const {
    const std::int64_t c = first_cell + k;
    const Index owner = searched.owner(c);
    const CellsNear& cells = searched.cells[owner];
    const SurfacePose& surface = in.placed[cells.placed];
    const SurfaceFrame& frame = in.frames[surface.frame];
    cells.for_each_particle(in, static_cast<Index>(c - searched.first[owner]), [&](Index i) {
      const Vec4 p = in.position[i];
      const MeshQuery query{surface, frame, meshes[frame.mesh], p, cells.shift, mesh_skin(p.w, cells.skin)};
      constexpr Index kStored = 24;  // long enough that few rows are searched twice
      Index near_triangles[kStored], found = 0;
      query.for_each_triangle([&](Index t) {
        if (found < kStored) near_triangles[found] = t;
        ++found;
      });
      if (found == 0) return;
      const Index g = atomicAdd(&cursors[kGroups], 1), first = atomicAdd(&cursors[kTriangles], found);
      if (g < 0 || static_cast<std::size_t>(g) >= capacity[kGroups]) return;
      if (first < 0 ||
          static_cast<std::size_t>(first) + static_cast<std::size_t>(found) > capacity[kTriangles])
        return;
      Index* to = triangles + first;
      if (found <= kStored)
        for (Index t = 0; t < found; ++t) to[t] = near_triangles[t];
      else
        query.for_each_triangle([&](Index t) { *to++ = t; });
      near[g] = {i, cells.number, cells.image};
      const RowKind kind = kind_of_row(query.mesh, triangles + first, found);
      const Index stored_contacts = in.stored_contacts.contacts_with(i, cells.number);
      groups[g] = {0, query.entries(kind, triangles + first, found, stored_contacts), first, found, kind};
    });
  }
};

constexpr int kFindThreads = 64;
constexpr int kFindBlocks = 8;  // blocks per multiprocessor: a search loads one bounding box after the other,
                                // and many threads hide the latency

__global__ void __launch_bounds__(kFindThreads, kFindBlocks)
    find_near_kernel(Index cells, const __grid_constant__ FindNearItem item) {
  const Index k = thread_index();
  if (k < cells) item(k);
}

struct CountItem {
  const NearMesh* near;
  const MeshGroup* groups;
  Index* counts;  // number of entries per particle

  __device__ void operator()(Index g) const { atomicAdd(&counts[near[g].particle], groups[g].entries); }
};

struct FillItem {
  const NearMesh* near;
  const MeshGroup* groups;
  Index *next, *surfaces;
  std::int8_t* images;

  __device__ void operator()(Index g) const {
    const Index first = atomicAdd(&next[near[g].particle], groups[g].entries);
    for (Index k = first; k < first + groups[g].entries; ++k)
      surfaces[k] = near[g].surface, images[k] = near[g].image;
  }
};

struct GroupItem {
  const NearMesh* near;
  const Index *offsets, *surfaces;
  const std::int8_t* images;
  MeshGroup* groups;
  CachedContact* cached_contacts;
  MeshTouch* touches;

  __device__ void operator()(Index g) const {
    const NearMesh& of = near[g];
    Index entry = offsets[of.particle];
    while (surfaces[entry] != of.surface || images[entry] != of.image) ++entry;
    groups[g].entry = entry;
    cached_contacts[g] = kNoCachedContact;
    touches[entry].triangle = -1;  // no triangle to start the first query at
  }
};

constexpr int kTouchThreads = 32;
constexpr int kTouchBlocks = 12;   // blocks per multiprocessor: with more, registers spill
constexpr int kLanesPerGroup = 8;  // rows have about ten triangles
constexpr Index kTeams = kTouchThreads / kLanesPerGroup;
using TouchRecords = WarpRecords<MeshTouch, kTouchThreads>;

// Contacts at an instant.
struct StateQuery {
  __device__ bool open(SurfaceViews&) const { return true; }
};

// Groups, and how many of them a block has: where they are few, no more than it has teams, because the time
// is then that of one search; where they are many, as many more as let all blocks run at once.
struct TouchShares {
  Index groups, per_block;

  TouchShares(Index of, Index multiprocessors) : groups(of) {
    const Index searched_at_once = multiprocessors * kTouchBlocks * kTeams,
                rounds = (of + searched_at_once - 1) / searched_at_once;
    per_block = std::min<Index>(rounds * kTeams, kTouchThreads);
  }
};

// Most particles keep their contact of the last step, which one thread confirms. Groups of a block whose
// triangles must be searched are redistributed over teams of lanes, so that no warp waits for a few of its
// lanes.
template <bool kHasRange, bool kOpenSurfaces, class Query>
__global__ void __launch_bounds__(kTouchThreads, kTouchBlocks)
    touch_kernel(const TouchShares shares, const __grid_constant__ SurfaceViews views, const Query query,
                 MeshTouch* touches, CachedContact* cached_contacts) {
  __shared__ TouchRecords::Shared shared;
  __shared__ Index pending[kTouchThreads], pending_count;
  admit_next_kernel();
  await_kernel_before();
  SurfaceViews now = views;
  if (!query.open(now)) return;
  const auto thread = static_cast<Index>(threadIdx.x);
  if (thread == 0) pending_count = 0;
  __syncthreads();
  const MeshTouchItem<kHasRange, kOpenSurfaces> item{now, touches, cached_contacts};
  const TouchRecords records(shared);
  const Index g = static_cast<Index>(blockIdx.x) * shares.per_block + thread;
  Index entry = -1;
  if (thread < shares.per_block && g < shares.groups) {
    const Nearest found = item.use_cached(g, records.own());
    if (found == Nearest::one) entry = now.meshes.groups[g].entry;
    if (found == Nearest::unclear) pending[atomicAdd(&pending_count, 1)] = g;
  }
  records.store(touches, entry);
  __syncthreads();
  for (Index k = thread / kLanesPerGroup; k < pending_count; k += kTeams)
    item.query(pending[k], LaneTeam<kLanesPerGroup>{});
}

// Arguments of touch_kernel.
template <class Query>
struct TouchRequest {
  TouchShares shares;
  SurfaceViews views;
  Query query;
  MeshTouch* touches;
  CachedContact* cached_contacts;
};

template <bool kHasRange, bool kOpenSurfaces, class Query>
void launch_touches(Device device, Follows follows, const TouchRequest<Query>& r) {
  launch_dependent(device, follows, touch_kernel<kHasRange, kOpenSurfaces, Query>,
                   blocks_for(r.shares.groups, r.shares.per_block), kTouchThreads, r.shares, r.views, r.query,
                   r.touches, r.cached_contacts);
}

template <class Query>
void queue_touches(Device device, Follows follows, bool open_surfaces, const TouchRequest<Query>& r) {
  if (r.shares.groups == 0) return;
  if (r.views.interaction_range > 0)
    open_surfaces ? launch_touches<true, true>(device, follows, r)
                  : launch_touches<true, false>(device, follows, r);
  else
    open_surfaces ? launch_touches<false, true>(device, follows, r)
                  : launch_touches<false, false>(device, follows, r);
}

// Whether a cell of the grid overlaps the box.
bool overlaps(const CellGrid& grid, const Box& box) {
  const auto along = [](Real origin, Real inverse_size, Index cells, Real min, Real max) {
    return max >= origin && min <= origin + static_cast<Real>(cells) / inverse_size;
  };
  return along(grid.origin.x, grid.inverse_size.x, grid.cells[0], box.min.x, box.max.x) &&
         along(grid.origin.y, grid.inverse_size.y, grid.cells[1], box.min.y, box.max.y) &&
         (grid.layer || along(grid.origin.z, grid.inverse_size.z, grid.cells[2], box.min.z, box.max.z));
}

template <class T>
const T* uploaded(DeviceArray<T>& array, const std::vector<T>& values, cudaStream_t stream) {
  array.upload(values, stream);
  return array.data();
}

}  // namespace

DeviceMeshes::DeviceMeshes(const Model& model, cudaStream_t stream)
    : surfaces_(model), open_surfaces_(has_open_surfaces(model)), cursors_(kCursors) {
  std::vector<MeshView> views;
  meshes_.reserve(model.meshes.size());
  for (const ModelMesh& mesh : model.meshes) {
    const SurfaceMesh& from = *mesh.surface;
    Arrays& to = meshes_.emplace_back();
    MeshView& view = views.emplace_back(from.view());
    view.vertices = uploaded(to.vertices, from.vertices, stream);
    view.triangles = uploaded(to.triangles, from.triangles, stream);
    view.parts = uploaded(to.parts, from.parts, stream);
    view.features = uploaded(to.features, from.features, stream);
    view.tests = uploaded(to.tests, from.tests, stream);
    view.patches = uploaded(to.patches, from.patches, stream);
    view.first_neighbour = uploaded(to.first_neighbour, from.first_neighbour, stream);
    view.neighbours = uploaded(to.neighbours, from.neighbours, stream);
    view.boxes = uploaded(to.boxes, from.boxes, stream);
  }
  views_.upload(views, stream);
  for (Index s = 0; s < surfaces_.placed(); ++s)
    if (surfaces_.at(s).kind == SurfaceKind::mesh) instances_.push_back(s);
}

// The boxes of cells to search, per mesh and image.
std::vector<CellsNear> DeviceMeshes::cells_near_meshes(const MeshSearch& search, const SurfacePoses& poses,
                                                       Real largest_radius) const {
  std::vector<CellsNear> near;
  for (const Index s : instances_) {
    const SurfacePose& surface = poses.placed[static_cast<std::size_t>(s)];
    const SurfaceFrame& frame = poses.frames[static_cast<std::size_t>(surface.frame)];
    const Real skin = poses.skin_of(s, search.skin);
    for_each_shift(search.period - frame.spanned, [&](Vec3 shift, std::int8_t image) {
      const Box box = box_near(poses, s, shift, largest_radius, skin);
      if (overlaps(search.grid.cells.space, box))
        near.push_back(
            {s, surfaces_.number_of(s), skin, shift, image, cells_near(search.grid.cells.own, box)});
    });
  }
  return near;
}

void DeviceMeshes::find(Device device, const MeshSearch& search, const SurfacePoses& poses,
                        Real largest_radius, Index* counts) {
  count_ = 0;
  if (instances_.empty()) return;
  const std::vector<CellsNear> near = cells_near_meshes(search, poses, largest_radius);
  if (!find_groups(device, search, near)) find_groups(device, search, near);
  for_each(device, count_, CountItem{near_.data(), groups_.data(), counts});
}

// False: the capacity did not suffice, and has been enlarged.
bool DeviceMeshes::find_groups(Device device, const MeshSearch& search, const std::vector<CellsNear>& near) {
  std::vector<std::int64_t> first{0};
  for (const CellsNear& cells : near) first.push_back(first.back() + cells.count());
  const SearchedCells searched{uploaded(cells_, near, device.stream),
                               uploaded(first_cell_, first, device.stream), static_cast<Index>(near.size())};
  cursors_.zero(device.stream);
  const std::size_t capacity = std::min(near_.capacity(), groups_.capacity());
  constexpr std::int64_t kAtOnce = 1 << 30;
  for (std::int64_t c = 0; c < first.back(); c += kAtOnce) {
    const auto cells = static_cast<Index>(std::min(kAtOnce, first.back() - c));
    const FindNearItem item{search,
                            views_.data(),
                            searched,
                            c,
                            cursors_.data(),
                            near_.data(),
                            groups_.data(),
                            triangles_.data(),
                            {capacity, triangles_.capacity()}};
    find_near_kernel<<<blocks_for(cells, kFindThreads), kFindThreads, 0, device.stream>>>(cells, item);
    require_cuda(cudaGetLastError(), "triangles near particles");
  }
  copy_async(h_counts_.data(), cursors_.data(), kCursors, device.stream);
  wait_for(device.stream);
  if (h_counts_[kTriangles] < 0)
    countable(std::size_t{1} << 32, "stage neighbors: more triangles near particles");
  count_ = h_counts_[kGroups];
  const auto groups = static_cast<std::size_t>(count_),
             triangles = static_cast<std::size_t>(h_counts_[kTriangles]);
  const bool complete = groups <= capacity && triangles <= triangles_.capacity();
  near_.resize_with_spare(groups), groups_.resize_with_spare(groups),
      cached_contacts_.resize_with_spare(groups);
  triangles_.resize_with_spare(triangles);
  return complete;
}

void DeviceMeshes::fill(Device device, Index* next, Index* surfaces, std::int8_t* images) {
  for_each(device, count_, FillItem{near_.data(), groups_.data(), next, surfaces, images});
}

void DeviceMeshes::group(Device device, const Index* offsets, const Index* surfaces,
                         const std::int8_t* images) {
  for_each(device, count_,
           GroupItem{near_.data(), offsets, surfaces, images, groups_.data(), cached_contacts_.data(),
                     touches_.data()});
}

void DeviceMeshes::reserve_entries(Index entries) {
  if (exist()) touches_.resize_with_spare(static_cast<std::size_t>(entries));
}

void DeviceMeshes::reserve_over_step(Index entries) {
  if (exist()) before_.resize_with_spare(static_cast<std::size_t>(entries));
}

void DeviceMeshes::touch(Device device, const SurfaceViews& views) {
  queue_touches<StateQuery>(
      device, Follows::anything, open_surfaces_,
      {{count_, multiprocessors_}, views, {}, touches_.data(), cached_contacts_.data()});
}

void DeviceMeshes::touch_in_run(Device device, const SurfaceViews& views, const OpenStepQuery& query,
                                Follows follows) {
  queue_touches<OpenStepQuery>(
      device, follows, open_surfaces_,
      {{count_, multiprocessors_}, views, query, touches_.data(), cached_contacts_.data()});
}

void DeviceMeshes::touch_over_step(Device device, const SurfaceViews& views, const Vec4* start_position,
                                   const SurfacePose* start_surface_poses) {
  if (open_surfaces_)
    for_each(
        device, count_,
        MeshStepTouchItem<true>{views, start_position, start_surface_poses, touches_.data(), before_.data()});
  else
    for_each(device, count_,
             MeshStepTouchItem<false>{views, start_position, start_surface_poses, touches_.data(),
                                      before_.data()});
}

}  // namespace scree
