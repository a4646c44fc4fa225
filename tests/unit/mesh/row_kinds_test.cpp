// Rows in which the nearest contact is the only one, and the safe displacement of cached contacts.
#include "mesh/row_kinds.hpp"

#include <cmath>

#include "mesh/cached_contact.hpp"
#include "support/catch.hpp"
#include "support/test_meshes.hpp"

namespace scree {

namespace {

// Open surfaces: plane, nearly plane, uneven, rough, and folded so that a sphere between two layers of one
// patch touches both; curved walls and solids.
std::vector<SurfaceMesh> meshes() {
  TriangleMesh folded = hills(12, 0.01, 9);
  for (Vec3& v : folded.vertices) v = v.x > 0.5 ? Vec3{1 - v.x, v.y, v.z + 0.17} : v;
  return {sheet_mesh(hills(12, 0, 1)),
          sheet_mesh(hills(12, 0.0001, 7)),
          sheet_mesh(hills(12, 0.005, 2)),
          sheet_mesh(hills(12, 0.02, 3)),
          sheet_mesh(hills(6, 0.3, 4)),
          sheet_mesh(folded),
          closed_mesh(drum_shell(60, 0.5, 1, 3)),
          closed_mesh(potato(3, 0, 4)),
          closed_mesh(potato(4, 0.002, 5)),
          closed_mesh(block({0, 0, 0}, {1, 1, 1}, 6))};
}

// Slivers, rough open surfaces, a thin plate, and solids with sharp edges.
std::vector<SurfaceMesh> rough_meshes() {
  TriangleMesh slivers = hills(6, 0.3, 5);
  for (Vec3& v : slivers.vertices) v.y /= 500;
  return {sheet_mesh(slivers),
          sheet_mesh(hills(6, 2, 3)),
          sheet_mesh(hills(1, 1, 4)),
          closed_mesh(drum_shell(12, 0.5, 1, 3)),
          closed_mesh(block({0, 0, 0}, {1, 1, 0.06}, 1)),
          closed_mesh(block({0, 0, 0}, {1, 1, 1}, 1)),
          closed_mesh(potato(2, 0.3, 2))};
}

std::vector<SurfaceMesh> joined(std::vector<SurfaceMesh> meshes, const std::vector<SurfaceMesh>& others) {
  meshes.insert(meshes.end(), others.begin(), others.end());
  return meshes;
}

constexpr Real kRadius = 0.1;

}  // namespace

TEST_CASE("on smooth rows the search for the nearest contact finds what the search for all does") {
  MeshRandom random(44);
  int all_smooth = 0, all_unclear = 0, one_sided = 0;
  for (const SurfaceMesh& surface : meshes()) {
    const MeshView view = surface.view();
    int wrong = 0;
    for (int i = 0; i < 10000; ++i) {
      const Vec3 c = position_near(surface, 1.2 * kRadius, random);
      const auto row = triangles_near(surface, c, 1.2 * kRadius);
      const auto n = static_cast<Index>(row.size());
      const RowKind kind = kind_of_row(view, row.data(), n);
      if (kind == RowKind::any) continue;
      ++all_smooth;
      const auto contacts = contacts_of_row(surface, c, kRadius, row);
      const bool is_seen_from_one_side = is_one_sided(view, row.data(), n, c, 0);
      one_sided += is_seen_from_one_side;
      wrong +=
          static_cast<int>(contacts.size()) > slots_needed(view, kind, is_seen_from_one_side, row.data(), n);
      const Index likely = i % 3 == 0 || row.empty() ? -1 : row[static_cast<std::size_t>(i) % row.size()];
      MeshContact nearest;
      const Nearest found = NearestContact(view, c, kRadius, RowKind::smooth)
                                .find({row.data(), n, likely}, SingleLane{}, nearest);
      all_unclear += found == Nearest::unclear;
      if (found == Nearest::none) wrong += !contacts.empty();
      if (found == Nearest::one) wrong += !same_contacts({nearest}, contacts);
    }
    CHECK(wrong == 0);
  }
  CHECK(all_smooth > 20000);
  CHECK(one_sided > all_smooth / 2);
  CHECK(one_sided < all_smooth);
  CHECK(all_unclear > 0);
  CHECK(all_unclear < all_smooth / 50);
}

TEST_CASE("one feature alone on a row that is not smooth is what the search for all finds") {
  MeshRandom random(45);
  int found_one = 0, several = 0, excluded = 0;
  for (const SurfaceMesh& surface : joined(meshes(), rough_meshes())) {
    const MeshView view = surface.view();
    int wrong = 0;
    for (int i = 0; i < 5000; ++i) {
      const Vec3 c = position_near(surface, 1.2 * kRadius, random);
      const auto triangles = triangles_near(surface, c, 1.2 * kRadius);
      const auto n = static_cast<Index>(triangles.size());
      const Index likely =
          i % 3 == 0 || n == 0 ? -1 : triangles[static_cast<std::size_t>(i) % triangles.size()];
      const TriangleRow row{triangles.data(), n, likely};
      std::vector<MeshContact> contacts(kMeshSlots);
      contacts.resize(find_mesh_contacts(view, c, kRadius, row, contacts.data()));
      MeshContact only;
      const Nearest found = NearestContact(view, c, kRadius, RowKind::any).find(row, SingleLane{}, only);
      if (found == Nearest::none) wrong += !contacts.empty();
      if (found == Nearest::one) ++found_one, wrong += !same_contacts({only}, contacts);
      several += found == Nearest::unclear;
      const TriangleRow narrowed = with_contacts_only(view, c, kRadius, row, SingleLane{});
      for (Index k = 0; k < n; ++k) excluded += !narrowed.is_chosen(k);
      std::vector<MeshContact> of_narrowed(kMeshSlots);
      of_narrowed.resize(find_mesh_contacts(view, c, kRadius, narrowed, of_narrowed.data()));
      wrong += !same_contacts(of_narrowed, contacts);
    }
    CHECK(wrong == 0);
  }
  CHECK(found_one > 10000);
  CHECK(several > 2000);
  CHECK(excluded > 100000);
}

TEST_CASE("as long as a sphere stays it touches the feature that it touched, or nothing") {
  MeshRandom random(48);
  int over = 0, over_rough = 0, at_edges = 0, clear = 0;
  for (const SurfaceMesh& surface : joined(meshes(), rough_meshes())) {
    const MeshView view = surface.view();
    int wrong = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vec3 c = position_near(surface, 1.2 * kRadius, random);
      const auto row = triangles_near(surface, c, 1.4 * kRadius);
      const auto n = static_cast<Index>(row.size());
      const auto contacts = contacts_of_row(surface, c, kRadius, row);
      const CachedContactRow<SingleLane> at{view,   kind_of_row(view, row.data(), n), row.data(), n, c,
                                            kRadius};
      CachedContact cached = kNoCachedContact;
      if (contacts.empty())
        cached = at.clear();
      else if (contacts.size() == 1 && contacts[0].feature < view.part_count)
        cached = at.over(contacts[0].triangle);
      else if (contacts.size() == 1)
        cached = at.in_region_of(contacts[0]);
      for (int k = 0; k < 10 && cached.safe_distance > 0; ++k) {
        const Real part_of_room = k % 2 == 0 ? random.in(0, 1) : Real(0.999999);
        const Vec3 moved = c + part_of_room * cached.safe_distance * random.direction();
        if (!cached.holds(moved)) continue;
        const auto found = contacts_of_row(surface, moved, kRadius, row);
        if (cached.triangle < 0) {
          ++clear, wrong += !found.empty();
          continue;
        }
        const Real distance = std::abs(mesh_feature_at(view, cached.feature, moved, {}).distance);
        const bool touches = distance < kRadius;
        ++over, over_rough += at.kind == RowKind::any, at_edges += cached.feature >= view.part_count;
        wrong += found.size() != touches ||
                 (touches && (found[0].feature != cached.feature || found[0].triangle != cached.triangle ||
                              found[0].distance != distance));
      }
    }
    CHECK(wrong == 0);
  }
  CHECK(over > 20000);
  CHECK(over_rough > 20000);
  CHECK(at_edges > 10000);
  CHECK(clear > 2000);
}

// The other triangle lies beyond the edge from (0, 0, 0) to (1, 0, 0) and rises from there, or is higher by
// less than the uncertainty.
TEST_CASE("beside an edge a sphere stays over a triangle while what lies past the edge is farther") {
  int stands = 0, wrong = 0;
  for (const Real slope : {0.0, 1e-6, 1e-3, 0.2, 1.0})
    for (const Real higher : {0.0, 2e-15})
      for (const Real height : {1e-3, 0.1, 2.0})
        for (const Real inside : {1e-8, 1e-5, 1e-3, 0.1}) {
          const SurfaceMesh surface = sheet_mesh(
              {{{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0, 0, higher}, {1, 0, higher}, {0.5, -1, slope + higher}},
               {{0, 1, 2}, {3, 5, 4}}});
          const MeshView view = surface.view();
          REQUIRE(higher < mesh_detail::uncertainty(view));
          const Index row[] = {0, 1}, below = view.vertices[view.triangles[0].vertex[2]].y > 0 ? 0 : 1;
          const Vec3 c{0.5, inside, height};
          const CachedContactRow<SingleLane> at{view, RowKind::smooth, row, 2, c, 2 * height};
          const CachedContact cached = at.over(below);
          stands += cached.safe_distance > 0;
          for (int k = 0; k <= 8; ++k) {
            const Real turn = M_PI * k / 16;
            const Vec3 moved = c + 0.999999 * cached.safe_distance * Vec3{0, -std::cos(turn), std::sin(turn)};
            wrong += cached.safe_distance > 0 &&
                     !(mesh_detail::distance_to(view, view.triangles[1 - below], moved) > moved.z);
          }
        }
  CHECK(stands > 50);
  CHECK(wrong == 0);
}

}  // namespace scree
