// Refinement without change of the surface.
#include "mesh/refine.hpp"

#include <cmath>

#include "base/error.hpp"
#include "mesh/mesh_checks.hpp"
#include "mesh/mesh_mass.hpp"
#include "mesh/primitives.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

Real longest_edge(const TriangleMesh& mesh) {
  Real longest = 0;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      longest = std::max(longest, norm(mesh.vertices[t[k]] - mesh.vertices[t[(k + 1) % 3]]));
  return longest;
}

Real least_angle(const TriangleMesh& mesh) {
  Real least = 4;
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 a = mesh.vertices[t[k]], u = mesh.vertices[t[(k + 1) % 3]] - a,
                 v = mesh.vertices[t[(k + 2) % 3]] - a;
      least = std::min(least, std::atan2(norm(cross(u, v)), dot(u, v)));
    }
  }
  return least;
}

}  // namespace

TEST_CASE("no edge is longer than asked for, and none has a vertex in between") {
  const std::vector<TriangleMesh> meshes{box_mesh({{1, 2, 3}}), drum_mesh({1, 0.1, 2, 0.1, 5, 0.2, 0.1, 24}),
                                         screw_mesh({0.1, 0.4, 0.5, 0.05, 1, 1.2, 16})};
  for (const TriangleMesh& mesh : meshes) {
    for (const Real length : {0.5, 0.2, 0.1}) {
      const TriangleMesh fine = refined(mesh, length);
      CHECK(longest_edge(fine) <= length);
      CHECK(fine.triangles.size() >= mesh.triangles.size());
      CHECK(mesh_defects(fine, false) == std::vector<std::string>{});
      CHECK(near(mesh_volume(fine), mesh_volume(mesh), {.relative = 1e-14}));
      CHECK(near(mesh_area(fine), mesh_area(mesh), {.relative = 1e-14}));
      CHECK(std::equal(mesh.vertices.begin(), mesh.vertices.end(), fine.vertices.begin()));
    }
  }
  CHECK(refined(meshes[0], 4).triangles == meshes[0].triangles);
}

TEST_CASE("angles stay bounded, and the number of triangles near the least") {
  const TriangleMesh mesh = box_mesh({{1, 2, 3}}), fine = refined(mesh, 0.05);
  CHECK(least_angle(fine) >= least_angle(mesh) / 2);
  const Real least = mesh_area(mesh) / (std::sqrt(3.) / 4 * 0.05 * 0.05);
  CHECK(Real(fine.triangles.size()) < 4 * least);
}

TEST_CASE("parts take the position of their triangle") {
  const TriangleMesh mesh = box_mesh({{1, 1, 1}}), fine = refined(mesh, 0.3);
  const std::size_t parts = fine.triangles.size() / 12;
  for (std::size_t i = 0; i < fine.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i / parts];
    const auto& [p, q, r] = fine.triangles[i];
    const Vec3 n = cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
    const Vec3 m = cross(fine.vertices[q] - fine.vertices[p], fine.vertices[r] - fine.vertices[p]);
    CHECK(dot(n, fine.vertices[p] - mesh.vertices[a]) == 0);
    CHECK(dot(n, m) == norm(n) * norm(m));
  }
}

TEST_CASE("an open surface with three triangles at an edge is refined, too") {
  const TriangleMesh sheet{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}},
                           {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}}};
  const TriangleMesh fine = refined(sheet, 0.2);
  CHECK(longest_edge(fine) <= 0.2);
  CHECK(near(mesh_area(fine), 1.5, {.relative = 1e-14}));
  CHECK(mesh_defects(fine, true) == mesh_defects(sheet, true));
}

TEST_CASE("too small a length is refused") {
  const TriangleMesh mesh = box_mesh({{1, 1, 1}});
  CHECK_THROWS_WITH(refined(mesh, 1e-6), "edges of at most 1e-06 m would make more than 100000000 triangles");
  CHECK_THROWS_AS(refined(mesh, 0), InputError);
  CHECK_THROWS_AS(refined(mesh, 0.1, 1000), InputError);
  CHECK_NOTHROW(refined(mesh, 0.1, 10'000));
}

}  // namespace scree
