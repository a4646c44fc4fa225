// Coarsening: distance from the original surface, preserved edges, and independence of the order.
#include "mesh/coarsen.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/mesh_checks.hpp"
#include "mesh/mesh_mass.hpp"
#include "mesh/primitives.hpp"
#include "mesh/refine.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/test_meshes.hpp"

namespace scree {

namespace {

constexpr Real kPi = std::numbers::pi_v<Real>;

// Largest distance of an original vertex from the coarse mesh [m].
Real farthest(const TriangleMesh& given, const TriangleMesh& coarse) {
  Real most = 0;
  for (const Vec3 p : given.vertices) {
    Real least = kInfinity;
    for (const auto& [a, b, c] : coarse.triangles)
      least =
          std::min(least, squared_distance(coarse.vertices[a], coarse.vertices[b], coarse.vertices[c], p));
    most = std::max(most, std::sqrt(least));
  }
  return most;
}

CoarseMesh sound(const TriangleMesh& mesh, Real distance, bool sheet = false) {
  CoarseMesh coarse = coarsened(mesh, distance, kFeatureAngle);
  CHECK(mesh_defects(coarse.mesh, sheet) == std::vector<std::string>{});
  CHECK(coarse.moved <= distance);
  return coarse;
}

TriangleMesh shuffled(TriangleMesh mesh) {
  MeshRandom random(12);
  for (std::size_t t = mesh.triangles.size(); t-- > 1;) {
    const auto other = static_cast<std::size_t>(random.below(static_cast<Index>(t) + 1));
    std::swap(mesh.triangles[t], mesh.triangles[other]);
    std::ranges::rotate(mesh.triangles[t], mesh.triangles[t].begin() + random.below(3));
  }
  return welded(mesh);  // vertices in another order, too
}

}  // namespace

TEST_CASE("a cube stays a cube of 12 triangles, an open rectangle one of 2, to the bit") {
  for (const Real length : {0.3, 0.07}) {
    const CoarseMesh cube = sound(refined(box_mesh({{1, 1, 1}}), length), 1e-9);
    CHECK(cube.mesh.triangles.size() == 12);
    CHECK(cube.moved < 1e-15);
    CHECK(mesh_volume(cube.mesh) == 1);
    CHECK(mesh_area(cube.mesh) == 6);
  }
  CHECK(sound(jittered_grid(20, 3), 1e-9, true).mesh.triangles.size() == 2);
}

TEST_CASE("a sphere's volume errs by the square of its edges") {
  const TriangleMesh fine = sphere_mesh({1, 6});
  Real before = 0;
  for (const Real distance : {8e-3, 2e-3}) {
    const CoarseMesh coarse = sound(fine, distance);
    const Real error = 1 - mesh_volume(coarse.mesh) / (4 * kPi / 3);
    const Real count = static_cast<Real>(coarse.mesh.triangles.size());
    CHECK(error < 3 * distance);
    CHECK(coarse.moved > distance / 2);
    CHECK(count < 40 / distance);
    if (before > 0) CHECK(before / (error * count) == Approx(1).margin(0.2));
    before = error * count;
  }
}

TEST_CASE("no original vertex is farther away than reported, on any mesh") {
  const TriangleMesh drum = refined(drum_mesh({1, 0.1, 2, 0.1, 5, 0.2, 0.1, 48}), 0.2);
  const TriangleMesh screw = screw_mesh({0.1, 0.4, 0.5, 0.05, 1, 1.2, 24});
  for (const TriangleMesh& mesh : {drum, screw, refined(cone_mesh({1, 0, 2, 64}), 0.2)}) {
    const CoarseMesh coarse = sound(mesh, 0.01);
    CHECK(coarse.mesh.triangles.size() < mesh.triangles.size() / 2);
    CHECK(farthest(mesh, coarse.mesh) <= coarse.moved * (1 + 1e-12));
    CHECK(mesh_volume(coarse.mesh) == Approx(mesh_volume(mesh)).epsilon(0.1));
  }
}

TEST_CASE("sharp and free edges stay where they are, and their corners") {
  const TriangleMesh can = refined(cylinder_mesh({1, 1, 96}), 0.1);
  const CoarseMesh coarse = sound(can, 1e-3);
  const auto box_of = [](const TriangleMesh& mesh) { return closed_mesh(mesh).box; };
  CHECK(box_of(coarse.mesh).max.z == 0.5);
  CHECK(box_of(coarse.mesh).min.z == -0.5);
  for (const Vec3 v : coarse.mesh.vertices) CHECK(std::abs(v.z) == 0.5);  // all interior vertices are removed
  CHECK(std::ranges::count_if(coarse.mesh.vertices, [](Vec3 v) { return std::hypot(v.x, v.y) < 0.99; }) <= 2);
  // The hole of an open surface, and its corners.
  TriangleMesh holed = unit_grid(10, 10);
  std::erase_if(holed.triangles, [&](const auto& t) {
    const Vec3 middle = holed.vertices[t[0]] + holed.vertices[t[1]] + holed.vertices[t[2]];
    return std::abs(middle.x / 3 - 0.5) < 0.2 && std::abs(middle.y / 3 - 0.5) < 0.2;
  });
  holed = welded(holed);
  const CoarseMesh frame = sound(holed, 1e-9, true);
  CHECK(mesh_area(frame.mesh) == Approx(mesh_area(holed)).epsilon(1e-14));
  CHECK(frame.mesh.triangles.size() == 8);
}

TEST_CASE("the order of triangles and vertices does not matter") {
  for (const TriangleMesh& mesh : {screw_mesh({0.1, 0.4, 0.5, 0.05, 1, 1.2, 24}), sphere_mesh({1, 4})}) {
    const CoarseMesh one = coarsened(mesh, 0.01, kFeatureAngle),
                     other = coarsened(shuffled(mesh), 0.01, kFeatureAngle);
    CHECK(one.mesh.vertices == other.mesh.vertices);
    CHECK(one.mesh.triangles == other.mesh.triangles);
    CHECK(one.moved == other.moved);
  }
}

TEST_CASE("three open surfaces at an edge stay joined; irreducible meshes are unchanged") {
  TriangleMesh sheets = unit_grid(6, 6);
  append(sheets, mapped(unit_grid(6, 6), [](Vec3 v) { return Vec3{v.x, 0, v.y}; }));
  append(sheets, mapped(unit_grid(6, 6), [](Vec3 v) { return Vec3{v.x, -v.y, 0}; }));
  CHECK(sound(welded(sheets), 1e-9, true).mesh.triangles.size() == 6);
  CHECK(sound(tetrahedron(), 10).mesh.triangles.size() == 4);
  CHECK(sound(sphere_mesh({1, 0}), 10).mesh.triangles.size() == 20);
}

}  // namespace scree
