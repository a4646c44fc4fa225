// A flat mesh is a plane: one contact everywhere, with its bits.
#include <algorithm>

#include "mesh/mesh_contacts.hpp"
#include "physics/contact_geometry.hpp"
#include "support/bits.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/test_meshes.hpp"

namespace scree {

namespace {

// A grid of slivers: some 1 : 1000.
TriangleMesh sliver_grid(unsigned seed) {
  MeshRandom random(seed);
  return mapped(unit_grid(2, 500), [&](Vec3 v) {
    if (v.x > 0 && v.x < 1) v.x += random.in(-0.2, 0.2);
    return v;
  });
}

std::vector<TriangleMesh> flat_meshes() {
  const auto large = [](Vec3 v) { return Real(1000) * v; };
  return {unit_grid(1, 1),
          unit_grid(7, 5),
          jittered_grid(4, 1),
          jittered_grid(20, 2),
          sliver_grid(3),
          unit_grid(1, 1000),
          jittered_grid(60, 4),
          mapped(unit_grid(1, 1), large),
          mapped(jittered_grid(50, 5), large),
          mapped(sliver_grid(6), large)};
}

// Positions over a mesh: random, over vertices, over edges, and one ulp beside either.
Vec3 position_over(const TriangleMesh& mesh, MeshRandom& random) {
  const auto& t = mesh.triangles[random.below(static_cast<Index>(mesh.triangles.size()))];
  const Vec3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
  const Index kind = random.below(4);
  Real u = random.in(0, 1), v = random.in(0, 1);
  if (u + v > 1) u = 1 - u, v = 1 - v;
  if (kind == 0) return a + u * (b - a) + v * (c - a);
  Vec3 p = kind == 1 ? a : a + u * (b - a);
  if (kind == 3) p.x = std::nextafter(p.x, random.in(-1, 1)), p.y = std::nextafter(p.y, random.in(-1, 1));
  return p;
}

// At the border itself round-off decides between face and edge.
bool inside_border(Vec3 p, Real size) {
  const Real margin = 1e-9 * size;
  return std::min(p.x, p.y) > margin && std::max(p.x, p.y) < size - margin;
}

}  // namespace

TEST_CASE("an axis-aligned flat mesh has the bits of the plane everywhere") {
  MeshRandom random(8);
  for (const TriangleMesh& mesh : flat_meshes()) {
    const Real size = mesh.vertices.back().x, offset = 0.1;
    const SurfaceMesh surface = sheet_mesh(mapped(mesh, [&](Vec3 v) { return v + Vec3{0, 0, offset}; }));
    REQUIRE(surface.parts.size() == 1);
    int wrong = 0;
    for (int i = 0; i < 100000; ++i) {
      const Vec3 p = position_over(mesh, random);
      if (!inside_border(p, size)) continue;
      const Vec3 c = p + Vec3{0, 0, offset + random.in(0.001, 0.01)};
      const Real radius = 0.01;
      const auto contacts = contacts_at(surface, c, radius);
      const ContactGeometry plane = plane_pair(c, radius, {0, 0, offset}, {0, 0, 1});
      wrong += contacts.size() != 1 || contacts[0].feature != 0 ||
               !same_bits(radius - dot(c - contacts[0].point, contacts[0].normal), plane.overlap) ||
               !same_bits(contacts[0].distance, plane.distance) ||
               !same_bits(contacts[0].normal, plane.direction);
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("a tilted flat mesh is the plane but for round-off") {
  MeshRandom random(9);
  for (const TriangleMesh& mesh : flat_meshes()) {
    const Real size = mesh.vertices.back().x;
    const Mat3 turn = random.turn();
    const SurfaceMesh surface = sheet_mesh(rotated(mesh, turn));
    REQUIRE(surface.parts.size() == 1);
    int wrong = 0;
    Real error = 0;
    for (int i = 0; i < 30000; ++i) {
      Vec3 c = position_over(mesh, random);
      if (!inside_border(c, size)) continue;
      const Real height = random.in(0.001, 0.01);
      c.z = height;
      const auto contacts = contacts_at(surface, turn * c, 0.01);
      wrong += contacts.size() != 1 || contacts[0].feature >= static_cast<Index>(surface.parts.size());
      if (contacts.empty()) continue;
      error = std::max({error, std::abs(contacts[0].distance - height) / size,
                        norm(contacts[0].normal - turn * Vec3{0, 0, 1})});
    }
    CHECK(wrong == 0);
    CHECK(error < 1e-12);
  }
}

TEST_CASE("a flat mesh far from its origin, or very small, is one plane") {
  MeshRandom random(10);
  for (const Real size : {1e-6, 1.0})
    for (const Real away : {0.0, 1e6 * size}) {
      const Mat3 turn = random.turn();
      const TriangleMesh mesh = jittered_grid(12, 7);
      const auto placed = [&](Vec3 v) { return turn * (size * v + Vec3{away, away, 0}); };
      const SurfaceMesh surface = sheet_mesh(mapped(mesh, placed));
      REQUIRE(surface.parts.size() == 1);
      int wrong = 0;
      for (int i = 0; i < 10000; ++i) {
        Vec3 c = position_over(mesh, random);
        if (std::min(c.x, c.y) < 1e-6 || std::max(c.x, c.y) > 1 - 1e-6) continue;
        c.z = 0.05;
        const auto contacts = contacts_at(surface, placed(c), 0.1 * size);
        wrong +=
            contacts.size() != 1 || std::abs(contacts[0].distance - 0.05 * size) > 4 * kUlp * (away + size);
      }
      CHECK(wrong == 0);
    }
}

}  // namespace scree
