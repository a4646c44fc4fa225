// Meshes for tests of contacts, random positions, and the contacts of a sphere on a mesh.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "base/mat3.hpp"
#include "mesh/mesh_contacts.hpp"
#include "mesh/mesh_tree.hpp"
#include "mesh/primitives.hpp"
#include "mesh/surface_mesh.hpp"
#include "mesh/triangle_mesh.hpp"
#include "mesh/weld.hpp"
#include "support/bits.hpp"

namespace scree {

inline constexpr Real kFeatureAngle = M_PI / 6;  // [rad]

class MeshRandom {
 public:
  explicit MeshRandom(unsigned seed) : engine_(seed) {}
  Real in(Real low, Real high) { return low + (high - low) * (engine_() / 4294967296.0); }
  Index below(Index count) { return static_cast<Index>(engine_() % static_cast<unsigned>(count)); }
  Vec3 in(Vec3 low, Vec3 high) { return {in(low.x, high.x), in(low.y, high.y), in(low.z, high.z)}; }
  Vec3 direction() {
    for (;;) {
      const Vec3 v = in({-1, -1, -1}, {1, 1, 1});
      const Real square = dot(v, v);
      if (square > 0.01 && square < 1) return (1 / std::sqrt(square)) * v;
    }
  }
  // A random rotation about a random axis.
  Mat3 turn() {
    const Vec3 x = direction(), z = unit_of(cross(x, direction()));
    return transposed(Mat3{x, cross(z, x), z});
  }

 private:
  static Vec3 unit_of(Vec3 a) { return (1 / norm(a)) * a; }

  std::mt19937 engine_;
};

inline void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const Index first = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
}

// Applies a function to every vertex.
template <class Function>
TriangleMesh mapped(TriangleMesh mesh, const Function& function) {
  for (Vec3& v : mesh.vertices) v = function(v);
  return mesh;
}

inline TriangleMesh rotated(const TriangleMesh& mesh, const Mat3& turn) {
  return mapped(mesh, [&](Vec3 v) { return turn * v; });
}

// The mesh with inverted windings.
inline TriangleMesh flipped(TriangleMesh mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

// nx by ny squares of two triangles each, from (0, 0) to (1, 1), facing +z.
inline TriangleMesh unit_grid(int nx, int ny) {
  TriangleMesh mesh;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) mesh.vertices.push_back({Real(i) / nx, Real(j) / ny, 0});
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const Index a = j * (nx + 1) + i, b = a + 1, c = a + nx + 2, d = a + nx + 1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

// A parallelogram of nx by ny squares; faces along cross(x, y).
inline TriangleMesh plate(Vec3 corner, Vec3 x, Vec3 y, int nx, int ny) {
  return mapped(unit_grid(nx, ny), [&](Vec3 v) { return corner + v.x * x + v.y * y; });
}

// The inner vertices of a unit grid moved by up to a quarter of its width.
inline TriangleMesh jittered_grid(int n, unsigned seed) {
  MeshRandom random(seed);
  return mapped(unit_grid(n, n), [&](Vec3 v) {
    const Real width = 0.24 / n, x = random.in(-width, width), y = random.in(-width, width);
    if (v.x > 0 && v.x < 1) v.x += x;
    if (v.y > 0 && v.y < 1) v.y += y;
    return v;
  });
}

// A closed block, each side n by n squares, outwards.
inline TriangleMesh block(Vec3 min, Vec3 max, int n) {
  const Vec3 d = max - min, x{d.x, 0, 0}, y{0, d.y, 0}, z{0, 0, d.z};
  TriangleMesh mesh = plate(min, y, x, n, n);
  append(mesh, plate(min + z, x, y, n, n));
  append(mesh, plate(min, z, y, n, n));
  append(mesh, plate(min + x, y, z, n, n));
  append(mesh, plate(min, x, z, n, n));
  append(mesh, plate(min + y, z, x, n, n));
  return welded(mapped(mesh, [&](Vec3 v) {
    const auto snapped = [](Real a, Real low, Real high) {
      return std::abs(a - high) < 1e-9 * (high - low) ? high : a;
    };
    return Vec3{snapped(v.x, min.x, max.x), snapped(v.y, min.y, max.y), snapped(v.z, min.z, max.z)};
  }));
}

inline TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

// An icosahedron whose triangles are quartered `level` times, its vertices on the sphere; outwards.
inline TriangleMesh icosphere(int level, Real radius) { return sphere_mesh({radius, level}); }

// A strip along a line in the plane y = 0, from y = 0 to `width`, `rows` squares wide; up is to the left of
// the line, seen against y. The line is closed where its ends are the same point.
inline TriangleMesh strip(const std::vector<Vec3>& line, Real width, int rows) {
  TriangleMesh mesh;
  for (std::size_t i = 0; i + 1 < line.size(); ++i)
    append(mesh, plate(line[i], line[i + 1] - line[i], {0, width, 0}, 1, rows));
  // plate() adds its sides to its corner: the far ends have another last bit.
  const std::size_t n = 2 * static_cast<std::size_t>(rows + 1);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3 p = line[v / n + v % 2];
    mesh.vertices[v].x = p.x, mesh.vertices[v].z = p.z;
  }
  return welded(mesh);
}

// The shell of a drum of n facets about the y axis with corners at this radius, seen from inside; the first
// corner is lowest.
inline TriangleMesh drum_shell(int facets, Real radius, Real width, int rows) {
  std::vector<Vec3> line;
  for (int i = 0; i < facets; ++i) {
    const Real angle = 2 * M_PI * i / facets;
    line.push_back({radius * std::sin(angle), 0, -radius * std::cos(angle)});
  }
  line.push_back(line.front());
  return strip(line, width, rows);
}

inline SurfaceMesh closed_mesh(const TriangleMesh& mesh) {
  return build_surface_mesh(mesh, kFeatureAngle, false);
}
inline SurfaceMesh sheet_mesh(const TriangleMesh& mesh) {
  return build_surface_mesh(mesh, kFeatureAngle, true);
}

inline std::vector<Index> triangles_near(const SurfaceMesh& mesh, Vec3 c, Real reach) {
  std::vector<Index> row;
  for_each_triangle_near(mesh.view(), c, reach, [&](Index t) { row.push_back(t); });
  return row;
}

inline std::vector<MeshContact> contacts_of_row(const SurfaceMesh& mesh, Vec3 c, Real reach,
                                                const std::vector<Index>& row) {
  std::vector<MeshContact> contacts(kMeshSlots);
  const MeshView view = mesh.view();
  contacts.resize(
      find_mesh_contacts(view, c, reach, {row.data(), static_cast<Index>(row.size())}, contacts.data()));
  return contacts;
}

inline std::vector<MeshContact> contacts_at(const SurfaceMesh& mesh, Vec3 c, Real reach) {
  return contacts_of_row(mesh, c, reach, triangles_near(mesh, c, reach));
}

// The sum of the overlaps along the normals: the force of a linear spring over its stiffness [m].
inline Vec3 push_on(const SurfaceMesh& mesh, Vec3 c, Real radius) {
  Vec3 sum;
  for (const MeshContact& contact : contacts_at(mesh, c, radius))
    sum += (radius - contact.distance) * contact.normal;
  return sum;
}

// Hills and pits of this height on a unit grid of n by n.
inline TriangleMesh hills(int n, Real height, unsigned seed) {
  MeshRandom random(seed);
  return mapped(jittered_grid(n, seed), [&](Vec3 v) { return Vec3{v.x, v.y, random.in(0, height)}; });
}

// A ball whose radius varies from vertex to vertex, so that every ray from its centre crosses it once.
inline TriangleMesh potato(int level, Real variation, unsigned seed) {
  MeshRandom random(seed);
  return mapped(icosphere(level, 1), [&](Vec3 v) { return (1 + random.in(-variation, variation)) * v; });
}

// A random position near a mesh, or at the border of regions: over a vertex or a point of an edge along the
// normal of one of the faces there.
inline Vec3 position_near(const SurfaceMesh& mesh, Real height, MeshRandom& random) {
  const MeshTriangle& triangle = mesh.triangles[random.below(static_cast<Index>(mesh.triangles.size()))];
  const Vec3 a = mesh.vertices[triangle.vertex[0]], b = mesh.vertices[triangle.vertex[1]];
  const Vec3 normal = mesh.parts[triangle.part].normal;
  const Real h = random.in(-height, height);
  switch (random.below(3)) {
    case 0:
      return a + h * normal;
    case 1:
      return a + random.in(0, 1) * (b - a) + h * normal;
    default:
      return a + h * random.direction();
  }
}

inline bool same_contacts(const std::vector<MeshContact>& a, const std::vector<MeshContact>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const MeshContact& p, const MeshContact& q) {
    return p.feature == q.feature && p.triangle == q.triangle && same_bits(p.distance, q.distance) &&
           same_bits(p.point, q.point) && same_bits(p.normal, q.normal);
  });
}

}  // namespace scree
