// The surfaces near each particle, against a search over all of them and their images.
#include "dem/search/surface_rows.hpp"

#include <algorithm>
#include <tuple>
#include <vector>

#include "dem/host/host_surfaces.hpp"
#include "dem/search/neighbor_list.hpp"
#include "mesh/mesh_contacts.hpp"
#include "mesh/mesh_tree.hpp"
#include "random_box.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"

namespace scree {

namespace {

constexpr Real kSkin = 0.03;
constexpr Index kParticles = 150, kDrifting = 7;

// Surface and number of its image.
using Entry = std::pair<Index, int>;

// The list of a rank with all particles of the model.
struct BuiltRows {
  explicit BuiltRows(const Model& of)
      : model(of),
        subdomain(model.space),
        side(model, subdomain, {}),
        builder(model),
        motion(carriers_of(model)) {
    side.set_motion(motion);
    side.plan_list(kSkin, HostSurfaces::kNoMotion);
    side.bring_into_box();
    side.update_poses();
    store.load(initial_records(model.particles, subdomain));
    layout.owned = layout.items = store.owned, layout.active = store.owned - kDrifting;
    builder.build(store, layout, builder.cells(kSkin, store.owned), {side.poses()}, kSkin, list);
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
  HostSurfaces side;
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
      row.emplace_back(w, kZeroShift);
  Index surface = built.side.surfaces().ground();
  for (const SurfacePose& s : built.side.placed()) {
    for_each_shift(built.subdomain.period(), [&](Vec3 shift, std::int8_t image) {
      if (norm(xyz(p) - s.point - shift) < p.w + s.radius + kSkin) row.emplace_back(surface, image);
    });
    ++surface;
  }
  return row;
}

// A beam of triangles on a body that is skewed across periodic sides, a ring on the ground, and particles.
const char* const kParticlesAndMeshes = R"(
[space]
dimension = 3
min = [-1.0, -1.0, -1.0]
max = [1.0, 1.0, 1.0]
x_min = "periodic"
x_max = "periodic"
z_min = "periodic"
z_max = "periodic"
leaving = "ballistic"
[time]
end = 1.0
step = 1e-4
[integrator]
particles = "velocity-verlet"
[[materials]]
name = "grain"
[[contact.pairs]]
stiffness = 1e4
damping = 1.0
[[meshes]]
name = "beam"
kind = "box"
size = [1.2, 0.1, 0.05]
refine = 0.1
[[meshes]]
name = "ring"
kind = "pipe"
radius = 0.5
inner_radius = 0.4
length = 0.2
segments = 24
[[walls]]
name = "ring"
mesh = "ring"
[[bodies]]
name = "beam"
kind = "spatial"
position = [0.9, 0.2, -0.9]
quaternion = [0.8, 0.36, 0.48, 0.0]
solids = [{ kind = "mesh", mesh = "beam", density = 1000.0 }]
meshes = [{ mesh = "beam" }]
[[particles]]
name = "grains"
kind = "random"
count = 5000
min = [-1.0, -1.0, -1.0]
max = [1.0, 1.0, 1.0]
radius = { kind = "uniform", min = 0.02, max = 0.05 }
density = 1000.0
seed = 3
)";

// The triangles within `past` of particle i, image by image, in the order of the groups.
std::vector<std::vector<Index>> triangles_in_range(const BuiltRows& built, Index i, Index s, Real past) {
  const SurfacePoses places = built.side.poses();
  const SurfacePose& surface = places.placed[static_cast<std::size_t>(s)];
  const SurfaceFrame& frame = places.frames[static_cast<std::size_t>(surface.frame)];
  const MeshView& mesh = places.meshes[static_cast<std::size_t>(frame.mesh)];
  const Vec4 p = built.store.position[i];
  const Real limit = (p.w + past) * (p.w + past);
  std::vector<std::vector<Index>> groups;
  for_each_shift(built.subdomain.period(), [&](Vec3 shift, std::int8_t) {
    std::vector<Index> near;
    for (Index t = 0; t < mesh.triangle_count; ++t)
      if (is_nearer(mesh, t, transposed_times(frame.axes, xyz(p) - shift - surface.point), limit))
        near.push_back(t);
    if (!near.empty()) groups.push_back(near);
  });
  return groups;
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
          on_ground += ground, on_bodies += !ground, images += entry.second != kZeroShift;
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

TEST_CASE("rows hold the triangles that come near a particle, farther out of meshes that move") {
  const BuiltRows built(model_of(kParticlesAndMeshes));
  const SurfaceRows& rows = built.list.surfaces;
  std::size_t found = 0, images = 0;
  for (Index s = 0; s < built.side.size(); ++s) {
    const bool moves = built.side.surfaces().is_on_body(s);
    std::vector<std::vector<std::vector<Index>>> of_particle(static_cast<std::size_t>(built.layout.active));
    for (const MeshGroup& g : rows.groups) {
      if (rows.surfaces[g.entry] != built.side.surfaces().number_of(s)) continue;
      const auto first = rows.triangles.begin() + g.first_triangle;
      of_particle[static_cast<std::size_t>(rows.particles[g.entry])].emplace_back(first, first + g.triangles);
      ++found, images += rows.images[g.entry] != kZeroShift;
    }
    for (Index i = 0; i < built.layout.active; ++i) {
      CAPTURE(s, i);
      const Real past = mesh_skin(built.store.position[i].w, moves ? kMeshSkins * kSkin : kSkin);
      CHECK(of_particle[static_cast<std::size_t>(i)] == triangles_in_range(built, i, s, past));
    }
  }
  CHECK(found > 50);
  CHECK(images > 10);
}

}  // namespace scree
