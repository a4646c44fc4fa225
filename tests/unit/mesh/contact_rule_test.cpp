// Properties of contacts on any mesh: the nearest point is among them, whatever the order of the row; and
// further properties of features used in runs.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "mesh/mesh_contacts.hpp"
#include "mesh/row_kinds.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/test_meshes.hpp"

namespace scree {

namespace {

bool inside_potato(const SurfaceMesh& mesh, Vec3 c) {
  for (const MeshTriangle& triangle : mesh.triangles) {
    const Vec3 a = mesh.vertices[triangle.vertex[0]], b = mesh.vertices[triangle.vertex[1]],
               d = mesh.vertices[triangle.vertex[2]];
    if (dot(c, cross(a, b)) >= 0 && dot(c, cross(b, d)) >= 0 && dot(c, cross(d, a)) >= 0)
      return dot(c - a, cross(b - a, d - a)) < 0;
  }
  return false;
}

Real distance_from(const SurfaceMesh& mesh, Vec3 c) {
  Real least = kInfinity;
  for (const MeshTriangle& triangle : mesh.triangles)
    least =
        std::min(least, squared_distance(mesh.vertices[triangle.vertex[0]], mesh.vertices[triangle.vertex[1]],
                                         mesh.vertices[triangle.vertex[2]], c));
  return std::sqrt(least);
}

// The rule on an open surface, implemented literally with all candidates at once.
std::vector<MeshContact> contacts_by_rule(const SurfaceMesh& mesh, Vec3 c, Real reach) {
  using namespace mesh_detail;
  const MeshView view = mesh.view();
  std::vector<MeshContact> candidates, kept;
  std::vector<bool> seen(mesh.parts.size(), false);
  const auto add = [&](MeshContact contact, Index t) {
    contact.triangle = t;
    if (contact.distance < reach) candidates.push_back(contact);
  };
  for (Index t = 0; t < view.triangle_count; ++t) {
    const MeshTriangle& triangle = mesh.triangles[t];
    if (!seen[triangle.part] && edges_passed(view, triangle, mesh.parts[triangle.part].normal, c) == 0) {
      seen[triangle.part] = true;
      const MeshPart& part = mesh.parts[triangle.part];
      const bool behind = dot(c - part.point, part.normal) < 0;
      add(mesh_feature_at(view, triangle.part, c, behind ? opposite(part.normal) : part.normal), t);
    }
    for (Index row = triangle.first_feature; row < triangle.first_feature + triangle.features; ++row) {
      const MeshFeature& feature = mesh.features[row];
      Vec3 from = c - mesh.vertices[feature.a];
      if (feature.b < 0 ? cone_of_vertex(view, feature, from) == Cone::inside
                        : in_cone_of_edge(view, feature, c, kInfinity, from))
        add(contact_from(view, row, c, from), t);
    }
  }
  std::sort(candidates.begin(), candidates.end(),
            [&](const MeshContact& a, const MeshContact& b) { return comes_before(view, a, b); });
  for (const MeshContact& contact : candidates)
    if (kept.size() < kMeshSlots && std::none_of(kept.begin(), kept.end(), [&](const MeshContact& nearer) {
          return same_cluster(view, contact, nearer);
        }))
      kept.push_back(contact);
  return kept;
}

}  // namespace

TEST_CASE("the nearest point of an open surface is a contact, also where regions meet") {
  MeshRandom random(41);
  for (const TriangleMesh& mesh :
       {hills(6, 0.02, 1), hills(6, 0.3, 2), hills(6, 2, 3), hills(1, 1, 4), drum_shell(12, 0.5, 1, 3),
        rotated(block({0, 0, 0}, {1, 1, 1}, 2), random.turn()), mapped(hills(6, 0.3, 5), [](Vec3 v) {
          return Vec3{v.x, v.y / 500, v.z};
        })}) {
    const SurfaceMesh surface = sheet_mesh(mesh);
    int wrong = 0;
    for (int i = 0; i < 10000; ++i) {
      const Vec3 c = position_near(surface, 0.2, random);
      const auto contacts = contacts_at(surface, c, 0.25);
      wrong += contacts.empty() || std::abs(contacts[0].distance - distance_from(surface, c)) > 1e-12;
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("where a face was touched last changes no contact") {
  MeshRandom random(40);
  for (const SurfaceMesh& surface :
       {sheet_mesh(hills(6, 0, 1)), sheet_mesh(hills(6, 0.3, 2)), closed_mesh(drum_shell(12, 0.5, 1, 3)),
        closed_mesh(block({0, 0, 0}, {1, 1, 1}, 4)), closed_mesh(potato(2, 0.1, 2))}) {
    const MeshView view = surface.view();
    int wrong = 0, in_one_plane = 0;
    for (int i = 0; i < 3000; ++i) {
      const Vec3 c = position_near(surface, 0.2, random);
      const auto row = triangles_near(surface, c, 0.25);
      const auto n = static_cast<Index>(row.size());
      const bool one_plane = slots_needed(view, RowKind::any, false, row.data(), n) == 1;
      in_one_plane += one_plane;
      const auto contacts = contacts_of_row(surface, c, 0.25, row);
      for (Index likely = -1; likely <= view.triangle_count; likely += 1 + view.triangle_count / 40) {
        std::vector<MeshContact> found(kMeshSlots);
        found.resize(find_mesh_contacts(view, c, 0.25, {row.data(), n, likely}, found.data()));
        // Near one plane alone that face is all.
        MeshContact face;
        if (one_plane && stays_over(view, likely, c, 0.25, face)) wrong += !same_contacts({face}, contacts);
        wrong += !same_contacts(found, contacts);
      }
    }
    CHECK(wrong == 0);
    CHECK((in_one_plane > 100 || view.part_count > 6));
  }
}

// Features beyond touch must not change the contacts.
TEST_CASE("a query with a larger range finds the contacts of a smaller one first, then farther ones") {
  constexpr Real kRadius = 0.2;
  MeshRandom random(43);
  for (const SurfaceMesh& surface :
       {sheet_mesh(hills(6, 0, 1)), sheet_mesh(hills(6, 0.3, 2)), sheet_mesh(hills(6, 2, 3)),
        closed_mesh(drum_shell(12, 0.5, 1, 3)), closed_mesh(block({0, 0, 0}, {1, 1, 1}, 4)),
        closed_mesh(potato(2, 0.1, 2))}) {
    int wrong = 0, farther = 0;
    for (int i = 0; i < 10000; ++i) {
      const Vec3 c = position_near(surface, 1.3 * kRadius, random);
      const auto touched = contacts_at(surface, c, kRadius);
      auto found = contacts_at(surface, c, kRadius * random.in(1, 1.3));
      const auto beyond = std::find_if(found.begin(), found.end(), [](const MeshContact& contact) {
        return !(std::abs(contact.distance) < kRadius);  // or too far inside
      });
      farther += beyond != found.end();
      found.erase(beyond, found.end());
      wrong += !same_contacts(found, touched);
    }
    CHECK(wrong == 0);
    CHECK(farther > 300);
  }
}

// More than kMeshSlots nearer facets, which are one contact, displace the floor from the first pass.
TEST_CASE("the last touched triangle changes no contact, also with many nearer ones") {
  constexpr int kFacets = 64;
  constexpr Real kHalf = 0.45 * M_PI, kReach = 0.95;
  TriangleMesh mesh;  // a concave wall beside a fine floor
  for (int k = 0; k <= kFacets; ++k) {
    const Real angle = -kHalf + 2 * kHalf * k / kFacets;
    mesh.vertices.push_back({std::cos(angle), std::sin(angle), 0.02});
    mesh.vertices.push_back({std::cos(angle), std::sin(angle), 2});
  }
  for (Index a = 0; a < 2 * kFacets; a += 2)
    mesh.triangles.push_back({a, a + 1, a + 2}), mesh.triangles.push_back({a + 2, a + 1, a + 3});
  append(mesh, plate({-1.1, -1.1, 0}, {2.2, 0, 0}, {0, 2.2, 0}, 22, 22));
  const SurfaceMesh surface = sheet_mesh(mesh);
  MeshRandom random(1);
  int wrong = 0, with_floor = 0;
  for (int i = 0; i < 100; ++i) {
    const Vec3 c{random.in(0.05, 0.2), random.in(-0.05, 0.05), random.in(0.9, 0.95)};
    const auto row = triangles_near(surface, c, kReach);
    const auto contacts = contacts_of_row(surface, c, kReach, row);
    with_floor += contacts.size() > 1;
    for (const Index likely : row) {
      std::vector<MeshContact> found(kMeshSlots);
      found.resize(find_mesh_contacts(surface.view(), c, kReach,
                                      {row.data(), static_cast<Index>(row.size()), likely}, found.data()));
      wrong += !same_contacts(found, contacts);
    }
  }
  CHECK(with_floor > 50);
  CHECK(wrong == 0);
}

TEST_CASE("the nearest point of a closed mesh is a contact from outside, from inside no edge") {
  MeshRandom random(42);
  for (const TriangleMesh& mesh :
       {potato(1, 0.3, 1), potato(2, 0.1, 2), potato(2, 0.01, 3), potato(3, 0, 4)}) {
    const SurfaceMesh surface = closed_mesh(mesh);
    int wrong = 0, outside = 0;
    for (int i = 0; i < 10000; ++i) {
      const Vec3 c = position_near(surface, 0.2, random);
      const auto contacts = contacts_at(surface, c, 0.25);
      const Real distance = distance_from(surface, c);
      if (distance < 1e-12) continue;
      if (!inside_potato(surface, c)) {
        ++outside;
        wrong += contacts.empty() || std::abs(contacts[0].distance - distance) > 1e-12;
      } else if (!contacts.empty()) {
        wrong += contacts[0].distance < 0 &&
                 (contacts.size() != 1 || contacts[0].feature >= static_cast<Index>(surface.parts.size()));
      }
    }
    CHECK(wrong == 0);
    CHECK(outside > 2000);
  }
}

TEST_CASE("a convex body has one contact, wherever the sphere is") {
  MeshRandom random(49);
  for (const TriangleMesh& mesh :
       {icosphere(0, 1), icosphere(3, 1), tetrahedron(), block({0, 0, 0}, {1, 1, 1}, 3)}) {
    const SurfaceMesh body = closed_mesh(rotated(mesh, random.turn()));
    int wrong = 0, outside = 0;
    for (int i = 0; i < 20000; ++i) {
      const Vec3 c = position_near(body, 0.3, random);
      const Real distance = distance_from(body, c);
      if (distance < 1e-12) continue;
      const auto contacts = contacts_at(body, c, 0.5);
      wrong += contacts.size() > 1;
      if (contacts.empty() || contacts[0].distance < 0) continue;
      ++outside;
      wrong += std::abs(contacts[0].distance - distance) > 1e-14;
    }
    CHECK(wrong == 0);
    CHECK(outside > 5000);
  }
}

TEST_CASE("where sides are flat but for noise, edges count from outside and never from inside") {
  MeshRandom random(48);
  for (const Real noise : {1e-8, 1e-10, 1e-11, 3e-12, 1e-12, 3e-13, 1e-13}) {
    const TriangleMesh box = mapped(block({0, 0, 0}, {1, 1, 1}, 4), [&](Vec3 v) {
      return v + random.in({-noise, -noise, -noise}, {noise, noise, noise});
    });
    const SurfaceMesh mesh = closed_mesh(box);
    int wrong = 0, found = 0;
    for (int i = 0; i < 10000; ++i) {
      const Vec3 c = position_near(mesh, 0.1, random);
      const Real depth = std::min({c.x, c.y, c.z, 1 - c.x, 1 - c.y, 1 - c.z});
      const auto contacts = contacts_at(mesh, c, 0.2);
      if (depth < -1e-3)
        wrong += contacts.empty() || std::abs(contacts[0].distance - distance_from(mesh, c)) > 4e-12;
      if (depth < 1e-3) continue;
      found += contacts.size() == 1;
      for (const MeshContact& contact : contacts)
        wrong += contact.distance > 0 || contact.feature >= static_cast<Index>(mesh.parts.size());
    }
    CHECK(wrong == 0);
    CHECK(found > 1000);
  }
}

TEST_CASE("contacts depend neither on the order of the row nor on what else is in it") {
  MeshRandom random(43);
  std::mt19937 engine(44);
  for (const SurfaceMesh& mesh : {sheet_mesh(hills(8, 0.3, 1)), closed_mesh(potato(2, 0.1, 2)),
                                  closed_mesh(flipped(icosphere(0, 1))), sheet_mesh(jittered_grid(10, 5))}) {
    bool same = true;
    for (int i = 0; i < 2000; ++i) {
      const Vec3 c = position_near(mesh, 0.3, random);
      const Real reach = random.in(0.2, 1);
      auto row = triangles_near(mesh, c, reach);
      const auto contacts = contacts_of_row(mesh, c, reach, row);
      std::shuffle(row.begin(), row.end(), engine);
      same = same && same_contacts(contacts, contacts_of_row(mesh, c, reach, row));
      row.resize(mesh.triangles.size());
      for (std::size_t t = 0; t < row.size(); ++t) row[t] = static_cast<Index>(t);
      std::shuffle(row.begin(), row.end(), engine);
      same = same && same_contacts(contacts, contacts_of_row(mesh, c, reach, row));
    }
    CHECK(same);
  }
}

TEST_CASE("where a sphere touches more than there are slots the nearest count") {
  MeshRandom random(45);
  std::size_t most = 0;
  for (const Real angle : {0.0, kFeatureAngle, 1.2}) {
    const SurfaceMesh mesh = build_surface_mesh(hills(7, 1.5, 6), angle, true);
    bool same = true;
    for (int i = 0; i < 1000; ++i) {
      const Vec3 c = random.in({0, 0, -0.5}, {1, 1, 2});
      const auto contacts = contacts_at(mesh, c, 1);
      most = std::max(most, contacts.size());
      same = same && same_contacts(contacts, contacts_by_rule(mesh, c, 1));
    }
    CHECK(same);
  }
  CHECK(most == kMeshSlots);
}

TEST_CASE("a row needs at least as many slots as contacts come of it") {
  MeshRandom random(46);
  const auto needed = [](const SurfaceMesh& mesh, const std::vector<Index>& row) {
    const MeshView view = mesh.view();
    const auto n = static_cast<Index>(row.size());
    return slots_needed(view, kind_of_row(view, row.data(), n), false, row.data(), n);
  };
  const SurfaceMesh mesh = sheet_mesh(hills(6, 0.3, 7));
  bool enough = true;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 c = position_near(mesh, 0.3, random);
    const auto row = triangles_near(mesh, c, 0.2);
    enough = enough && static_cast<int>(contacts_of_row(mesh, c, 0.2, row).size()) <= needed(mesh, row);
  }
  CHECK(enough);
  const SurfaceMesh flat = sheet_mesh(unit_grid(10, 10));
  CHECK(needed(flat, triangles_near(flat, {0.5, 0.5, 0}, 0.25)) == 1);
  CHECK(needed(flat, {}) == 0);
  CHECK(needed(mesh, triangles_near(mesh, {0.5, 0.5, 0}, 2)) == kMeshSlots);
}

TEST_CASE("a feature evaluated elsewhere agrees with its own contact") {
  MeshRandom random(47);
  const SurfaceMesh mesh = sheet_mesh(hills(6, 0.3, 8));
  bool same = true;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 c = position_near(mesh, 0.2, random);
    for (const MeshContact& contact : contacts_at(mesh, c, 0.25)) {
      const MeshContact seen = mesh_feature_at(mesh.view(), contact.feature, c, contact.normal);
      same = same && same_bits(seen.distance, contact.distance) && seen.normal == contact.normal &&
             same_bits(seen.point, contact.point);
      const MeshContact behind = mesh_feature_at(mesh.view(), contact.feature, c, -contact.normal);
      same = same && behind.distance == -contact.distance && behind.normal == -contact.normal;
    }
  }
  CHECK(same);
}

TEST_CASE("features are on neighbouring patches where their sides share an edge") {
  const SurfaceMesh mesh = closed_mesh(block({0, 0, 0}, {1, 1, 1}, 2));
  const MeshView view = mesh.view();
  const auto feature = [&](Vec3 c) { return contacts_at(mesh, c, 1).at(0).feature; };
  const Index top = feature({0.4, 0.4, 1.1}), bottom = feature({0.4, 0.4, -0.1}),
              side = feature({1.1, 0.4, 0.4}), edge = feature({1.1, 0.4, 1.1}),
              corner = feature({1.1, 1.1, 1.1}), far_corner = feature({-0.1, -0.1, -0.1});
  CHECK(edge >= view.part_count);
  CHECK(on_neighbouring_patches(view, top, top));
  CHECK(on_neighbouring_patches(view, top, side));
  CHECK_FALSE(on_neighbouring_patches(view, top, bottom));
  CHECK(on_neighbouring_patches(view, edge, top));
  CHECK(on_neighbouring_patches(view, edge, bottom));
  CHECK(on_neighbouring_patches(view, corner, far_corner));
}

TEST_CASE("a centre on the surface has a normal, too") {
  const SurfaceMesh sheet = sheet_mesh(unit_grid(2, 2)), box = closed_mesh(block({0, 0, 0}, {1, 1, 1}, 2));
  for (const Vec3 c : {Vec3{0.3, 0.3, 0}, Vec3{0.5, 0.5, 0}, Vec3{0, 0, 0}, Vec3{1, 0.2, 0}, Vec3{1, 1, 0}}) {
    for (const SurfaceMesh* mesh : {&sheet, &box}) {
      const auto contacts = contacts_at(*mesh, c, 0.1);
      REQUIRE(contacts.size() == 1);
      CHECK(contacts[0].distance == 0);
      CHECK(near(norm(contacts[0].normal), 1, {.absolute = kUlp}));
    }
  }
}

}  // namespace scree
