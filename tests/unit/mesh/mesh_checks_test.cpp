// Messages on triangles that do not form a surface.
#include "mesh/mesh_checks.hpp"

#include <cmath>
#include <limits>

#include "mesh/mesh_shells.hpp"
#include "mesh/primitives.hpp"
#include "mesh/weld.hpp"
#include "support/catch.hpp"

namespace scree {

namespace {

using Texts = std::vector<std::string>;

// A cube of side 2 about the origin; vertex 0 is (-1, -1, -1), 6 is (1, 1, 1).
TriangleMesh cube() { return box_mesh({{2, 2, 2}}); }

void append(TriangleMesh& mesh, const TriangleMesh& other, Vec3 shift) {
  const Index first = static_cast<Index>(mesh.vertices.size());
  for (const Vec3 v : other.vertices) mesh.vertices.push_back(v + shift);
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
}

TriangleMesh turned_over(TriangleMesh mesh) {
  for (std::array<Index, 3>& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

// A vertex for every corner of every triangle, as in STL.
TriangleMesh torn(const TriangleMesh& mesh) {
  TriangleMesh result;
  for (const auto& triangle : mesh.triangles) {
    const Index first = static_cast<Index>(result.vertices.size());
    for (const Index corner : triangle) result.vertices.push_back(mesh.vertices[corner]);
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

}  // namespace

TEST_CASE("vertices of equal coordinates become one") {
  const TriangleMesh mesh = welded(torn(cube()));
  CHECK(mesh.vertices.size() == 8);
  CHECK(mesh_defects(mesh, false) == Texts{});
  // In the order of use, whatever the order and number of the original vertices.
  TriangleMesh shuffled = cube();
  std::reverse(shuffled.vertices.begin(), shuffled.vertices.end());
  shuffled.vertices.push_back({5, 5, 5});
  for (std::array<Index, 3>& t : shuffled.triangles)
    for (Index& corner : t) corner = 7 - corner;
  CHECK(welded(shuffled).vertices == mesh.vertices);
  CHECK(welded(shuffled).triangles == mesh.triangles);
  const TriangleMesh zeros =
      welded({{{0, -0., 0}, {1, 0, 0}, {0, 1, 0}, {-0., 0, 0}}, {{0, 1, 2}, {3, 2, 1}}});
  CHECK(zeros.vertices.size() == 3);
  CHECK_FALSE(std::signbit(zeros.vertices[0].y));
}

TEST_CASE("vertices within a tolerance become one") {
  TriangleMesh mesh = torn(cube());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) mesh.vertices[i].x += 1e-7 * Real(i % 5);
  const Texts troubles = mesh_defects(welded(mesh), false);
  REQUIRE(troubles.size() == 1);
  CHECK(troubles[0].find(
            "sheet = true); two of their ends are 1e-07 m apart, which welding within a tolerance joins: ") !=
        std::string::npos);
  const NumberedMesh loose = welded_within(mesh, 1e-6);
  CHECK(loose.mesh.vertices.size() == 8);
  CHECK(mesh_defects(loose.mesh, false) == Texts{});
  CHECK(welded_within(mesh, 1e-300).mesh.vertices == welded(mesh).vertices);
  // A sliver is removed with its short edge, and the others keep their numbers.
  const NumberedMesh sheet =
      welded_within({{{0, 0, 0}, {1, 0, 0}, {1, 1e-9, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}}, 1e-8);
  CHECK(sheet.mesh.triangles == std::vector<std::array<Index, 3>>{{0, 1, 2}});
  CHECK(sheet.numbers == std::vector<Index>{1});
}

TEST_CASE("a hole is named by its edges") {
  TriangleMesh mesh = cube();
  mesh.triangles.erase(mesh.triangles.begin() + 1);
  CHECK(mesh_defects(mesh, false) ==
        Texts{"3 edges have one triangle; a closed mesh has two at each (an open surface needs "
              "sheet = true): "
              "(-1, -1, -1) to (1, -1, -1) of triangle 1; (-1, -1, -1) to (1, 1, -1) of triangle 0; "
              "(1, -1, -1) to (1, 1, -1) of triangle 3"});
  CHECK(mesh_defects(mesh, true) == Texts{});
  const Texts numbered = mesh_defects(mesh, false, {0, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11});
  CHECK(numbered[0].ends_with("(1, -1, -1) to (1, 1, -1) of triangle 4"));
  const Texts torn_apart = mesh_defects(torn(cube()), false);
  CHECK(torn_apart[0].starts_with("36 edges have one triangle"));
  CHECK(torn_apart[0].ends_with("; and 31 more"));
}

TEST_CASE("edges with three triangles and opposite windings") {
  TriangleMesh mesh = cube();
  mesh.vertices.push_back({0, 0, 9});
  mesh.triangles.push_back({0, 1, 8});
  const Texts troubles = mesh_defects(mesh, false);
  REQUIRE(troubles.size() == 2);
  CHECK(troubles[1] ==
        "an edge has more than two triangles; a closed mesh has two at each: "
        "(-1, -1, -1) to (1, -1, -1) of triangles 1, 2 and 12");
  CHECK(mesh_defects(mesh, true) == Texts{});
  TriangleMesh flipped = cube();
  std::swap(flipped.triangles[0][0], flipped.triangles[0][1]);
  CHECK(mesh_defects(flipped, false) ==
        Texts{"3 edges lie between opposite windings; corners must run "
              "counterclockwise seen from one side of the whole: (-1, -1, -1) "
              "to (1, 1, -1) of triangles 0 and 1; (-1, -1, -1) to (-1, 1, -1) "
              "of triangles 0 and 8; (1, 1, -1) to (-1, 1, -1) of triangles 0 "
              "and 6"});
  CHECK(mesh_defects(flipped, true) == Texts{});
}

TEST_CASE("triangles twice, without area, without numbers") {
  TriangleMesh twice = cube();
  twice.triangles.push_back({twice.triangles[4][1], twice.triangles[4][0], twice.triangles[4][2]});
  CHECK(mesh_defects(twice, true) == Texts{"a triangle has the corners of another; each must be there once: "
                                           "triangle 4 and triangle 12 (1, 1, -1) (1, -1, -1) (1, 1, 1)"});
  TriangleMesh flat = cube();
  flat.vertices.push_back({0, 0, -1});
  flat.triangles.push_back({0, 8, 2});
  flat.triangles.push_back({3, 3, 5});
  CHECK(mesh_defects(flat, true)[0] ==
        "2 triangles have no area; each must span a plane: triangle 12 (-1, -1, -1) (0, 0, -1) (1, 1, -1); "
        "triangle 13 (-1, 1, -1) (-1, 1, -1) (1, -1, 1)");
  TriangleMesh broken = cube();
  broken.vertices[6].y = std::numeric_limits<Real>::quiet_NaN();
  CHECK(mesh_defects(broken, false)[0].starts_with(
      "5 triangles have coordinates that are no finite numbers; all must be: triangle 4 (1, -1, -1) "));
  CHECK(mesh_defects({}, false) == Texts{"no triangles"});
  // A sliver with an aspect ratio of a million has none of these defects.
  CHECK(mesh_defects(box_mesh({{1, 1, 1e-6}}), false) == Texts{});
}

TEST_CASE("inside out, and around nothing") {
  CHECK(mesh_defects(turned_over(cube()), false) ==
        Texts{"its volume is -8 m^3, below 0: it is inside out; corners must run counterclockwise seen from "
              "outside"});
  // Two tetrahedra's worth of triangles in one plane.
  const TriangleMesh leaf{{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}},
                          {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
  CHECK(mesh_defects(leaf, false) == Texts{"it encloses 0 m^3, nothing but round-off"});
}

TEST_CASE("shells are counted in the order of their triangles") {
  TriangleMesh mesh = cube();
  append(mesh, sphere_mesh({0.5, 0}), {3, 0, 0});
  CHECK(mesh_defects(mesh, false) == Texts{});
  const std::vector<Index> shells = shells_of(mesh);
  CHECK(std::count(shells.begin(), shells.end(), 0) == 12);
  CHECK(std::count(shells.begin(), shells.end(), 1) == 20);
  CHECK(shells.back() == 1);
}

TEST_CASE("shells that do not fit to where they are") {
  const TriangleMesh small = sphere_mesh({0.5, 0});
  const auto with = [](TriangleMesh mesh, const TriangleMesh& other, Vec3 shift) {
    append(mesh, other, shift);
    return mesh;
  };
  const TriangleMesh hollow = with(cube(), turned_over(small), {});
  CHECK(mesh_defects(hollow, false) == Texts{});
  CHECK(mesh_defects(with(hollow, sphere_mesh({0.2, 1}), {}), false) == Texts{});
  const Texts inner = mesh_defects(with(cube(), small, {0.1, 0, 0}), false);
  REQUIRE(inner.size() == 1);
  CHECK(inner[0].starts_with(
      "a shell lies inside another; around a cavity corners must run clockwise seen from "
      "outside; solids must not overlap: that of triangle 12 ("));
  const Texts inverted = mesh_defects(with(cube(), turned_over(small), {3, 0, 0}), false);
  REQUIRE(inverted.size() == 1);
  CHECK(inverted[0].starts_with(
      "a shell is inside out; corners must run counterclockwise seen from outside, but "
      "around a cavity: that of triangle 12 ("));
  // One shell inside a cavity, and an inverted one outside.
  const TriangleMesh twice =
      with(with(hollow, sphere_mesh({0.1, 1}), {0.2, 0, 0}), turned_over(cube()), {0, 0, 9});
  CHECK(mesh_defects(twice, false).size() == 1);
  // Boxes that stand on each other.
  CHECK(mesh_defects(with(cube(), cube(), {0.5, 0.25, 2}), false) == Texts{});
}

}  // namespace scree
