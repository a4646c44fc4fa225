// Convex hulls of convex and non-convex meshes, and of points in unfavourable order and position.
#include "mesh/convex_hull.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "mesh/mesh_mass.hpp"
#include "mesh/primitives.hpp"
#include "mesh/refine.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/test_meshes.hpp"

namespace scree {

namespace {

// The hull must be one closed surface. With points that are coplanar but for round-off some triangles may be
// degenerate.
TriangleMesh sound_hull(const std::vector<Vec3>& points) {
  const TriangleMesh hull = convex_hull(points);
  std::set<std::pair<Index, Index>> ways;
  for (const auto& [a, b, c] : hull.triangles) ways.insert({{a, b}, {b, c}, {c, a}});
  CHECK(ways.size() == 3 * hull.triangles.size());
  CHECK(std::ranges::all_of(ways, [&](const auto& way) { return ways.contains({way.second, way.first}); }));
  CHECK(2 * (hull.vertices.size() - 2) == hull.triangles.size());  // Euler's formula for a sphere
  return hull;
}

// Distance of the farthest point outside the hull [m].
Real farthest_outside(const TriangleMesh& hull, const std::vector<Vec3>& points) {
  Real farthest = 0;
  for (const auto& [a, b, c] : hull.triangles) {
    const Vec3 corner = hull.vertices[a],
               normal = cross(hull.vertices[b] - corner, hull.vertices[c] - corner);
    if (norm(normal) < 1e-6) continue;  // of a sliver, round-off
    for (const Vec3 p : points) farthest = std::max(farthest, dot(p - corner, normal) / norm(normal));
  }
  return farthest;
}

void check_same_mass(const TriangleMesh& mesh, const TriangleMesh& other, Real bound) {
  const MassProperties a = solid_mesh_mass(mesh, 1), b = solid_mesh_mass(other, 1);
  CHECK(near(a.mass, b.mass, {.relative = bound}));
  CHECK(norm(a.center - b.center) < bound);
  CHECK(near(a.inertia.xx, b.inertia.xx, {.relative = bound}));
  CHECK(near(a.inertia.zz, b.inertia.zz, {.relative = bound}));
}

// A unit cube whose top is an inverted pyramid.
TriangleMesh dented_cube(Real depth) {
  TriangleMesh cube = block({0, 0, 0}, {1, 1, 1}, 2);
  for (Vec3& v : cube.vertices)
    if (v == Vec3{0.5, 0.5, 1}) v.z -= depth;
  return cube;
}

}  // namespace

TEST_CASE("a cube with a dent weighs as the cube, whatever is cut into its faces") {
  const TriangleMesh cube = box_mesh({{1, 1, 1}});
  const TriangleMesh about = mapped(cube, [](Vec3 v) { return v + Vec3{0.5, 0.5, 0.5}; });
  CHECK(mesh_volume(dented_cube(0.6)) < 0.9);
  check_same_mass(sound_hull(dented_cube(0.6).vertices), about, 1e-15);
  check_same_mass(sound_hull(refined(about, 0.1).vertices), about, 1e-14);
  const Mat3 turn = MeshRandom(3).turn();
  const TriangleMesh turned_cube = rotated(about, turn);
  check_same_mass(sound_hull(rotated(refined(about, 0.2), turn).vertices), turned_cube, 1e-11);
}

TEST_CASE("the hull of what is convex is itself; that of a torus and of an L has closed forms") {
  for (const TriangleMesh& mesh :
       {tetrahedron(), icosphere(3, 2), cylinder_mesh({1, 2, 40}), cone_mesh({1, 0, 2, 31})})
    check_same_mass(sound_hull(mesh.vertices), mesh, 1e-11);
  std::vector<Vec3> corner;
  for (const Real z : {0, 1})
    for (const Vec3 p : {Vec3{0, 0, z}, {2, 0, z}, {2, 1, z}, {1, 1, z}, {1, 2, z}, {0, 2, z}})
      corner.push_back(p);
  CHECK(mesh_volume(sound_hull(corner)) == Approx(3.5).epsilon(1e-15));
  const TriangleMesh pipe = pipe_mesh({1, 2, 3, 64});
  CHECK(mesh_volume(sound_hull(pipe.vertices)) ==
        Approx(3 * 64 * 2 * std::sin(2 * M_PI / 64)).epsilon(1e-12));
}

TEST_CASE("points on a sphere: their hull's volume comes near it at order 1 in their number") {
  Real before = 0;
  for (const int count : {1000, 4000, 16000}) {
    MeshRandom random(9);
    std::vector<Vec3> points;
    for (int k = 0; k < count; ++k) points.push_back(random.direction());
    const TriangleMesh hull = sound_hull(points);
    CHECK(hull.vertices.size() == points.size());
    const Real lost = 1 - mesh_volume(hull) / (4 * std::numbers::pi_v<Real> / 3);
    if (before > 0) CHECK(before / lost == Approx(4).epsilon(0.1));
    before = lost;
  }
}

TEST_CASE("clouds, lattices and near-planes: closed, and no point is outside") {
  MeshRandom random(4);
  std::vector<Vec3> cloud, lattice, thin, twice;
  for (int k = 0; k < 2000; ++k) cloud.push_back(random.in({-1, -2, 5}, {1, 2, 6}));
  for (int k = 0; k < 1000; ++k) lattice.push_back({k % 10 * 0.1, k / 10 % 10 * 0.1, k / 100 * 0.1});
  for (int k = 0; k < 500; ++k) thin.push_back(random.in({0, 0, 0}, {1, 1, 1e-9}));
  for (int k = 0; k < 500; ++k) twice.push_back(cloud[k % 100]);
  const Mat3 turn = random.turn();
  for (const std::vector<Vec3>& points : {cloud, lattice, thin, twice}) {
    CHECK(farthest_outside(sound_hull(points), points) < 2e-11);
    std::vector<Vec3> moved;
    for (const Vec3 p : points) moved.push_back(turn * p + Vec3{1e5, 0, 0});
    if (points != thin) CHECK(farthest_outside(sound_hull(moved), moved) < 2e-10);
  }
}

TEST_CASE("points in a plane, on a line, or at one position have no hull") {
  MeshRandom random(6);
  const Mat3 turn = random.turn();
  std::vector<Vec3> line, plane;
  for (int k = 0; k < 100; ++k) {
    const Vec3 p = random.in({-1, -1, 0}, {1, 1, 0});
    plane.push_back(turn * p);
    line.push_back(turn * Vec3{p.x, 0, 0});
  }
  const std::vector<Vec3> position(5, {1, 2, 3});
  for (const std::vector<Vec3>& points : {{}, position, line, plane, unit_grid(4, 4).vertices})
    CHECK_THROWS_AS(convex_hull(points), InputError);
}

}  // namespace scree
