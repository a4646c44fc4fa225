// Search for the triangles near a point, in the mesh's tree of boxes. Host and device.
#pragma once

#include "base/hd.hpp"
#include "base/vec3.hpp"
#include "mesh/mesh_view.hpp"

namespace scree {

// Squared distance of a point from a box: 0 inside [m^2]. Without branches, which would be mispredicted.
SCREE_HD Real squared_distance(const MeshBox& box, Vec3 p) {
  const auto larger = [](Real a, Real b) { return a > b ? a : b; };
  const Vec3 below = box.min - p, above = p - box.max;
  const Vec3 d{larger(larger(below.x, above.x), 0), larger(larger(below.y, above.y), 0),
               larger(larger(below.z, above.z), 0)};
  return dot(d, d);
}

// Squared distance of a point from the segment from a to b [m^2].
SCREE_HD Real squared_distance(Vec3 a, Vec3 b, Vec3 p) {
  const Vec3 e = b - a, d = p - a;
  const Real along = dot(d, e), length = dot(e, e);
  const Vec3 from = along <= 0 ? d : along >= length ? p - b : d - (along / length) * e;
  return dot(from, from);
}

// Squared distance of a point from a triangle [m^2].
SCREE_HD Real squared_distance(Vec3 a, Vec3 b, Vec3 c, Vec3 p) {
  const Vec3 normal = cross(b - a, c - a);
  if (dot(p - a, cross(normal, b - a)) >= 0 && dot(p - b, cross(normal, c - b)) >= 0 &&
      dot(p - c, cross(normal, a - c)) >= 0) {
    const Real height = dot(p - a, normal);
    return height * height / dot(normal, normal);
  }
  const Real ab = squared_distance(a, b, p), bc = squared_distance(b, c, p), ca = squared_distance(c, a, p);
  const Real nearer = ab < bc ? ab : bc;
  return nearer < ca ? nearer : ca;
}

// Whether a triangle is nearer than the square root of `limit`. The test of its box excludes most.
SCREE_HD bool is_nearer(const MeshView& mesh, Index triangle, Vec3 p, Real limit) {
  const Index* const v = mesh.triangles[triangle].vertex;
  const Vec3 a = mesh.vertices[v[0]], b = mesh.vertices[v[1]], c = mesh.vertices[v[2]];
  const auto least = [](Real x, Real y, Real z) { return x < y ? (x < z ? x : z) : (y < z ? y : z); };
  const auto most = [](Real x, Real y, Real z) { return x > y ? (x > z ? x : z) : (y > z ? y : z); };
  const MeshBox box{{least(a.x, b.x, c.x), least(a.y, b.y, c.y), least(a.z, b.z, c.z)},
                    {most(a.x, b.x, c.x), most(a.y, b.y, c.y), most(a.z, b.z, c.z)}};
  return squared_distance(box, p) < limit && squared_distance(a, b, c, p) < limit;
}

// Calls visit(triangle) for every triangle less than `search_range` from c [m], but for round-off, in
// increasing order. The state of the traversal is a level and a number, so that it needs no stack.
SCREE_HD_CALLER
template <class Visit>
SCREE_HD void for_each_triangle_near(const MeshView& mesh, Vec3 c, Real search_range, const Visit& visit) {
  const Real limit = (search_range + mesh.round_off) * (search_range + mesh.round_off);
  const int top = mesh.levels - 1;
  int level = top;
  Index node = 0;
  while (level < top || node == 0) {
    if (squared_distance(mesh.boxes[mesh.level_start[level] + node], c) < limit) {
      if (level > 0) {
        --level, node *= kTreeWidth;
        continue;
      }
      for (Index t = kTreeWidth * node; t < kTreeWidth * (node + 1) && t < mesh.triangle_count; ++t)
        if (is_nearer(mesh, t, c, limit)) visit(t);
    }
    ++node;
    while (level < top &&
           (node % kTreeWidth == 0 || node == mesh.level_start[level + 1] - mesh.level_start[level]))
      node = (node + kTreeWidth - 1) / kTreeWidth, ++level;
  }
}

}  // namespace scree
