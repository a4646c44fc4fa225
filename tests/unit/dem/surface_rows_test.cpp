// Which surfaces each particle is near, against a search over all of them and their images.
#include "dem/surface_rows.hpp"

#include <algorithm>
#include <tuple>
#include <vector>

#include "dem/neighbor_list.hpp"
#include "dem/surface_side.hpp"
#include "random_box.hpp"
#include "support/catch.hpp"

namespace scree {

namespace {

constexpr Real kSkin = 0.03;
constexpr Index kParticles = 150, kDrifting = 7;

// Surface and number of its image.
using Entry = std::pair<Index, int>;

// The list of a rank that has every particle of the model.
struct BuiltRows {
  explicit BuiltRows(const Model& of)
      : model(of),
        subdomain(model.space),
        side(model, subdomain, {}),
        builder(model),
        motion(motion_of(model.bodies)) {
    side.set_motion(motion);
    side.bring_into_box();
    side.place();
    store.load(initial_records(model.particles, subdomain));
    layout.owned = layout.items = store.owned, layout.active = store.owned - kDrifting;
    builder.build(store, layout, builder.cells(kSkin, store.owned), side.places(), kSkin, list);
  }
  std::vector<Entry> row(Index i) const {
    const SurfaceRows& rows = list.surfaces;
    std::vector<Entry> out;
    for (Index k = rows.offsets[i]; k < rows.offsets[i + 1]; ++k) {
      CHECK(rows.particles[k] == i);
      out.emplace_back(rows.surfaces[k], rows.images[k]);
    }
    return out;
  }
  Model model;
  Subdomain subdomain;
  SurfaceSide side;
  NeighborBuilder builder;
  std::vector<BodyMotion> motion;
  ParticleStore store;
  ItemLayout layout;
  NeighborList list;
};

std::vector<Entry> expected_row(const BuiltRows& built, Index i) {
  std::vector<Entry> row;
  if (i >= built.layout.active) return row;
  const Vec4 p = built.store.position[i];
  for (Index w = 0; w < static_cast<Index>(built.model.walls.size()); ++w)
    if (dot(xyz(p) - built.model.walls[w].point, built.model.walls[w].normal) < p.w + kSkin)
      row.emplace_back(w, kNoShift);
  Index surface = built.side.surfaces().ground();
  for (const PlacedSurface& s : built.side.placed()) {
    for_each_shift(built.subdomain.period(), [&](Vec3 shift, std::int8_t image) {
      if (norm(xyz(p) - s.point - shift) < p.w + s.radius + kSkin) row.emplace_back(surface, image);
    });
    ++surface;
  }
  return row;
}

}  // namespace

TEST_CASE("a particle's row holds every surface and image in reach, once, in their order") {
  std::size_t on_bodies = 0, images = 0, on_ground = 0;
  for (const BoxCase& box : kBoxes)
    for (const std::uint64_t seed : {1, 2, 3}) {
      CAPTURE(box.name, seed);
      const BuiltRows built(random_box(box, kParticles, seed));
      for (Index i = 0; i < kParticles; ++i) {
        CAPTURE(i);
        const std::vector<Entry> row = built.row(i);
        CHECK(row == expected_row(built, i));
        for (const Entry& entry : row) {
          const bool ground = entry.first < built.side.surfaces().ground();
          on_ground += ground, on_bodies += !ground, images += entry.second != kNoShift;
        }
      }
    }
  CHECK(on_ground > 30);
  CHECK(on_bodies > 100);
  CHECK(images > 0);
}

TEST_CASE("the entries with bodies are listed surface by surface, each once") {
  for (const BoxCase& box : kBoxes) {
    CAPTURE(box.name);
    const BuiltRows built(random_box(box, kParticles, 4));
    const SurfaceRows& rows = built.list.surfaces;
    std::vector<Index> entries = rows.by_surface, expected;
    for (Index k = 0; k < static_cast<Index>(rows.surfaces.size()); ++k)
      if (rows.surfaces[k] >= built.side.surfaces().ground()) expected.push_back(k);
    CHECK(std::is_sorted(entries.begin(), entries.end(),
                         [&](Index a, Index b) { return rows.surfaces[a] < rows.surfaces[b]; }));
    std::sort(entries.begin(), entries.end());
    CHECK(entries == expected);
  }
}

TEST_CASE(
    "a shape far larger than the particles finds all that it touches, and leaves the cells as they are") {
  Model model = random_box(kBoxes[0], 2000, 5);
  for (Real& radius : model.particles.radius) radius = 0.004;
  count_particles(model.particles, 1);
  Body body;
  body.mass = 1, body.inertia = 1, body.position = {0.1, -0.2, 0};
  body.shapes = {{{0.3, 0.1, 0}, 0.5, 0}};
  model.bodies = {body};
  const BuiltRows built(model);
  CHECK(built.builder.cutoff(kSkin) == 2 * 0.004 + kSkin);
  std::size_t found = 0;
  for (Index i = 0; i < 2000; ++i) {
    CHECK(built.row(i) == expected_row(built, i));
    found += built.row(i).size();
  }
  CHECK(found > 300);
}

}  // namespace scree
