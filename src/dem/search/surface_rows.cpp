#include "dem/search/surface_rows.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/countable.hpp"
#include "mesh/mesh_contacts.hpp"
#include "partition/halo_plan.hpp"
#include "partition/level_grids.hpp"

namespace scree {
namespace {

struct Entry {
  Index particle, surface;
  std::int8_t image;
};

// Calls visit(particle) for the particles of each level in the cells near(level).
template <class Near, class Visit>
void for_each_in(const SortedParticles& sorted, const Near& near, const Visit& visit) {
  for (const LevelGrid& level : sorted.cells.levels) {
    if (level.items == 0) continue;
    sorted.cells.for_each_run(level, near(level), [&](Index first, Index last) {
      for (Index k = first; k < last; ++k)
        if (const Index i = sorted.cells.items[k]; i < sorted.active) visit(i);
    });
  }
}

// Finds the entries with placed surfaces of one rank, surface by surface.
class EntryFinder {
 public:
  EntryFinder(const SortedParticles& sorted, const SurfaceSearch& search)
      : sorted_(sorted), search_(search) {}

  std::vector<Entry> find() {
    for (Index s = 0; s < static_cast<Index>(search_.poses.placed.size()); ++s)
      for_each_shift(images_of(s), [&](Vec3 shift, std::int8_t image) {
        const Entry entry{0, search_.surfaces.number_of(s), image};
        switch (search_.poses.placed[static_cast<std::size_t>(s)].kind) {
          case SurfaceKind::sphere:
            return add_near_sphere(s, shift, entry);
          case SurfaceKind::plane:
            return add_near_plane(s, shift, entry);
          case SurfaceKind::mesh:
            return add_near_mesh(s, shift, entry);
        }
      });
    return std::move(entries_);
  }

 private:
  // Periods along which the surface has images [m].
  Vec3 images_of(Index s) const {
    if (placed(s).kind == SurfaceKind::sphere) return search_.period;
    return search_.period - search_.poses.frames[static_cast<std::size_t>(placed(s).frame)].spanned;
  }
  void add_near_sphere(Index s, Vec3 shift, Entry entry) {
    const SurfacePose& surface = placed(s);
    const auto near = [&](const LevelGrid& level) {
      return cells_near(level.grid, surface.point + shift, surface.radius + level.radius + search_.skin);
    };
    for_each_in(sorted_, near, [&](Index i) {
      const SurfacePair pair = surface_pair(surface, shift, position(i));
      if (pair.geometry.overlap > -search_.skin && may_touch(i, s)) add(entry, i, 1);
    });
  }
  // A plane has no images, because it cannot be periodic along its normal.
  void add_near_plane(Index s, Vec3 shift, Entry entry) {
    if (entry.image != kZeroShift) return;
    for (Index i = 0; i < sorted_.active; ++i)
      if (surface_pair(placed(s), shift, position(i)).geometry.overlap > -search_.skin && may_touch(i, s))
        add(entry, i, 1);
  }
  void add_near_mesh(Index s, Vec3 shift, Entry entry) {
    const Real skin = search_.poses.skin_of(s, search_.skin);
    const auto near = [&](const LevelGrid& level) {
      return cells_near(level.grid, box_near(search_.poses, s, shift, level.radius, skin));
    };
    for_each_in(sorted_, near, [&](Index i) {
      if (!may_touch(i, s)) return;
      triangles_.clear();
      const MeshQuery query = mesh_query(search_.poses, s, position(i), shift, skin);
      query.for_each_triangle([&](Index t) { triangles_.push_back(t); });
      const auto count = static_cast<Index>(triangles_.size());
      if (count == 0) return;
      const Index stored_contacts = search_.stored_contacts ? search_.stored_contacts(i, entry.surface) : 0;
      const RowKind kind = kind_of_row(query.mesh, triangles_.data(), count);
      add(entry, i, query.entries(kind, triangles_.data(), count, stored_contacts));
    });
  }
  void add(Entry entry, Index particle, Index times) {
    entry.particle = particle;
    entries_.insert(entries_.end(), static_cast<std::size_t>(times), entry);
  }
  bool may_touch(Index particle, Index s) const {
    return !search_.may_touch || search_.may_touch(particle, s);
  }
  const SurfacePose& placed(Index s) const { return search_.poses.placed[static_cast<std::size_t>(s)]; }
  Vec4 position(Index i) const { return sorted_.position[static_cast<std::size_t>(i)]; }

  const SortedParticles& sorted_;
  const SurfaceSearch& search_;
  std::vector<Entry> entries_;
  std::vector<Index> triangles_;
};

// Sorts the entries of a row by surface and image; equal ones are already adjacent.
void order_row(SurfaceRows& rows, Index first, Index end) {
  for (Index k = first + 1; k < end; ++k)
    for (Index at = k; at > first && std::pair(rows.surfaces[at - 1], rows.images[at - 1]) >
                                         std::pair(rows.surfaces[at], rows.images[at]);
         --at) {
      std::swap(rows.surfaces[at - 1], rows.surfaces[at]);
      std::swap(rows.images[at - 1], rows.images[at]);
    }
}

void group_by_surface(const SurfaceNumbers& numbers, Index placed, SurfaceRows& rows) {
  std::vector<Index> next(static_cast<std::size_t>(placed) + 1);
  for (const Index number : rows.surfaces)
    if (!numbers.is_static(number)) ++next[numbers.placed(number) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  rows.by_surface.resize(static_cast<std::size_t>(next.back()));
  for (Index entry = 0; entry < static_cast<Index>(rows.surfaces.size()); ++entry)
    if (!numbers.is_static(rows.surfaces[entry]))
      rows.by_surface[next[numbers.placed(rows.surfaces[entry])]++] = entry;
}

// Finds the triangles of all pairs of particles and meshes near each other.
void find_groups(const SortedParticles& sorted, const SurfaceSearch& search, const SurfaceNumbers& numbers,
                 SurfaceRows& rows) {
  rows.groups.clear(), rows.triangles.clear();
  const auto entries = static_cast<Index>(rows.surfaces.size());
  for (Index entry = 0, end; entry < entries; entry = end) {
    end = entry + 1;
    const Index number = rows.surfaces[entry], s = numbers.is_static(number) ? -1 : numbers.placed(number);
    if (s < 0 || search.poses.placed[static_cast<std::size_t>(s)].kind != SurfaceKind::mesh) continue;
    const Index i = rows.particles[entry];
    while (end < entries && rows.particles[end] == i && rows.surfaces[end] == number &&
           rows.images[end] == rows.images[entry])
      ++end;
    const auto first = static_cast<Index>(rows.triangles.size());
    const MeshQuery query =
        mesh_query(search.poses, s, sorted.position[static_cast<std::size_t>(i)],
                   image_shift(rows.images[entry], search.period), search.poses.skin_of(s, search.skin));
    query.for_each_triangle([&](Index t) { rows.triangles.push_back(t); });
    const Index last = countable(rows.triangles.size(), "stage neighbors: more triangles near particles");
    const RowKind kind = kind_of_row(query.mesh, rows.triangles.data() + first, last - first);
    rows.groups.push_back({entry, end - entry, first, last - first, kind});
  }
  rows.cached_contacts.assign(rows.groups.size(), kNoCachedContact);
}

Vec3 magnitudes(Vec3 a) { return {std::abs(a.x), std::abs(a.y), std::abs(a.z)}; }

}  // namespace

Box box_near(const SurfacePoses& poses, Index s, Vec3 shift, Real radius, Real skin) {
  constexpr Real kRoundOff = 1e-9;  // of the rotated box, with a wide margin
  const SurfacePose& surface = poses.placed[static_cast<std::size_t>(s)];
  const SurfaceFrame& frame = poses.frames[static_cast<std::size_t>(surface.frame)];
  const MeshView& mesh = poses.meshes[static_cast<std::size_t>(frame.mesh)];
  const MeshBox& of_mesh = mesh.boxes[mesh.level_start[mesh.levels - 1]];
  const Vec3 half = Real(0.5) * (of_mesh.max - of_mesh.min);
  const Vec3 middle = surface.point + shift + frame.axes * (of_mesh.min + half);
  const Vec3 half_extents{dot(magnitudes(frame.axes.x), half), dot(magnitudes(frame.axes.y), half),
                          dot(magnitudes(frame.axes.z), half)};
  const Real range = radius + mesh_skin(radius, skin) + kRoundOff * (norm(half) + norm(middle));
  const auto along = [&](Real size, Real period) { return period != 0 ? kInfinity : size + range; };
  const Vec3 to_sides{along(half_extents.x, frame.spanned.x), along(half_extents.y, frame.spanned.y),
                      along(half_extents.z, frame.spanned.z)};
  return {middle - to_sides, middle + to_sides};
}

MeshQuery mesh_query(const SurfacePoses& poses, Index s, Vec4 p, Vec3 shift, Real skin) {
  const SurfacePose& surface = poses.placed[static_cast<std::size_t>(s)];
  const SurfaceFrame& frame = poses.frames[static_cast<std::size_t>(surface.frame)];
  const MeshView& mesh = poses.meshes[static_cast<std::size_t>(frame.mesh)];
  return {surface, frame, mesh, p, shift, mesh_skin(p.w, skin)};
}

void build_rows(const SortedParticles& sorted, Index owned, const SurfaceSearch& search, SurfaceRows& rows) {
  const SurfaceNumbers numbers{search.planes.data(), search.surfaces.ground()};
  const std::vector<Entry> placed = EntryFinder(sorted, search).find();
  std::vector<Index> counts(static_cast<std::size_t>(owned));
  for (const Entry& entry : placed) ++counts[entry.particle];
  rows.offsets.assign(1, 0), rows.surfaces.clear();
  std::vector<Index> next;  // next free entry of each row
  for (Index i = 0; i < owned; ++i) {
    for (Index w = 0; i < sorted.active && w < numbers.ground; ++w)
      if (numbers.is_static(w) &&
          wall_pair(sorted.position[i], search.planes[w]).distance < sorted.position[i].w + search.skin)
        rows.surfaces.push_back(w);
    next.push_back(static_cast<Index>(rows.surfaces.size()));
    rows.surfaces.resize(rows.surfaces.size() + static_cast<std::size_t>(counts[i]));
    rows.offsets.push_back(countable(rows.surfaces.size(), "stage neighbors: more surfaces near particles"));
  }
  rows.images.assign(rows.surfaces.size(), kZeroShift), rows.particles.assign(rows.surfaces.size(), 0);
  for (const Entry& entry : placed) {
    const Index slot = next[entry.particle]++;
    rows.surfaces[slot] = entry.surface, rows.images[slot] = entry.image;
  }
  for (Index i = 0; i < owned; ++i) {
    const Index first = rows.offsets[i], end = rows.offsets[i + 1];
    std::fill(rows.particles.begin() + first, rows.particles.begin() + end, i);
    order_row(rows, first, end);
  }
  group_by_surface(numbers, search.surfaces.placed(), rows);
  find_groups(sorted, search, numbers, rows);
}

}  // namespace scree
