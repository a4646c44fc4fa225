// The corners by which planes touch a mesh: exactly those of the hull, whatever the triangles.
#include "mesh/hull_corners.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/primitives.hpp"
#include "mesh/refine.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/test_meshes.hpp"

namespace scree {

namespace {

constexpr Real kPi = std::numbers::pi_v<Real>;

// Extent of the points in a direction [m].
Real farthest(const std::vector<Vec3>& points, Vec3 direction) {
  Real most = -kInfinity;
  for (const Vec3 p : points) most = std::max(most, dot(p, direction));
  return most;
}

// A plane in any direction touches the corners where it touches the points, and faces lie in their planes.
void check_hull(const HullCorners& hull, const std::vector<Vec3>& points, bool planar) {
  MeshRandom random(3);
  for (int k = 0; k < 500; ++k) {
    Vec3 direction = random.direction();
    if (planar) direction.z = 0;
    CHECK(near(farthest(hull.corners, direction), farthest(points, direction), {.absolute = 1e-8}));
  }
  for (Index face = 0; face < hull.faces(); ++face) {
    const Vec3 normal = hull.normals[face];
    CHECK(near(norm(normal), 1, {.relative = 1e-14}));
    for (const Index corner : hull.of_face(face))
      CHECK(near(dot(hull.corners[corner], normal), farthest(points, normal), {.absolute = 1e-8}));
  }
  for (const Vec3 corner : hull.corners) CHECK(norm(corner - hull.middle) <= hull.bounding_radius);
}

std::vector<Vec3> rotated(const std::vector<Vec3>& points, const Mat3& axes, Vec3 move) {
  std::vector<Vec3> out;
  for (const Vec3 p : points) out.push_back(axes * p + move);
  return out;
}

}  // namespace

TEST_CASE("corners of a hull are strict: triangles on faces and edges add none, wherever the mesh is") {
  struct Case {
    const char* name;
    TriangleMesh mesh;
    Index corners, faces;
    Real area;  // of the hull
  };
  const Real edges = 2 * 7 * std::sin(kPi / 7);  // of a heptagon of radius 1
  const Real base = 3.5 * std::sin(2 * kPi / 7);
  const std::vector<Case> cases = {
      {"box", box_mesh({{0.2, 0.3, 0.4}}), 8, 6, 0.52},
      {"fine box", refined(box_mesh({{0.2, 0.3, 0.4}}), 0.03), 8, 6, 0.52},
      {"prism of seven sides", refined(cylinder_mesh({1, 2, 7}), 0.2), 14, 9, 2 * base + 2 * edges},
      {"plate with a hole", plate_mesh({{1, 1, 0.1}, 0.3, 16}), 8, 6, 2.4},
      {"sheet", refined(rectangle_mesh(0.5, 0.25), 0.02), 4, 2, 0.25},
  };
  MeshRandom random(1);
  for (const Case& one : cases)
    for (int pose = 0; pose < 4; ++pose) {
      const bool as_made = pose == 0;
      const std::vector<Vec3> points = rotated(one.mesh.vertices, as_made ? identity3() : random.turn(),
                                               as_made ? Vec3{} : random.in({-2, -2, -2}, {2, 2, 2}));
      CAPTURE(one.name, pose);
      const HullCorners hull = hull_corners(points, false);
      CHECK(std::ssize(hull.corners) == one.corners);
      CHECK(hull.faces() == one.faces);
      CHECK(near(4 * kPi * hull.radius * hull.radius, one.area, {.relative = 1e-9}));
      check_hull(hull, points, false);
    }
}

TEST_CASE("each vertex of a sphere is a corner, and its radius is the sphere's") {
  const TriangleMesh sphere = sphere_mesh({0.5, 3});
  const HullCorners hull = hull_corners(sphere.vertices, false);
  CHECK(hull.corners.size() == sphere.vertices.size());
  CHECK(std::ssize(hull.normals) == std::ssize(sphere.triangles));
  CHECK(near(hull.radius, 0.5, {.relative = 0.01}));
  check_hull(hull, sphere.vertices, false);
}

TEST_CASE("in the plane corners are those of the outline") {
  const auto line = [](std::vector<Vec3> points) {
    std::vector<Vec3> both = points;
    for (Vec3& p : points) p.z = 3, both.push_back(p);
    return both;
  };
  struct Case {
    std::vector<Vec3> points;
    Index corners;
    Real length;
  };
  const std::vector<Case> cases = {
      {{{0, 0, 0}, {0.1, 0, 0}, {0.7, 0, 0}, {1, 0, 0}}, 2, 2},
      {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, 3, 2 + std::sqrt(Real(2))},
      {{{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}, {1, 0.3, 0}, {1, 1, 0}, {0.5, 0.5, 0}, {0, 1, 0}}, 4, 4},
  };
  for (const Case& one : cases)
    for (const Real angle : {Real(0), Real(0.7), Real(2.1)}) {
      const Real c = std::cos(angle), s = std::sin(angle);
      const std::vector<Vec3> points =
          rotated(line(one.points), {{c, -s, 0}, {s, c, 0}, {0, 0, 1}}, {5, 7, 0});
      CAPTURE(one.corners, angle);
      const HullCorners hull = hull_corners(points, true);
      CHECK(std::ssize(hull.corners) == one.corners);
      CHECK(hull.faces() == one.corners);
      CHECK(near(2 * kPi * hull.radius, one.length, {.relative = 1e-9}));
      check_hull(hull, points, true);
    }
}

}  // namespace scree
