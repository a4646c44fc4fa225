#include <cub/device/device_scan.cuh>

#include "base/countable.hpp"
#include "dem/search/surface_rows.hpp"
#include "device_surfaces.cuh"
#include "for_each.cuh"
#include "step_graph.cuh"

namespace scree {
namespace {

constexpr int kSearchThreads = 128;

// Input of the search for surfaces near particles.
struct EntrySearch {
  const Vec4* position;
  Index active;
  CellBlockGrid grid;
  const Index* starts;
  Real search_radius, skin;  // search_radius: largest particle radius + skin [m]
  SurfaceNumbers numbers;
  const SurfacePose* placed;
  Vec3 period;
};

__device__ bool is_near(const EntrySearch& in, Vec4 p, const WallPlane& plane) {
  return wall_pair(p, plane).distance < p.w + in.skin;
}

// Counts the entries with static planes per particle.
struct GroundCountItem {
  EntrySearch in;
  Index* counts;
  __device__ void operator()(Index i) const {
    Index count = 0;
    if (i < in.active)
      for (Index w = 0; w < in.numbers.ground; ++w)
        count += in.numbers.is_static(w) && is_near(in, in.position[i], in.numbers.planes[w]);
    counts[i] = count;
  }
};

struct EntryOutputs {
  Index *surfaces, *particles;
  std::int8_t* images;
};

struct GroundFillItem {
  EntrySearch in;
  const Index* offsets;
  Index* next;
  EntryOutputs out;
  __device__ void operator()(Index i) const {
    Index slot = offsets[i];
    if (offsets[i + 1] > slot)  // most particles have none, and need not read the offsets
      for (Index w = 0; w < in.numbers.ground; ++w)
        if (in.numbers.is_static(w) && is_near(in, in.position[i], in.numbers.planes[w])) {
          out.surfaces[slot] = w, out.images[slot] = kZeroShift;
          ++slot;
        }
    next[i] = slot;
  }
};

// Calls visit(i, surface, image) for the active particles near the surface of this block, a sphere.
template <class Visit>
__device__ void visit_near(const EntrySearch& in, const Visit& visit) {
  const auto s = static_cast<Index>(blockIdx.x);
  const SurfacePose surface = in.placed[s];
  if (surface.kind != SurfaceKind::sphere) return;
  const CellGrid& cells = in.grid.cells.own;
  for_each_shift(in.period, [&](Vec3 shift, std::int8_t image) {
    const CellRange range = cells_near(cells, surface.point + shift, surface.radius + in.search_radius);
    const Index nx = range.upper.x - range.lower.x + 1, ny = range.upper.y - range.lower.y + 1,
                nz = range.upper.z - range.lower.z + 1;
    for (Index c = static_cast<Index>(threadIdx.x); c < nx * ny * nz; c += kSearchThreads) {
      const Index x = range.lower.x + c % nx, y = range.lower.y + c / nx % ny,
                  z = range.lower.z + c / (nx * ny);
      const Index key = in.grid.key(x, y, z);
      for (Index i = in.starts[key]; i < in.starts[key + 1]; ++i)
        if (surface_pair(surface, shift, in.position[i]).geometry.overlap > -in.skin)
          visit(i, in.numbers.ground + s, image);
    }
  });
}

__global__ void __launch_bounds__(kSearchThreads)
    count_near_kernel(const __grid_constant__ EntrySearch in, Index* counts) {
  visit_near(in, [&](Index i, Index, std::int8_t) { atomicAdd(&counts[i], 1); });
}

__global__ void __launch_bounds__(kSearchThreads)
    fill_near_kernel(const __grid_constant__ EntrySearch in, Index* next, EntryOutputs out) {
  visit_near(in, [&](Index i, Index surface, std::int8_t image) {
    const Index slot = atomicAdd(&next[i], 1);
    out.surfaces[slot] = surface, out.images[slot] = image;
  });
}

// The same for a plane on a body.
struct PlaneCountItem {
  EntrySearch in;
  Index placed;
  Index* counts;
  __device__ bool near(Index i) const {
    return surface_pair(in.placed[placed], {}, in.position[i]).geometry.overlap > -in.skin;
  }
  __device__ void operator()(Index i) const { counts[i] += near(i); }
};
struct PlaneFillItem {
  PlaneCountItem of;
  Index number;
  Index* next;
  EntryOutputs out;
  __device__ void operator()(Index i) const {
    if (!of.near(i)) return;
    const Index slot = next[i]++;
    out.surfaces[slot] = number, out.images[slot] = kZeroShift;
  }
};

// Sorts the entries of a row by surface and image: threads wrote them in any order.
struct OrderItem {
  const Index* offsets;
  EntryOutputs out;
  __device__ void operator()(Index i) const {
    for (Index k = offsets[i]; k < offsets[i + 1]; ++k) out.particles[k] = i;
    for (Index k = offsets[i] + 1; k < offsets[i + 1]; ++k) {
      const Index surface = out.surfaces[k];
      const std::int8_t image = out.images[k];
      Index to = k;
      for (; to > offsets[i] && (out.surfaces[to - 1] > surface ||
                                 (out.surfaces[to - 1] == surface && out.images[to - 1] > image));
           --to)
        out.surfaces[to] = out.surfaces[to - 1], out.images[to] = out.images[to - 1];
      out.surfaces[to] = surface, out.images[to] = image;
    }
  }
};

// Entries with static planes come last, after those with all placed surfaces.
struct SurfaceKeyItem {
  const Index* surfaces;
  SurfaceNumbers numbers;
  unsigned last;
  unsigned* keys;
  SCREE_HD void operator()(Index entry) const {
    const Index number = surfaces[entry];
    keys[entry] = numbers.is_static(number) ? last : static_cast<unsigned>(numbers.placed(number));
  }
};

}  // namespace

DeviceSurfaces::DeviceSurfaces(const Model& model, Vec3 period, cudaStream_t stream)
    : box_{model.space.min, period},
      interaction_range_(model.contact.interaction_range),
      meshes_(model, stream),
      works_(model, stream),
      moves_(model.rotates()),
      h_index_(1) {
  const SurfaceSet surfaces(model);
  ground_ = surfaces.ground(), placed_count_ = surfaces.placed(), all_static_ = surfaces.is_static();
  planes_.upload(wall_planes(model), stream);
  for (Index s = 0; s < placed_count_; ++s)
    if (surfaces.at(s).kind == SurfaceKind::plane)
      placed_planes_.push_back(s), plane_numbers_.push_back(surfaces.number_of(s));
}

void DeviceSurfaces::build(Device device, const Particles& particles, const SurfacePoses& poses, Real skin) {
  material_ = particles.material;
  upload(device, poses);
  find_entries(device, particles, poses, skin);
  if (any_placed()) group_by_surface(device);
}

void DeviceSurfaces::find_entries(Device device, const Particles& p, const SurfacePoses& poses, Real skin) {
  const auto owned = static_cast<std::size_t>(p.owned);
  offsets_.resize(owned + 1);
  Index *const counts = offsets_.data(), *const next = p.numbers;  // converts counts to offsets in place
  const EntrySearch in{p.position, p.active,  *p.grid,         p.starts,   p.largest_radius + skin,
                       skin,       numbers(), poses_.placed(), box_.period};
  const auto blocks = static_cast<unsigned>(placed_count_);
  // The scan also reads the entry past the end, although no offset depends on it.
  require_cuda(cudaMemsetAsync(counts + owned, 0, sizeof(Index), device.stream), "cudaMemsetAsync");
  for_each(device, p.owned, GroundCountItem{in, counts});
  if (any_placed() && p.active > 0)
    count_near_kernel<<<blocks, kSearchThreads, 0, device.stream>>>(in, counts);
  require_cuda(cudaGetLastError(), "surfaces near particles");
  for (const Index s : placed_planes_) for_each(device, p.active, PlaneCountItem{in, s, counts});
  meshes_.find(
      device,
      {p.position, *p.grid, p.starts, skin, box_.period, poses_.placed(), poses_.frames(), p.stored_contacts},
      poses, p.largest_radius, counts);
  with_space(space_, [&](void* at, std::size_t& bytes) {
    require_cuda(cub::DeviceScan::ExclusiveSum(at, bytes, offsets_.data(), p.owned + 1, device.stream),
                 "scan");
  });
  copy_async(h_index_.data(), offsets_.data() + owned, 1, device.stream);
  wait_for(device.stream);
  entries_ = h_index_[0];
  const auto entries = static_cast<std::size_t>(entries_);
  surfaces_.resize_with_spare(entries), particles_.resize_with_spare(entries);
  images_.resize_with_spare(entries);
  meshes_.reserve_entries(entries_);
  if (entries_ == 0) return;
  const EntryOutputs out{surfaces_.data(), particles_.data(), images_.data()};
  for_each(device, p.owned, GroundFillItem{in, offsets_.data(), next, out});
  if (any_placed() && p.active > 0) {
    fill_near_kernel<<<blocks, kSearchThreads, 0, device.stream>>>(in, next, out);
    require_cuda(cudaGetLastError(), "surfaces near particles");
    for (std::size_t k = 0; k < placed_planes_.size(); ++k)
      for_each(device, p.active,
               PlaneFillItem{{in, placed_planes_[k], nullptr}, plane_numbers_[k], next, out});
    meshes_.fill(device, next, out.surfaces, out.images);
  }
  for_each(device, p.owned, OrderItem{offsets_.data(), out});
  meshes_.group(device, offsets_.data(), surfaces_.data(), images_.data());
}

void DeviceSurfaces::group_by_surface(Device device) {
  const auto last = static_cast<unsigned>(placed_count_);
  const auto entries = static_cast<std::size_t>(entries_);
  for_each(device, entries_, SurfaceKeyItem{surfaces_.data(), numbers(), last, by_surface_.keys(entries)});
  by_surface_.sort(device, entries_, last);
  h_starts_.resize(static_cast<std::size_t>(placed_count_) + 1);
  copy_async(h_starts_.data(), by_surface_.starts(), h_starts_.size(), device.stream);
  for (DeviceArray<SurfaceLoad>& loads : loads_) loads.resize_with_spare(entries);
  steps_.resize_with_spare(entries);
}

// Divides the entries of each surface into chunks.
void DeviceSurfaces::complete(Device device) {
  if (!any_placed()) return;
  wait_for(device.stream);
  const PinnedArray<Index>& starts = h_starts_;
  placed_entries_ = starts[static_cast<std::size_t>(placed_count_)];
  h_chunks_.clear();
  for (Index s = 0; s < placed_count_; ++s)
    for (Index first = starts[s]; first < starts[s + 1]; first += kChunkEntries)
      h_chunks_.push_back({s, first, std::min(first + kChunkEntries, starts[s + 1])});
  chunks_.resize_with_spare(h_chunks_.size());
  copy_async(chunks_.data(), h_chunks_.data(), h_chunks_.size(), device.stream);
  load_sums_.prepare(device, {starts.data(), starts.size()});
}

void DeviceSurfaces::upload(Device device, const SurfacePoses& poses) {
  if (any_placed()) poses_.upload(device, poses);
}

void DeviceSurfaces::store_start(Device device) {
  if (any_placed()) poses_.store_start(device);
}

SurfaceViews DeviceSurfaces::entry_views(const DeviceContactKernels& kernels,
                                         const SurfaceQuery& query) const {
  return {query.position,
          query.velocity,
          material_,
          {surfaces_.data(), images_.data(), particles_.data(), by_surface_.order()},
          poses_.placed(),
          poses_.frames(),
          numbers(),
          meshes_.rows(),
          meshes_.touches(),
          meshes_.before(),
          box_,
          query.history,
          records_of(kernels.traits().history),
          query.spin,
          query.h,
          interaction_range_,
          nullptr,
          nullptr,
          poses_.free_bodies()};
}

void DeviceSurfaces::find_loads(Device device, Follows follows, const DeviceContactKernels& kernels,
                                Loads which, const SurfaceQuery& query, const ControlReport& report) {
  const SurfaceViews views = entry_views(kernels, query);
  meshes_.touch(device, views, follows);
  kernels.surface_loads(device, after_touches(follows), views, load_sums_.chunks(),
                        loads_[which == Loads::of_step ? 0 : 1].data(), load_sums_.next(report));
}

void DeviceSurfaces::reserve_in_run(Device device, Index steps) {
  works_.reserve_entries(device, std::int64_t{steps} * placed_entries_);
}

void DeviceSurfaces::find_loads_in_run(Device device, const DeviceContactKernels& kernels,
                                       const OpenStepQuery& query, Real h, Follows follows) {
  const SurfaceViews views = entry_views(kernels, {nullptr, nullptr, nullptr, {}, h});
  meshes_.touch_in_run(device, views, query, follows);
  kernels.surface_loads_in_run(device, after_touches(follows), views, query, placed_entries_,
                               loads_[0].data());
  works_.accumulate_in_run(device, views, meshes_.groups(), {loads_[0].data(), h, moves_}, query.control);
}

std::string DeviceSurfaces::key_of_loads(const DeviceContactKernels& kernels, const OpenStepQuery& query,
                                         Real h) const {
  return key_of(entry_views(kernels, {nullptr, nullptr, nullptr, {}, h})) + key_of(query) +
         key_of(meshes_.groups()) + key_of(placed_entries_);
}

void DeviceSurfaces::find_steps(Device device, const DeviceContactKernels& kernels,
                                const FrictionStart& start, const SurfaceQuery& query) {
  if (moves_) friction_steps_.resize_with_spare(static_cast<std::size_t>(entries_));
  h_step_sums_.resize_with_spare(h_chunks_.size());
  meshes_.reserve_over_step(entries_);
  const SurfaceViews views = entry_views(kernels, query);
  meshes_.touch_over_step(device, views, start.step.position, poses_.start());
  kernels.surface_steps(device, views, chunk_list(), {start, poses_.start()},
                        {steps_.data(), friction_steps_.data()}, h_step_sums_.data());
}

const ShownContact* DeviceSurfaces::find_shown(Device device, const DeviceContactKernels& kernels,
                                               const SurfaceQuery& query) {
  if (!any_placed()) return nullptr;
  shown_.resize_with_spare(static_cast<std::size_t>(entries_));
  kernels.shown_surfaces(device, entry_views(kernels, query), placed_entries_, loads_[0].data(),
                         shown_.data());
  return shown_.data();
}

void DeviceSurfaces::accumulate_load_works(Device device, const DeviceContactKernels& kernels, Real h) {
  works_.reserve_entries(device, placed_entries_);
  works_.accumulate(device, entry_views(kernels, {}), meshes_.groups(),
                    ExplicitWorks{loads_[0].data(), h, moves_});
}

void DeviceSurfaces::accumulate_step_works(Device device, const DeviceContactKernels& kernels) {
  works_.reserve_entries(device, placed_entries_);
  const SurfaceViews views = entry_views(kernels, {});
  if (moves_)
    works_.accumulate(device, views, meshes_.groups(), ImplicitFrictionWorks{friction_steps_.data()});
  else
    works_.accumulate(device, views, meshes_.groups(), ImplicitWorks{steps_.data()});
}

std::vector<StepSums> DeviceSurfaces::step_sums() const {
  std::vector<StepSums> out;
  for (std::size_t k = 0; k < h_step_sums_.size(); ++k)
    if (h_step_sums_[k].contacts > 0) out.push_back(h_step_sums_[k]);
  return out;
}

std::vector<TriangleSums> DeviceSurfaces::triangle_sums(Device device,
                                                        std::span<const WallPlane> planes) const {
  if (!meshes_.exist() || entries_ == 0) return {};
  const std::vector<MeshGroup> groups = meshes_.download_groups(device.stream);
  const std::vector<MeshTouch> touches = meshes_.download_touches(device.stream);
  const std::vector<Index> surfaces = surfaces_.download(device.stream);
  const std::vector<SurfaceLoad> loads = loads_[0].download(device.stream);
  return scree::triangle_sums({groups, surfaces, touches, loads}, {planes.data(), ground_});
}

}  // namespace scree
