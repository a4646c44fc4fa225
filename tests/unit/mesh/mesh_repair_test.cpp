// Repairs of meshes, and meshes that stay unchanged.
#include "mesh/mesh_repair.hpp"

#include <algorithm>
#include <cmath>

#include "mesh/mesh_checks.hpp"
#include "mesh/mesh_mass.hpp"
#include "mesh/primitives.hpp"
#include "mesh/surface_mesh.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

using Texts = std::vector<std::string>;

// A cube of side 2 about the origin; vertex 0 is (-1, -1, -1), 6 is (1, 1, 1).
TriangleMesh cube() { return box_mesh({{2, 2, 2}}); }

TriangleMesh with(TriangleMesh mesh, const TriangleMesh& other, Vec3 shift = {}) {
  const Index first = static_cast<Index>(mesh.vertices.size());
  for (const Vec3 v : other.vertices) mesh.vertices.push_back(v + shift);
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
  return mesh;
}

TriangleMesh turned_over(TriangleMesh mesh) {
  for (std::array<Index, 3>& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

MeshRepair repair_of(const TriangleMesh& mesh, bool sheet = false) {
  return repaired(numbered(welded(mesh)), sheet);
}

// Volume of a repaired closed mesh, which must be sound.
Real volume_of(const MeshRepair& repair) {
  CHECK(mesh_defects(repair.mesh.mesh, false) == Texts{});
  return mesh_volume(repair.mesh.mesh);
}

}  // namespace

TEST_CASE("a sound mesh stays as it is") {
  const TriangleMesh hollow = with(cube(), turned_over(sphere_mesh({0.5, 1})));
  for (const TriangleMesh& given : {cube(), hollow, with(cube(), cube(), {0.5, 0.25, 2})}) {
    for (const bool sheet : {false, true}) {
      const TriangleMesh mesh = welded(given);
      const MeshRepair repair = repair_of(given, sheet);
      CHECK(repair.mesh.mesh.vertices == mesh.vertices);
      CHECK(repair.mesh.mesh.triangles == mesh.triangles);
      CHECK(repair_text(repair, sheet).empty());
    }
  }
}

TEST_CASE("a row of triangles without area that faces another row is joined across") {
  // The top edge of one side, from (0, 0) to (8, 0), is undivided; that of the other has seven points
  // between.
  TriangleMesh mesh;
  for (int i = 0; i <= 8; ++i) mesh.vertices.push_back({Real(i), 0, 0});
  mesh.vertices.push_back({4, 3, 0});
  mesh.vertices.push_back({4, -3, 0});
  mesh.triangles = {{0, 8, 9}};
  for (Index i = 0; i < 8; ++i) mesh.triangles.push_back({i + 1, i, 10});
  // A fan from the first point, and one from the last, between them.
  for (Index i = 1; i < 5; ++i) mesh.triangles.push_back({0, i, i + 1});
  mesh.triangles.push_back({0, 5, 8});
  for (Index i = 5; i < 7; ++i) mesh.triangles.push_back({8, i, i + 1});
  const MeshRepair repair = repair_of(mesh, true);
  CHECK(repair.without_area.count == 7);
  CHECK(repair.without_area.first == "triangle 9 (0, 0, 0) (1, 0, 0) (2, 0, 0)");
  CHECK(repair.mesh.mesh.triangles.size() == 16);
  CHECK(mesh_area(repair.mesh.mesh) == 24);
  // One plane without interior edges: no feature that a sphere could touch there remains.
  const SurfaceMesh surface = build_surface_mesh(repair.mesh.mesh, 0.5, true);
  CHECK(surface.parts.size() == 1);
}

TEST_CASE("a long row of triangles without area takes as many steps as it has") {
  // Fans from either end of an edge, one above the other, with the points of each between those of the
  // other.
  constexpr Index kCount = 2000;
  TriangleMesh mesh;
  for (Index i = 0; i <= 2 * kCount; ++i) mesh.vertices.push_back({Real(i), 0, 0});
  mesh.vertices.insert(mesh.vertices.end(), {{kCount, 1, 0}, {kCount, -1, 0}});
  const Index end = 2 * kCount, above = end + 1, below = end + 2;
  Index last = 0;
  for (Index i = 1; i < end; last = i, i += 2) mesh.triangles.push_back({last, i, above});
  mesh.triangles.push_back({last, end, above});
  last = 0;
  for (Index i = 2; i <= end; last = i, i += 2) mesh.triangles.push_back({i, last, below});
  for (Index i = 1; i + 2 < end; i += 2) mesh.triangles.push_back({0, i + 2, i});
  mesh.triangles.push_back({0, end, end - 1});
  for (Index i = 2; i < end; i += 2) mesh.triangles.push_back({end, i - 2, i});
  const MeshRepair repair = repair_of(mesh, true);
  CHECK(repair.without_area.count == 2 * kCount - 1);
  CHECK(mesh_defects(repair.mesh.mesh, true) == Texts{});
  CHECK(near(mesh_area(repair.mesh.mesh), 2 * kCount, {.relative = 1e-13}));
  CHECK(build_surface_mesh(repair.mesh.mesh, 0.5, true).parts.size() == 1);
}

TEST_CASE("corners that lie on each other but for round-off become one") {
  TriangleMesh mesh = cube();
  mesh.vertices.push_back(mesh.vertices[6] + Vec3{1e-14, 0, 0});
  const Index duplicate = static_cast<Index>(mesh.vertices.size()) - 1;
  // A triangle at the corner gets the other vertex, and a needle on either side closes the gap.
  const auto at =
      std::ranges::find_if(mesh.triangles, [](const auto& t) { return std::ranges::find(t, 6) != t.end(); });
  std::array<Index, 3>& one = *at;
  std::ranges::rotate(one, std::ranges::find(one, 6));
  const Index next = one[1], last = one[2];
  one[0] = duplicate;
  mesh.triangles.push_back({6, next, duplicate});
  mesh.triangles.push_back({duplicate, last, 6});
  const MeshRepair repair = repair_of(mesh);
  CHECK(repair.without_area.count == 2);
  CHECK(repair.mesh.mesh.vertices.size() == 8);
  CHECK(near(volume_of(repair), 8, {.relative = 1e-13}));
}

TEST_CASE("duplicate triangles: the edges decide which stay") {
  TriangleMesh twice = cube();
  twice.triangles.push_back({twice.triangles[4][1], twice.triangles[4][0], twice.triangles[4][2]});
  CHECK(repair_of(twice).twins.count == 1);
  CHECK(volume_of(repair_of(twice)) == 8);
  // A file with every triangle twice, and one with every face from both sides.
  for (const TriangleMesh& other : {cube(), turned_over(cube())}) {
    const MeshRepair repair = repair_of(with(cube(), other));
    CHECK(repair.twins.count == 12);
    CHECK(repair.twins.first.starts_with("triangle 12 "));
    CHECK(volume_of(repair) == 8);
  }
  // A wall between two boxes that share a face.
  TriangleMesh mirrored = turned_over(cube());
  for (Vec3& v : mirrored.vertices) v.x = 2 - v.x;
  const MeshRepair pair = repair_of(with(cube(), mirrored));
  CHECK(pair.twins.count == 4);
  CHECK(volume_of(pair) == 16);
  // A leaf of two triangles on each side is kept once on an open surface, and is no part of a solid.
  TriangleMesh leaf = cube();
  leaf.vertices.insert(leaf.vertices.end(), {{0, 0, 5}, {1, 0, 5}});
  leaf.triangles.insert(leaf.triangles.end(), {{0, 1, 8}, {8, 1, 0}, {1, 9, 8}, {8, 9, 1}});
  CHECK(repair_of(leaf).twins.count == 4);
  CHECK(volume_of(repair_of(leaf)) == 8);
  CHECK(repair_of(leaf, true).twins.count == 2);
  CHECK(repair_of(leaf, true).mesh.mesh.triangles.size() == 14);
  // A two-sided rectangle encloses nothing: one side is kept, and is open.
  const TriangleMesh plate = rectangle_mesh(1, 1);
  const MeshRepair both = repair_of(with(plate, turned_over(plate)));
  CHECK(both.mesh.mesh.triangles.size() == 2);
  CHECK(mesh_defects(both.mesh.mesh, false)[0].starts_with("4 edges have one triangle"));
}

TEST_CASE("shells are oriented outward, and cavities stay") {
  const TriangleMesh ball = sphere_mesh({0.5, 2}), small = sphere_mesh({0.2, 1});
  const Real of_ball = mesh_volume(ball), of_small = mesh_volume(small);
  const auto check = [&](const TriangleMesh& mesh, std::size_t turned, Real volume) {
    const MeshRepair repair = repair_of(mesh);
    CHECK(repair.turned.count == turned);
    CHECK(near(volume_of(repair), volume, {.relative = 1e-13}));
  };
  check(turned_over(cube()), 12, 8);
  // Outside, and all of it; the outer shell of a hollow body alone, and all of it.
  check(with(cube(), turned_over(ball), {4, 0, 0}), 320, 8 + of_ball);
  check(turned_over(with(cube(), ball, {4, 0, 0})), 332, 8 + of_ball);
  check(with(turned_over(cube()), turned_over(ball)), 12, 8 - of_ball);
  check(with(turned_over(cube()), ball), 332, 8 - of_ball);
  // A shell in a cavity.
  const TriangleMesh hollow = with(cube(), turned_over(ball));
  check(with(hollow, turned_over(small)), 80, 8 - of_ball + of_small);
  check(turned_over(with(hollow, small)), 412, 8 - of_ball + of_small);
  // A few triangles of the cavity.
  TriangleMesh some = hollow;
  for (std::size_t t = 20; t < 120; ++t) std::swap(some.triangles[t][1], some.triangles[t][2]);
  check(some, 100, 8 - of_ball);
  // A solid inside a solid is not an error of windings.
  const MeshRepair inner = repair_of(with(cube(), ball));
  CHECK(inner.turned.count == 0);
  CHECK(mesh_defects(inner.mesh.mesh, false)[0].starts_with("a shell lies inside another"));
}

TEST_CASE("an open surface may have any windings, and be one-sided") {
  TriangleMesh sheet = rectangle_mesh(2, 1);
  std::swap(sheet.triangles[1][1], sheet.triangles[1][2]);
  CHECK(mesh_defects(sheet, true) == Texts{});
  const MeshRepair repair = repair_of(sheet, true);
  CHECK(repair.turned.count == 1);
  CHECK(build_surface_mesh(repair.mesh.mesh, 0.5, true).parts.size() == 1);
  // A Moebius strip: an edge between opposite windings remains, without sides.
  TriangleMesh strip;
  constexpr int kCount = 24;
  for (int k = 0; k < kCount; ++k)
    for (const Real side : {-0.2, 0.2}) {
      const Real angle = 2 * M_PI * k / kCount, radius = 1 + side * std::cos(angle / 2);
      strip.vertices.push_back(
          {radius * std::cos(angle), radius * std::sin(angle), side * std::sin(angle / 2)});
    }
  for (Index k = 0; k < kCount; ++k) {
    const Index a = 2 * k, next = k + 1 < kCount ? a + 2 : 1, beside = k + 1 < kCount ? a + 3 : 0;
    strip.triangles.push_back({a, a + 1, beside});
    strip.triangles.push_back({a, beside, next});
  }
  const MeshRepair twisted = repair_of(strip, true);
  CHECK(mesh_defects(twisted.mesh.mesh, true) == Texts{});
  const SurfaceMesh surface = build_surface_mesh(twisted.mesh.mesh, 0.5, true);
  std::size_t seams = 0;
  for (const MeshFeature& feature : surface.features) seams += feature.b >= 0 && feature.tests == 3;
  CHECK(seams == 1);
}

}  // namespace scree
