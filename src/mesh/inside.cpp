#include "mesh/inside.hpp"

#include <algorithm>

#include "mesh/mesh_tree.hpp"

namespace scree {
namespace {

struct Cut {
  Real x, y;
};

// Intersection of the plane at z with an edge whose ends lie on its two sides.
Cut cut_of(const MeshView& mesh, Index a, Index b, Real z) {
  if (b < a) std::swap(a, b);
  const Vec3 p = mesh.vertices[a], q = mesh.vertices[b];
  const Real t = (z - p.z) / (q.z - p.z);
  return {p.x + t * (q.x - p.x), std::clamp(p.y + t * (q.y - p.y), std::min(p.y, q.y), std::max(p.y, q.y))};
}

bool crosses(const MeshView& mesh, const MeshTriangle& triangle, Vec3 p) {
  Cut cuts[2];
  int found = 0;
  for (int k = 0; k < 3; ++k) {
    const Index a = triangle.vertex[k], b = triangle.vertex[k < 2 ? k + 1 : 0];
    if ((mesh.vertices[a].z > p.z) != (mesh.vertices[b].z > p.z)) cuts[found++] = cut_of(mesh, a, b, p.z);
  }
  if (found == 0 || (cuts[0].y > p.y) == (cuts[1].y > p.y)) return false;
  const Real t = (p.y - cuts[0].y) / (cuts[1].y - cuts[0].y);
  return cuts[0].x + t * (cuts[1].x - cuts[0].x) > p.x;
}

// Number of crossings of the ray with the triangles below a node of the tree.
int crossings(const MeshView& mesh, int level, Index node, Vec3 p) {
  const MeshBox& box = mesh.boxes[mesh.level_start[level] + node];
  if (p.x > box.max.x || p.y < box.min.y || p.y > box.max.y || p.z < box.min.z || p.z > box.max.z) return 0;
  int count = 0;
  const Index below =
      level == 0 ? mesh.triangle_count : mesh.level_start[level] - mesh.level_start[level - 1];
  for (Index child = kTreeWidth * node; child < std::min(kTreeWidth * (node + 1), below); ++child)
    count += level == 0 ? crosses(mesh, mesh.triangles[child], p) : crossings(mesh, level - 1, child, p);
  return count;
}

}  // namespace

bool is_inside(const MeshView& mesh, Vec3 p) {
  return !mesh.sheet && crossings(mesh, mesh.levels - 1, 0, p) % 2 == 1;
}

bool contains_sphere(const MeshView& mesh, Vec3 p, Real radius) {
  bool touches = false;
  for_each_triangle_near(mesh, p, radius, [&](Index t) {
    const Index* v = mesh.triangles[t].vertex;
    touches = touches || squared_distance(mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]], p) <
                             radius * radius;
  });
  return !touches && is_inside(mesh, p);
}

}  // namespace scree
