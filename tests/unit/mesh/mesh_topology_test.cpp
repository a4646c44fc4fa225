// What a mesh consists of: parts, patches, edges and vertices that may be touched, in known numbers.
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
  // An icosahedron's edges turn by 42 degrees.
  CHECK(counts_of(closed_mesh(icosphere(0, 1))) == Counts{20, 20, 30, 12});
}

TEST_CASE("concave edges of a closed mesh are never touched, those of a sheet are") {
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
