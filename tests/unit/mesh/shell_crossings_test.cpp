// Shells of one mesh that intersect, touch, or lie inside each other.
#include "mesh/shell_crossings.hpp"

#include "mesh/mesh_checks.hpp"
#include "mesh/mesh_mass.hpp"
#include "mesh/mesh_shells.hpp"
#include "mesh/refine.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/test_meshes.hpp"

namespace scree {

namespace {

using Texts = std::vector<std::string>;

TriangleMesh with(TriangleMesh mesh, const TriangleMesh& other, Vec3 shift) {
  const Index first = static_cast<Index>(mesh.vertices.size());
  for (const Vec3 v : other.vertices) mesh.vertices.push_back(v + shift);
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
  return mesh;
}

TriangleMesh turned_over(TriangleMesh mesh) {
  for (std::array<Index, 3>& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TriangleMesh moved(TriangleMesh mesh, const Mat3& axes, Vec3 shift) {
  for (Vec3& v : mesh.vertices) v = axes * v + shift;
  return mesh;
}

std::vector<ShellCrossing> crossings(const TriangleMesh& mesh) {
  return shell_crossings(mesh, shells_of(mesh));
}

TriangleMesh slab() { return box_mesh({{0.1, 0.1, 0.04}}); }

}  // namespace

TEST_CASE("boxes that overlap cross, wherever one corner of each lies") {
  for (const Vec3 shift : {Vec3{0.03, -0.03, 0},
                           {0.03, 0.03, 0.01},
                           {0.03, -0.03, 0.01},
                           {0.05, 0.05, 0},
                           {0.099, 0, 0.039},
                           {-0.03, 0.01, 0.02}}) {
    CAPTURE(shift.x, shift.y, shift.z);
    const TriangleMesh two = with(slab(), slab(), shift);
    REQUIRE(crossings(two).size() == 1);
    const ShellCrossing found = crossings(two).front();
    CHECK((found.shell[0] == 0 && found.shell[1] == 1));
    CHECK((found.triangle[0] < 12 && found.triangle[1] >= 12));
    // On the surfaces of both shells.
    for (const Vec3 p : {found.position, found.position - shift})
      CHECK(std::max({std::abs(p.x) - 0.05, std::abs(p.y) - 0.05, std::abs(p.z) - 0.02}) ==
            Approx(0).margin(1e-12));
    CHECK(mesh_defects(two, false) == Texts{});
    CHECK(crossing_text(two).starts_with("its shells 0 and 1 cut through each other, first at ("));
  }
  // Bars that cross without a corner of one inside the other.
  CHECK(crossings(with(box_mesh({{4, 1, 1}}), box_mesh({{1, 4, 0.5}}), {})).size() == 1);
  // A needle through the middle of a face.
  CHECK(crossings(with(box_mesh({{1, 1, 1}}), cone_mesh({1e-3, 0, 1, 8}), {0.1, 0.2, 0})).size() == 1);
}

TEST_CASE("of three shells those that cross are named") {
  const TriangleMesh three = with(with(slab(), slab(), {1, 0, 0}), slab(), {1.03, 0.02, 0.01});
  REQUIRE(crossings(three).size() == 1);
  CHECK(crossings(three).front().shell[0] == 1);
  CHECK(crossings(three).front().shell[1] == 2);
  const TriangleMesh chain = with(with(slab(), slab(), {0.06, 0.01, 0.01}), slab(), {0.12, 0.02, 0.02});
  CHECK(crossings(chain).size() == 2);
  CHECK(crossing_text(chain).ends_with("; so do 1 more pairs of shells"));
  // A misplaced shell beside two that intersect.
  const Texts troubles = mesh_defects(with(three, box_mesh({{0.01, 0.01, 0.01}}), {}), false);
  REQUIRE(troubles.size() == 1);
  CHECK(troubles[0].starts_with("a shell lies inside another"));
}

TEST_CASE("shells that touch do not cross, and weigh what each of them does") {
  const Mat3 turned = MeshRandom(7).turn();
  for (const Vec3 shift :
       {Vec3{0.02, 0.03, 0.04}, {0.1, 0.02, 0.01}, {0.1, 0.05, 0.04}, {0, 0, 0.04}, {0.5, 0, 0}}) {
    CAPTURE(shift.x, shift.y, shift.z);
    // Each solid has its own corners where the two coincide.
    const TriangleMesh two = with(slab(), refined(slab(), 0.07), shift);
    for (const TriangleMesh& mesh : {two, moved(two, turned, {0.3, 0.1, -0.7})}) {
      CHECK(crossings(mesh).empty());
      CHECK(mesh_defects(mesh, false) == Texts{});
      CHECK(crossing_text(mesh).empty());
      CHECK(mesh_volume(mesh) == Approx(8e-4).epsilon(kAccumulatedRoundOff));
    }
    // Coordinates rounded to the 7 digits of a file.
    TriangleMesh rounded = moved(two, turned, {0.3, 0.1, -0.7});
    for (Vec3& v : rounded.vertices)
      v = {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
    CHECK(mesh_defects(rounded, false) == Texts{});
    CHECK(crossing_text(rounded).empty());
  }
}

TEST_CASE("cavities are right, solids inside solids are not, also where they touch or coincide") {
  const TriangleMesh ball = sphere_mesh({0.01, 2}), half = refined(box_mesh({{0.05, 0.05, 0.02}}), 0.02);
  const TriangleMesh hollow = with(slab(), turned_over(ball), {0.02, 0.01, 0});
  CHECK(crossings(hollow).empty());
  CHECK(mesh_defects(hollow, false) == Texts{});
  CHECK(mesh_defects(with(hollow, sphere_mesh({0.005, 1}), {0.02, 0.01, 0}), false) == Texts{});
  // A ball in the cavity that touches its wall.
  CHECK(mesh_defects(with(hollow, sphere_mesh({0.005, 2}), {0.025, 0.01, 0}), false) == Texts{});
  const auto is_inside = [](const TriangleMesh& mesh) {
    const Texts troubles = mesh_defects(mesh, false);
    return troubles.size() == 1 && troubles[0].starts_with("a shell lies inside another");
  };
  CHECK(is_inside(with(slab(), ball, {0.02, 0.01, 0})));
  CHECK(is_inside(with(slab(), half, {0, 0, 0.01})));      // with a face in the top
  CHECK(is_inside(with(slab(), half, {0.025, 0, 0.01})));  // with a face in a side, too
  // One box twice, the second with smaller triangles.
  const Texts twice = mesh_defects(with(slab(), refined(slab(), 0.03), {}), false);
  REQUIRE(twice.size() == 1);
  CHECK(twice[0].find("inside") != std::string::npos);
  // Blocks of equal cubes that share a layer: all edges of one lie along edges of the other.
  const TriangleMesh block = refined(box_mesh({{4, 4, 4}}), 1.5);
  CHECK(!mesh_defects(with(block, block, {2, 0, 0}), false).empty());
}

}  // namespace scree
