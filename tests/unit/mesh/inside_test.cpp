// Inside test of closed meshes against their solid angles.
#include "mesh/inside.hpp"

#include "mesh/primitives.hpp"
#include "support/catch.hpp"
#include "support/test_meshes.hpp"

namespace scree {

namespace {

// Winding number of a mesh about p: the sum of the triangles' solid angles (Van Oosterom and Strackee, IEEE
// Trans. Biomed. Eng. 30, 1983) over 4 pi.
Real winding(const MeshView& mesh, Vec3 p) {
  Real sum = 0;
  for (Index t = 0; t < mesh.triangle_count; ++t) {
    const Index* v = mesh.triangles[t].vertex;
    const Vec3 a = mesh.vertices[v[0]] - p, b = mesh.vertices[v[1]] - p, c = mesh.vertices[v[2]] - p;
    const Real la = norm(a), lb = norm(b), lc = norm(c);
    sum +=
        2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(a, c) * lb + dot(b, c) * la);
  }
  return sum / (4 * M_PI);
}

Real distance(const MeshView& mesh, Vec3 p) {
  Real square = kInfinity;
  for (Index t = 0; t < mesh.triangle_count; ++t) {
    const Index* v = mesh.triangles[t].vertex;
    square =
        std::min(square, squared_distance(mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]], p));
  }
  return std::sqrt(square);
}

}  // namespace

TEST_CASE("points inside closed meshes and outside, those in line with edges and vertices, too") {
  const Real r = 1;
  for (const TriangleMesh& made :
       {box_mesh({{2, 2, 2}}), cylinder_mesh({r, 2, 8}), sphere_mesh({r, 1}), capsule_mesh({0.5, 1, 8}),
        plate_mesh({{2, 2, 0.5}, 0.5, 8}), pipe_mesh({0.5, r, 2, 8}),
        drum_mesh({r, 0.25, 2, 0.25, 3, 0.25, 0.25, 12}), screw_mesh({0.25, r, 1, 0.25, 2, 2.5, 8})}) {
    const SurfaceMesh mesh = build_surface_mesh(made, kFeatureAngle, false);
    const MeshView view = mesh.view();
    int wrong = 0, tested = 0;
    const auto query = [&](Vec3 p) {
      if (distance(view, p) < 1e-9) return;
      ++tested;
      wrong += is_inside(view, p) != (winding(view, p) > 0.5);
    };
    // A lattice some of whose lines contain vertices, edges and faces.
    for (int x = -6; x <= 6; ++x)
      for (int y = -6; y <= 6; ++y)
        for (int z = -6; z <= 6; ++z) query({Real(x) / 4, Real(y) / 4, Real(z) / 4});
    MeshRandom random(3);
    for (int k = 0; k < 500; ++k) query(random.in({-1.3, -1.3, -1.3}, {1.3, 1.3, 1.3}));
    // On the lines through the vertices.
    for (std::size_t v = 0; v < mesh.vertices.size() && v < 100; ++v)
      query(mesh.vertices[v] - Vec3{random.in(0, 2), 0, 0});
    CHECK(wrong == 0);
    CHECK(tested > 2000);
  }
}

TEST_CASE("an open surface has no inside; a closed line has") {
  const SurfaceMesh sheet = build_surface_mesh(rectangle_mesh(2, 2), kFeatureAngle, true);
  CHECK_FALSE(is_inside(sheet.view(), {0, 0, -0.1}));
  const std::vector<Vec3> corners = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 0.5, 0}, {0, 1, 0}};
  const SurfaceMesh line = build_surface_mesh(extruded_outline_mesh(corners, 3), kFeatureAngle, false);
  CHECK(is_inside(line.view(), {1, 0.25, 0}));
  CHECK(is_inside(line.view(), {0.1, 0.5, 0}));
  CHECK_FALSE(is_inside(line.view(), {1, 0.75, 0}));
  CHECK_FALSE(is_inside(line.view(), {-0.1, 0, 0}));
  CHECK_FALSE(is_inside(line.view(), {-0.1, 0.5, 0}));
}

}  // namespace scree
