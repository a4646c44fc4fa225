// Radii of curvature and sags of shapes with known radii.
#include "mesh/mesh_curvature.hpp"

#include "mesh/primitives.hpp"
#include "mesh/refine.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/test_meshes.hpp"

namespace scree {

namespace {

MeshCurvature curvature_of(const TriangleMesh& mesh, bool sheet = false) {
  return build_surface_mesh(mesh, kFeatureAngle, sheet).curvature;
}

TriangleMesh inside_out(TriangleMesh mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  return mesh;
}

}  // namespace

TEST_CASE("the inside of a pipe has the curvature of its radius; convex shapes are not concave") {
  for (const Index n : {16, 48, 144}) {
    const MeshCurvature pipe = curvature_of(pipe_mesh({2, 3, 1, n}));
    CHECK(pipe.concave_radius == Approx(2).epsilon(2.0 / (n * n)));
    const Real sag = 3 * (1 - std::cos(M_PI / n));
    CHECK(pipe.sag == Approx(sag).epsilon(4.0 / (n * n)));
  }
  for (const TriangleMesh& mesh : {box_mesh({{1, 1, 1}}), cylinder_mesh({1, 1, 48}), sphere_mesh({1, 3})})
    CHECK(curvature_of(mesh).concave_radius == kInfinity);
  CHECK(curvature_of(box_mesh({{1, 1, 1}})).sag == 0);
}

TEST_CASE("curvature: spheres from inside, open surfaces from either side, fillets beside planes") {
  CHECK(curvature_of(inside_out(sphere_mesh({1, 3}))).concave_radius == Approx(1).margin(0.25));
  CHECK(curvature_of(sphere_mesh({1, 3}), true).concave_radius == Approx(1).margin(0.25));
  std::vector<Vec3> trough = {{-3, 0, 0}};
  for (int k = 0; k <= 16; ++k)
    trough.push_back({std::sin(k * M_PI / 32) * 0.1, 0.1 - 0.1 * std::cos(k * M_PI / 32), 0});
  trough.push_back({0.1, 2, 0});
  CHECK(curvature_of(extruded_line_mesh(trough, false, 4), true).concave_radius == Approx(0.1).epsilon(0.01));
}

TEST_CASE("the flight of a screw is as hollow along a slant as a helicoid is at its core") {
  const Real rise = 0.07 / (2 * M_PI), core = 0.012, helicoid = (rise * rise + core * core) / rise;
  for (const Index n : {48, 96}) {
    const MeshCurvature screw = curvature_of(screw_mesh({core, 0.042, 0.07, 0.005, 0.2, 0.2, n}));
    CHECK(screw.concave_radius > helicoid);
    CHECK(screw.concave_radius < (1 + 32.0 / n) * helicoid);
  }
}

TEST_CASE("a crease between planes is no curve, however finely they are cut") {
  const TriangleMesh roof = refined(extruded_line_mesh({{-1, 0, 0}, {0, 0.1, 0}, {1, 0, 0}}, false, 1), 0.2);
  const MeshCurvature crease = curvature_of(roof, true);
  CHECK(crease.sag == 0);
  CHECK(crease.concave_radius == kInfinity);
}

TEST_CASE("planes that coordinates of seven digits bend are no curves") {
  TriangleMesh plane = jittered_grid(33, 2);
  MeshRandom random(5);
  for (Vec3& v : plane.vertices) v.z += random.in(-1e-7, 1e-7);
  CHECK(curvature_of(plane, true).concave_radius == kInfinity);
}

}  // namespace scree
