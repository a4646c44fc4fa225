// Parts, patches, edges and vertices of meshes that may be touched, in known numbers.
#include "mesh/mesh_topology.hpp"

#include <set>

#include "mesh/surface_mesh.hpp"
#include "support/bits.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/test_meshes.hpp"

namespace scree {

namespace {

struct Counts {
  int parts, patches, edges, vertices;
  bool operator==(const Counts&) const = default;
};

std::ostream& operator<<(std::ostream& out, const Counts& c) {
  return out << c.parts << " parts, " << c.patches << " patches, " << c.edges << " edges, " << c.vertices
             << " vertices";
}

Counts counts_of(const SurfaceMesh& mesh) {
  Counts counts{static_cast<int>(mesh.parts.size()), static_cast<int>(mesh.first_neighbour.size()) - 1, 0, 0};
  for (const MeshFeature& feature : mesh.features) ++(feature.b < 0 ? counts.vertices : counts.edges);
  return counts;
}

}  // namespace

TEST_CASE("bodies with sharp edges have a part and a patch per side") {
  CHECK(counts_of(closed_mesh(block({0, 0, 0}, {1, 1, 1}, 1))) == Counts{6, 6, 12, 8});
  CHECK(counts_of(closed_mesh(block({-1, 2, 0}, {1, 5, 7}, 4))) == Counts{6, 6, 48, 44});
  CHECK(counts_of(closed_mesh(tetrahedron())) == Counts{4, 4, 6, 4});
}

TEST_CASE("a smooth body has one patch and a part per triangle") {
  CHECK(counts_of(closed_mesh(icosphere(2, 1))) == Counts{320, 1, 480, 162});
  // The angle at an icosahedron's edges is 42 degrees.
  CHECK(counts_of(closed_mesh(icosphere(0, 1))) == Counts{20, 20, 30, 12});
}

TEST_CASE("concave edges of a closed mesh are never touched, those of an open surface are") {
  CHECK(counts_of(closed_mesh(flipped(icosphere(2, 1)))) == Counts{320, 1, 0, 0});
  CHECK(counts_of(sheet_mesh(flipped(icosphere(2, 1)))) == Counts{320, 1, 480, 162});
}

TEST_CASE("a flat mesh is one part with its border, whatever its triangles") {
  for (const TriangleMesh& mesh : {unit_grid(10, 10), jittered_grid(10, 1)}) {
    CHECK(counts_of(sheet_mesh(mesh)) == Counts{1, 1, 40, 40});
    CHECK(same_bits(sheet_mesh(mesh).parts[0].normal, Vec3{0, 0, 1}));
    CHECK(same_bits(sheet_mesh(flipped(mesh)).parts[0].normal, Vec3{0, 0, -1}));
  }
  CHECK(counts_of(sheet_mesh(unit_grid(1, 1000))) == Counts{1, 1, 2002, 2002});
}

TEST_CASE("an edge with three faces is touched in every corner between them") {
  TriangleMesh mesh = plate({-1, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, 1);
  append(mesh, plate({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, 1));
  append(mesh, plate({0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 1, 1));
  const SurfaceMesh three = sheet_mesh(welded(mesh));
  CHECK(counts_of(three) == Counts{3, 3, 10, 8});
  CHECK(contacts_at(three, {0.1, 0.5, 0.1}, 0.2).size() == 2);
  CHECK(contacts_at(three, {-0.1, 0.5, 0.1}, 0.2).size() == 2);
  CHECK(contacts_at(three, {0.1, 0.5, -0.1}, 0.2).size() == 1);
  const auto below = contacts_at(three, {0, 0.5, -0.1}, 0.2);
  REQUIRE(below.size() == 1);
  CHECK(near(below[0].normal, {0, 0, -1}, {.absolute = kUlp}));
}

TEST_CASE("a step of any height separates two flats, round-off does not") {
  // Up a riser from z = 0 to z = step, along x = 1.
  const auto stairs = [](Real step) {
    return strip({{0, 0, 0}, {1, 0, 0}, {1, 0, step}, {2, 0, step}}, 1, 3);
  };
  for (const Real step : {0.5, 1e-3, 1e-9, 1e-11}) {
    const SurfaceMesh mesh = sheet_mesh(stairs(step));
    CHECK(mesh.parts.size() == 3);
    CHECK(contacts_at(mesh, {0.5, 0.5, 0.1}, 0.2).at(0).distance == 0.1);
    CHECK(contacts_at(mesh, {1.5, 0.5, step + 0.1}, 0.2).at(0).distance == step + 0.1 - step);
  }
  MeshRandom random(51);
  const SurfaceMesh noisy = sheet_mesh(mapped(jittered_grid(20, 1), [&](Vec3 v) {
    return Vec3{v.x, v.y, random.in(-1e-13, 1e-13)};
  }));
  CHECK(noisy.parts.size() == 1);
}

TEST_CASE("slivers join the plane of their neighbours, whatever their own normals") {
  MeshRandom random(52);
  // Slivers 1e-9 wide along all sides, rotated so that all coordinates are rounded.
  const Real lines[] = {0, 1e-9, 0.5, 1 - 1e-9, 1};
  const TriangleMesh mesh = mapped(unit_grid(4, 4), [&](Vec3 v) {
    return Vec3{lines[static_cast<int>(4 * v.x)], lines[static_cast<int>(4 * v.y)], 0};
  });
  for (int i = 0; i < 10; ++i) CHECK(sheet_mesh(rotated(mesh, random.turn())).parts.size() == 1);
  // Slivers alone, none of which defines the plane accurately to the far end.
  CHECK(sheet_mesh(rotated(unit_grid(1, 30000), random.turn())).parts.size() == 1);
}

// Queries and all bounds on them use the plane of the part for each triangle.
TEST_CASE("vertices lie within the stated flatness of their part's plane, slivers included") {
  MeshRandom random(53);
  int off = 0;
  for (int i = 0; i < 100; ++i) {
    const SurfaceMesh mesh =
        sheet_mesh(rotated({{{0, 0, 0}, {0.33, 0, 0}, {0.17, 7e-10, 0}}, {{0, 1, 2}}}, random.turn()));
    REQUIRE(mesh.parts.size() == 1);
    for (const Vec3& v : mesh.vertices) {
      const Real distance = std::abs(dot(v - mesh.parts[0].point, mesh.parts[0].normal));
      CHECK(distance <= mesh.flatness);
      off += distance > 1e-11;
    }
  }
  CHECK(off > 10);
}

TEST_CASE("a flat that folds back on itself is two parts") {
  const auto second_corner_at = [](Vec3 p) {
    return TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, p}, {{0, 1, 2}, {2, 1, 3}}};
  };
  CHECK(sheet_mesh(second_corner_at({0.8, 0.8, 0})).parts.size() == 1);
  CHECK(sheet_mesh(second_corner_at({0.2, 0.2, 0})).parts.size() == 2);
}

TEST_CASE("a drum whose facets differ by the feature angle itself has a patch per facet") {
  for (const int facets : {3, 4, 6, 12}) {
    const SurfaceMesh drum = sheet_mesh(drum_shell(facets, 1, 1, 2));
    CHECK(drum.first_neighbour.size() == static_cast<std::size_t>(facets) + 1);
    CHECK(drum.neighbours.size() == 2 * static_cast<std::size_t>(facets));
  }
  CHECK(sheet_mesh(drum_shell(13, 1, 1, 2)).first_neighbour.size() == 2);
}

TEST_CASE("triangles keep their numbers in the file, and every one is in the order of the curve once") {
  const TriangleMesh mesh = icosphere(3, 2);
  const SurfaceMesh surface = closed_mesh(mesh);
  std::set<Index> numbers(surface.original.begin(), surface.original.end());
  CHECK(numbers.size() == mesh.triangles.size());
  bool same = true;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      same = same && same_bits(surface.vertices[surface.triangles[t].vertex[k]],
                               mesh.vertices[mesh.triangles[surface.original[t]][k]]);
  CHECK(same);
}

}  // namespace scree
