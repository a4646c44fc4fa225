// The search for the triangles near particles when a list is built, by warps: first particles near a box of
// the mesh's tree, tile of cells by tile, then the triangles near each of these.
#pragma once

#include "dem/surfaces/mesh_rows.hpp"
#include "device_meshes.cuh"
#include "for_each.cuh"
#include "mesh/mesh_tree.hpp"

namespace scree {

// Counters of particles near boxes of meshes, of groups, and of triangles.
enum Cursor { kParticles, kGroups, kTriangles, kCursors };

constexpr int kSearchThreads = 128;
constexpr Index kSearchWarps = kSearchThreads / 32;
constexpr Index kSearchBlocks = 8;  // per multiprocessor, of the search for triangles

__device__ inline Index lane_of_warp() { return static_cast<Index>(threadIdx.x % 32); }
__device__ inline Index warp_of_block() { return static_cast<Index>(threadIdx.x / 32); }
// Number of lanes below the own one for which a condition holds.
__device__ inline Index lanes_before(unsigned lanes) { return __popc(lanes & ((1u << lane_of_warp()) - 1)); }

template <class Merge>
__device__ Real over_warp(Real value, const Merge& merge) {
  for (int across = 16; across > 0; across /= 2) value = merge(value, __shfl_xor_sync(~0u, value, across));
  return value;
}

// Nodes of one level of a tree, in increasing order, that a point is near.
struct NodesNear {
  int level;
  Index count;
  const Index* nodes;
};

// Memory of a warp for the nodes of two levels.
struct NodeSpace {
  static constexpr Index kNodes = 128;  // of a drum's end wall, a quarter of its triangles in one corner
  Index nodes[2][kNodes];

  // All lanes descend together, a child each, to the nodes of the lowest level whose boxes are nearer to c
  // than the root of `limit`; to those of a higher level where there are too many of them.
  __device__ NodesNear find(const MeshView& mesh, Vec3 c, Real limit) {
    NodesNear near{mesh.levels - 1, 1, nodes[0]};
    __syncwarp();
    if (lane_of_warp() == 0) nodes[0][0] = 0;
    __syncwarp();
    for (int from = 0; near.level > 0 && near.count > 0; from = 1 - from) {
      const Index children = kTreeWidth * near.count, begin = mesh.level_start[near.level - 1],
                  end = mesh.level_start[near.level];
      Index found = 0;
      for (Index first = 0; first < children; first += 32) {
        const Index child = first + lane_of_warp();
        const Index node =
            child < children ? kTreeWidth * nodes[from][child / kTreeWidth] + child % kTreeWidth : end;
        const bool is_near = node < end - begin && squared_distance(mesh.boxes[begin + node], c) < limit;
        const unsigned lanes = __ballot_sync(~0u, is_near);
        const Index at = found + lanes_before(lanes);
        if (is_near && at < kNodes) nodes[1 - from][at] = node;
        found += __popc(lanes);
      }
      if (found > kNodes) break;
      __syncwarp();
      near = {near.level - 1, found, nodes[1 - from]};
    }
    return near;
  }
};

// Whether a point is near any box of the lowest level; by a single lane.
__device__ inline bool is_near_box(const MeshView& mesh, Vec3 c, Real limit) {
  const int top = mesh.levels - 1;
  int level = top;
  Index node = 0;
  while (level < top || node == 0) {
    if (squared_distance(mesh.boxes[mesh.level_start[level] + node], c) < limit) {
      if (level == 0) return true;
      --level, node *= kTreeWidth;
      continue;
    }
    ++node;
    while (level < top &&
           (node % kTreeWidth == 0 || node == mesh.level_start[level + 1] - mesh.level_start[level]))
      node = (node + kTreeWidth - 1) / kTreeWidth, ++level;
  }
  return false;
}

__device__ inline Real squared_range(const MeshView& mesh, Real range) {
  return (range + mesh.round_off) * (range + mesh.round_off);
}

// Tiles of cells near meshes, numbered one after the other: those of cells[k] are first[k] ... first[k + 1]
// - 1.
struct SearchedCells {
  const CellsNear* cells;
  const std::int64_t* first;
  Index count;  // number of cells[]

  // The k of the cells[k] with a numbered tile.
  __device__ Index owner(std::int64_t tile) const {
    Index low = 0, high = count;
    while (high - low > 1) {
      const Index middle = low + (high - low) / 2;
      (first[middle] <= tile ? low : high) = middle;
    }
    return low;
  }
};

// A placed mesh, as seen from the particles of cells near it.
struct MeshInCells {
  const CellsNear& cells;
  const SurfacePose& surface;
  const SurfaceFrame& frame;
  const MeshView& mesh;

  __device__ MeshInCells(const MeshSearch& in, const MeshView* meshes, const CellsNear& of)
      : cells(of), surface(in.placed[of.placed]), frame(in.frames[surface.frame]), mesh(meshes[frame.mesh]) {}

  __device__ Real past(Vec4 p) const { return mesh_skin(p.w, cells.skin); }
  __device__ MeshQuery query(Vec4 p) const { return {surface, frame, mesh, p, cells.shift, past(p)}; }
  // Calls visit(centre) as `MeshQuery` does, for a sphere at p; centres are in the frame of the mesh.
  template <class Visit>
  __device__ void for_each_centre(Vec3 p, Real margin, const Visit& visit) const {
    for_each_near_image(surface, frame, p, margin, [&](Vec3 position) {
      visit(transposed_times(frame.axes, (position - cells.shift) - surface.point));
    });
  }
};

// Finds the particles that are near a box of the lowest level of a mesh's tree, in any order; those beyond
// the capacity are only counted. A warp takes a tile of cells, which mostly is far from the mesh as a whole,
// and then each lane takes a particle.
struct FindParticlesItem {
  MeshSearch in;
  const MeshView* meshes;
  SearchedCells searched;
  Index* cursors;
  NearMesh* found;
  std::size_t capacity;

  struct Space {
    NodeSpace nodes;
    Index begin[32], before[32];  // per cell of the tile
  };

  __device__ void operator()(std::int64_t tile, Space& space) const {
    const Index lane = lane_of_warp(), owner = searched.owner(tile);
    const MeshInCells mesh(in, meshes, searched.cells[owner]);
    const CellIndex cell = mesh.cells.cell(static_cast<Index>(tile - searched.first[owner]), lane);
    Index begin = 0, count = 0;
    if (cell.x >= 0) {
      const Index key = in.grid.key(cell.x, cell.y, cell.z);
      begin = in.starts[key], count = in.starts[key + 1] - begin;
    }
    Index end = count;  // of the cell, among the particles of the tile
    for (int step = 1; step < 32; step *= 2) {
      const Index lower = __shfl_up_sync(~0u, end, step);
      if (lane >= step) end += lower;
    }
    const Index all = __shfl_sync(~0u, end, 31);
    if (all == 0 || !is_near(mesh, begin, count, all, space.nodes)) return;
    space.begin[lane] = begin, space.before[lane] = end - count;
    __syncwarp();
    for (Index first = 0; first < all; first += 32) add_particle(mesh, owner, first + lane, all, space);
  }

 private:
  // Whether a tile with particles begin ... begin + count - 1 in each lane's cell, `all` together, may have
  // some near the mesh: a sphere around all of them.
  __device__ bool is_near(const MeshInCells& mesh, Index begin, Index count, Index all,
                          NodeSpace& nodes) const {
    constexpr Real kRoundOff = 1e-9;
    Vec3 sum{};
    for (Index i = begin; i < begin + count; ++i) sum = sum + xyz(in.position[i]);
    const auto add = [](Real a, Real b) { return a + b; };
    const Vec3 middle =
        (Real(1) / all) * Vec3{over_warp(sum.x, add), over_warp(sum.y, add), over_warp(sum.z, add)};
    Real reach = 0;
    for (Index i = begin; i < begin + count; ++i) {
      const Vec4 p = in.position[i];
      reach = fmax(reach, norm(xyz(p) - middle) + p.w + mesh.past(p));
    }
    reach = (1 + kRoundOff) * over_warp(reach, [](Real a, Real b) { return fmax(a, b); });
    // Images by more than one period are not visited.
    const auto spans = [&](Real period) { return period != 0 && 2 * reach >= period; };
    const Vec3 period = mesh.frame.spanned;
    bool near = spans(period.x) || spans(period.y) || spans(period.z);
    mesh.for_each_centre(middle, reach, [&](Vec3 c) {
      near = near || nodes.find(mesh.mesh, c, squared_range(mesh.mesh, reach)).count > 0;
    });
    return near;
  }
  // The lane's particle, by its number in the tile.
  __device__ void add_particle(const MeshInCells& mesh, Index owner, Index number, Index all,
                               const Space& space) const {
    bool near = false;
    Index i = 0;
    if (number < all) {
      Index cell = 0;
      for (Index step = 16; step > 0; step /= 2)
        if (space.before[cell + step] <= number) cell += step;
      i = space.begin[cell] + number - space.before[cell];
      const Vec4 p = in.position[i];
      mesh.for_each_centre(xyz(p), mesh.past(p), [&](Vec3 c) {
        near = near || is_near_box(mesh.mesh, c, squared_range(mesh.mesh, p.w + mesh.past(p)));
      });
    }
    const unsigned lanes = __ballot_sync(~0u, near);
    if (lanes == 0) return;
    Index at = 0;
    if (lane_of_warp() == 0) at = atomicAdd(&cursors[kParticles], __popc(lanes));
    at = __shfl_sync(~0u, at, 0) + lanes_before(lanes);
    if (near && static_cast<std::size_t>(at) < capacity) found[at] = {i, owner};
  }
};

// Makes the groups of these particles, in any order, with their triangles in increasing order; those beyond
// the capacities are only counted. A warp takes a particle.
struct FindTrianglesItem {
  MeshSearch in;
  const MeshView* meshes;
  const CellsNear* cells;
  const NearMesh* particles;
  Index* cursors;
  NearMesh* near;
  MeshGroup* groups;
  Index* triangles;
  std::size_t capacity[kCursors];

  struct Space {
    static constexpr Index kStored = 64;  // long enough that few rows are searched twice
    NodeSpace nodes;
    Index triangles[kStored];
  };

  // Number of particles found before.
  __device__ Index count() const {
    return static_cast<Index>(min(static_cast<std::size_t>(cursors[kParticles]), capacity[kParticles]));
  }
  __device__ void operator()(Index k, Space& space) const {
    const NearMesh particle = particles[k];
    const MeshInCells mesh(in, meshes, cells[particle.cells]);
    const Vec4 p = in.position[particle.particle];
    const Index found = list(mesh, p, space.nodes, space.triangles, Space::kStored);
    if (found == 0) return;
    Index g = 0, first = 0;
    if (lane_of_warp() == 0)
      g = atomicAdd(&cursors[kGroups], 1), first = atomicAdd(&cursors[kTriangles], found);
    g = __shfl_sync(~0u, g, 0), first = __shfl_sync(~0u, first, 0);
    if (g < 0 || static_cast<std::size_t>(g) >= capacity[kGroups]) return;
    if (first < 0 || static_cast<std::size_t>(first) + static_cast<std::size_t>(found) > capacity[kTriangles])
      return;
    __syncwarp();
    if (found <= Space::kStored)
      for (Index t = lane_of_warp(); t < found; t += 32) triangles[first + t] = space.triangles[t];
    else
      list(mesh, p, space.nodes, triangles + first, found);
    if (lane_of_warp() == 0) near[g] = particle, groups[g] = {0, 0, first, found, RowKind::any};
  }

 private:
  // Writes the first `most` triangles near a particle; returns the number of all.
  __device__ Index list(const MeshInCells& mesh, Vec4 p, NodeSpace& nodes, Index* to, Index most) const {
    const Real limit = squared_range(mesh.mesh, p.w + mesh.past(p));
    Index found = 0;
    mesh.for_each_centre(xyz(p), mesh.past(p), [&](Vec3 c) {
      const NodesNear near = nodes.find(mesh.mesh, c, limit);
      const int bits = 2 * (near.level + 1);  // a node has up to 2^bits triangles
      static_assert(kTreeWidth == 4);
      const std::int64_t all = std::int64_t{near.count} << bits, within = (std::int64_t{1} << bits) - 1;
      for (std::int64_t first = 0; first < all; first += 32) {
        const std::int64_t k = first + lane_of_warp();
        const std::int64_t t =
            k < all ? (std::int64_t{near.nodes[k >> bits]} << bits) + (k & within) : mesh.mesh.triangle_count;
        const bool is_near =
            t < mesh.mesh.triangle_count && is_nearer(mesh.mesh, static_cast<Index>(t), c, limit);
        const unsigned lanes = __ballot_sync(~0u, is_near);
        const Index at = found + lanes_before(lanes);
        if (is_near && at < most) to[at] = static_cast<Index>(t);
        found += __popc(lanes);
      }
    });
    return found;
  }
};

__global__ void __launch_bounds__(kSearchThreads)
    find_particles_kernel(std::int64_t tiles, const __grid_constant__ FindParticlesItem item) {
  __shared__ FindParticlesItem::Space space[kSearchWarps];
  const std::int64_t tile = std::int64_t{blockIdx.x} * kSearchWarps + warp_of_block();
  if (tile < tiles) item(tile, space[warp_of_block()]);
}

__global__ void __launch_bounds__(kSearchThreads)
    find_triangles_kernel(const __grid_constant__ FindTrianglesItem item) {
  __shared__ FindTrianglesItem::Space space[kSearchWarps];
  const Index count = item.count(), warps = static_cast<Index>(gridDim.x) * kSearchWarps;
  for (Index k = static_cast<Index>(blockIdx.x) * kSearchWarps + warp_of_block(); k < count; k += warps)
    item(k, space[warp_of_block()]);
}

// Kind and number of entries of each group, which are added per particle.
struct EntriesItem {
  MeshSearch in;
  const MeshView* meshes;
  const CellsNear* cells;
  const NearMesh* near;
  const Index* triangles;
  MeshGroup* groups;
  Index* counts;  // number of entries per particle

  __device__ void operator()(Index g) const {
    const NearMesh of = near[g];
    const MeshInCells mesh(in, meshes, cells[of.cells]);
    MeshGroup group = groups[g];
    const Index* const row = triangles + group.first_triangle;
    group.kind = kind_of_row(mesh.mesh, row, group.triangles);
    group.entries = mesh.query(in.position[of.particle])
                        .entries(group.kind, row, group.triangles,
                                 in.stored_contacts.contacts_with(of.particle, mesh.cells.number));
    groups[g] = group;
    atomicAdd(&counts[of.particle], group.entries);
  }
};

}  // namespace scree
