#include <algorithm>

#include "base/countable.hpp"
#include "dem/surface_contact/mesh_step_touches.hpp"
#include "dependent_launch.cuh"
#include "device_meshes.cuh"
#include "for_each.cuh"
#include "lane_team.cuh"
#include "mesh/surface_mesh.hpp"
#include "mesh_search.cuh"
#include "staging.cuh"

namespace scree {
namespace {

struct FillItem {
  const CellsNear* cells;
  const NearMesh* near;
  const MeshGroup* groups;
  Index *next, *surfaces;
  std::int8_t* images;

  __device__ void operator()(Index g) const {
    const CellsNear& of = cells[near[g].cells];
    const Index first = atomicAdd(&next[near[g].particle], groups[g].entries);
    for (Index k = first; k < first + groups[g].entries; ++k) surfaces[k] = of.number, images[k] = of.image;
  }
};

struct GroupItem {
  const CellsNear* cells;
  const NearMesh* near;
  const Index *offsets, *surfaces;
  const std::int8_t* images;
  MeshGroup* groups;
  CachedContact* cached_contacts;
  MeshTouch* touches;

  __device__ void operator()(Index g) const {
    const CellsNear& of = cells[near[g].cells];
    Index entry = offsets[near[g].particle];
    while (surfaces[entry] != of.number || images[entry] != of.image) ++entry;
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
    : surfaces_(model), open_surfaces_(has_open_surfaces(model)), cursors_(kCursors), h_counts_(kCursors) {
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
  if (near.empty()) return resize_groups(0, 0);
  std::vector<std::int64_t> first{0};
  for (const CellsNear& cells : near) first.push_back(first.back() + cells.tiles());
  cells_.resize_with_spare(near.size()), first_tile_.resize_with_spare(first.size());
  copy_async(cells_.data(), near.data(), near.size(), device.stream);
  copy_async(first_tile_.data(), first.data(), first.size(), device.stream);
  const SearchedCells searched{cells_.data(), first_tile_.data(), static_cast<Index>(near.size())};
  while (!find_groups(device, search, searched, first.back())) {
  }
  for_each(device, count_,
           EntriesItem{search, views_.data(), cells_.data(), near_.data(), triangles_.data(), groups_.data(),
                       counts});
}

// Waits for the device. False: the capacity did not suffice, and has been enlarged.
bool DeviceMeshes::find_groups(Device device, const MeshSearch& search, const SearchedCells& cells,
                               std::int64_t tiles) {
  cursors_.zero(device.stream);
  const std::size_t capacity[kCursors] = {
      particles_.capacity(), std::min(near_.capacity(), groups_.capacity()), triangles_.capacity()};
  const FindParticlesItem particles{search,          views_.data(),     cells,
                                    cursors_.data(), particles_.data(), capacity[kParticles]};
  const auto blocks = static_cast<unsigned>((tiles + kSearchWarps - 1) / kSearchWarps);
  find_particles_kernel<<<blocks, kSearchThreads, 0, device.stream>>>(tiles, particles);
  const FindTrianglesItem triangles{search,
                                    views_.data(),
                                    cells.cells,
                                    particles_.data(),
                                    cursors_.data(),
                                    near_.data(),
                                    groups_.data(),
                                    triangles_.data(),
                                    {capacity[kParticles], capacity[kGroups], capacity[kTriangles]}};
  const auto at_once = static_cast<unsigned>(multiprocessors_ * kSearchBlocks);
  find_triangles_kernel<<<at_once, kSearchThreads, 0, device.stream>>>(triangles);
  require_cuda(cudaGetLastError(), "triangles near particles");
  copy_async(h_counts_.data(), cursors_.data(), kCursors, device.stream);
  wait_for(device.stream);
  if (h_counts_[kTriangles] < 0)
    countable(std::size_t{1} << 32, "stage neighbors: more triangles near particles");
  std::size_t found[kCursors];
  for (int k = 0; k < kCursors; ++k) found[k] = static_cast<std::size_t>(h_counts_[k]);
  particles_.resize_with_spare(found[kParticles]);
  if (found[kParticles] > capacity[kParticles]) return false;
  resize_groups(found[kGroups], found[kTriangles]);
  return found[kGroups] <= capacity[kGroups] && found[kTriangles] <= capacity[kTriangles];
}

void DeviceMeshes::resize_groups(std::size_t groups, std::size_t triangles) {
  count_ = static_cast<Index>(groups);
  near_.resize_with_spare(groups), groups_.resize_with_spare(groups);
  cached_contacts_.resize_with_spare(groups);
  triangles_.resize_with_spare(triangles);
}

void DeviceMeshes::fill(Device device, Index* next, Index* surfaces, std::int8_t* images) {
  for_each(device, count_, FillItem{cells_.data(), near_.data(), groups_.data(), next, surfaces, images});
}

void DeviceMeshes::group(Device device, const Index* offsets, const Index* surfaces,
                         const std::int8_t* images) {
  for_each(device, count_,
           GroupItem{cells_.data(), near_.data(), offsets, surfaces, images, groups_.data(),
                     cached_contacts_.data(), touches_.data()});
}

void DeviceMeshes::reserve_entries(Index entries) {
  if (exist()) touches_.resize_with_spare(static_cast<std::size_t>(entries));
}

void DeviceMeshes::reserve_over_step(Index entries) {
  if (exist()) before_.resize_with_spare(static_cast<std::size_t>(entries));
}

void DeviceMeshes::touch(Device device, const SurfaceViews& views, Follows follows) {
  queue_touches<StateQuery>(
      device, follows, open_surfaces_,
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
