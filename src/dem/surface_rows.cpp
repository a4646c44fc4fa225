#include "dem/surface_rows.hpp"

#include "base/countable.hpp"
#include "partition/halo_plan.hpp"

namespace scree {
namespace {

struct Entry {
  Index particle, surface;
  std::int8_t image;
};

template <class Visit>
void for_each_in(const SortedParticles& sorted, const CellRange& range, const Visit& visit) {
  const CellGrid& grid = sorted.grid;
  for (Index z = range.lower.z; z <= range.upper.z; ++z)
    for (Index y = range.lower.y; y <= range.upper.y; ++y)
      for (Index k = sorted.start[grid.index(range.lower.x, y, z)];
           k < sorted.start[grid.index(range.upper.x, y, z) + 1]; ++k)
        if (const Index i = sorted.items[k]; i < sorted.active) visit(i);
}

// With the surfaces on bodies, in their order.
std::vector<Entry> entries_on_bodies(const SortedParticles& sorted, std::span<const PlacedSurface> placed,
                                     Vec3 period, Index ground, Real skin) {
  std::vector<Entry> entries;
  for (std::size_t s = 0; s < placed.size(); ++s)
    for_each_shift(period, [&](Vec3 shift, std::int8_t image) {
      const Vec3 point = placed[s].point + shift;
      const Real reach = placed[s].radius + sorted.largest_radius + skin;
      for_each_in(sorted, cells_near(sorted.grid, point, reach), [&](Index i) {
        const Vec4 p = sorted.position[i];
        const SurfacePair pair = surface_pair(placed[s], shift, p);
        if (pair.geometry.overlap > -skin) entries.push_back({i, ground + static_cast<Index>(s), image});
      });
    });
  return entries;
}

}  // namespace

void build_rows(const SortedParticles& sorted, Index owned, std::span<const WallPlane> planes,
                std::span<const PlacedSurface> placed, Vec3 period, Real skin, SurfaceRows& rows) {
  const auto ground = static_cast<Index>(planes.size());
  const std::vector<Entry> on_bodies = entries_on_bodies(sorted, placed, period, ground, skin);
  std::vector<Index> counts(static_cast<std::size_t>(owned));
  for (const Entry& entry : on_bodies) ++counts[entry.particle];
  rows.offsets.assign(1, 0), rows.surfaces.clear();
  std::vector<Index> next;  // of the entries with bodies
  for (Index i = 0; i < owned; ++i) {
    for (Index w = 0; i < sorted.active && w < ground; ++w)
      if (wall_pair(sorted.position[i], planes[w]).distance < sorted.position[i].w + skin)
        rows.surfaces.push_back(w);
    next.push_back(static_cast<Index>(rows.surfaces.size()));
    rows.surfaces.resize(rows.surfaces.size() + static_cast<std::size_t>(counts[i]));
    rows.offsets.push_back(countable(rows.surfaces.size(), "stage neighbors: more surfaces near particles"));
  }
  rows.images.assign(rows.surfaces.size(), kNoShift), rows.particles.assign(rows.surfaces.size(), 0);
  rows.by_surface.clear();
  for (const Entry& entry : on_bodies) {
    const Index slot = next[entry.particle]++;
    rows.surfaces[slot] = entry.surface, rows.images[slot] = entry.image,
    rows.particles[slot] = entry.particle;
    rows.by_surface.push_back(slot);
  }
}

}  // namespace scree
