// The tree of boxes against a test of every triangle.
#include "mesh/mesh_tree.hpp"

#include "support/catch.hpp"
#include "support/test_meshes.hpp"

namespace scree {

namespace {

std::vector<Index> every_triangle_near(const SurfaceMesh& mesh, Vec3 c, Real reach) {
  std::vector<Index> row;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Index* v = mesh.triangles[t].vertex;
    const Real square = squared_distance(mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]], c);
    if (std::sqrt(square) < reach + mesh.round_off) row.push_back(static_cast<Index>(t));
  }
  return row;
}

}  // namespace

TEST_CASE("the tree finds the triangles near a point, in order") {
  MeshRandom random(3);
  for (const TriangleMesh& mesh : {tetrahedron(), unit_grid(1, 1), unit_grid(1, 2), unit_grid(3, 3),
                                   unit_grid(8, 16), jittered_grid(33, 2), icosphere(3, 0.7)}) {
    const SurfaceMesh surface = sheet_mesh(mesh);
    bool same = true;
    for (int i = 0; i < 300; ++i) {
      const Vec3 c = random.in({-1, -1, -1}, {1.5, 1.5, 1});
      const Real reach = random.in(0.01, 1);
      same = same && triangles_near(surface, c, reach) == every_triangle_near(surface, c, reach);
    }
    CHECK(same);
  }
}

TEST_CASE("the distance from a triangle is the least to any of its points") {
  MeshRandom random(4);
  bool nearest = true, reached = true;
  for (int i = 0; i < 100; ++i) {
    const Vec3 a = random.direction(), b = random.direction(), c = random.direction(),
               p = 2 * random.direction();
    const Real square = squared_distance(a, b, c, p);
    Real least = kInfinity;
    constexpr int kParts = 100;
    for (int j = 0; j <= kParts; ++j)
      for (int k = 0; j + k <= kParts; ++k) {
        const Vec3 d = a + (Real(j) / kParts) * (b - a) + (Real(k) / kParts) * (c - a) - p;
        least = std::min(least, dot(d, d));
      }
    nearest = nearest && square <= least * (1 + 1e-12);
    reached = reached && square >= least - 0.1;
  }
  CHECK(nearest);
  CHECK(reached);
}

}  // namespace scree
