// Position of a point relative to the edges of a triangle. Host and device.
#pragma once

#include <cmath>

#include "base/hd.hpp"
#include "base/vec3.hpp"
#include "mesh/mesh_view.hpp"

namespace scree {

// Twice the area between an edge e and a point d from its lower vertex, along the normal of a face: positive
// to the left of the edge, where the face lies that runs along it [m^2]. Faces and edges use this one
// function, so that each position belongs to exactly one of them.
SCREE_HD Real left_of_edge(Vec3 d, Vec3 e, Vec3 normal) { return dot(d, cross(normal, e)); }

// |x| + |y| + |z|: an upper bound of the length, without a root.
SCREE_HD Real rough_length(Vec3 a) { return std::abs(a.x) + std::abs(a.y) + std::abs(a.z); }

namespace mesh_detail {

inline constexpr Real kSideRoundOff = 0x1p-49;  // of left_of_edge, relative to rough lengths

// Distance of c to the inside of edge k of a triangle, along the normal of its part, times the length of the
// edge; and a bound of its round-off [m^2].
struct EdgeSide {
  Real inside, round_off;
};

SCREE_HD EdgeSide side_of_edge(const MeshView& mesh, const MeshTriangle& triangle, int k, Vec3 normal,
                               Vec3 c) {
  const Index from = triangle.vertex[k], to = triangle.vertex[k < 2 ? k + 1 : 0];
  const bool reversed = triangle.flags & (kReversed << k);
  const Vec3 low = mesh.vertices[reversed ? to : from], d = c - low,
             e = mesh.vertices[reversed ? from : to] - low;
  const Real left = left_of_edge(d, e, normal);
  return {reversed ? -left : left, kSideRoundOff * rough_length(d) * rough_length(e)};
}

// The edges of a triangle beyond which c lies: bit k for edge k; 0: c is over the triangle. At an edge
// between coplanar triangles round-off counts in favour of both: it is the same contact.
SCREE_HD unsigned edges_passed(const MeshView& mesh, const MeshTriangle& triangle, Vec3 normal, Vec3 c) {
  unsigned passed = 0;
  for (int k = 0; k < 3; ++k)
    passed |= static_cast<unsigned>(side_of_edge(mesh, triangle, k, normal, c).inside <= 0) << k;
  const unsigned inner = passed & triangle.flags;
  for (int k = 0; k < 3 && inner != 0; ++k) {
    if (!(inner & (kInnerEdge << k))) continue;
    const EdgeSide side = side_of_edge(mesh, triangle, k, normal, c);
    if (side.inside >= -side.round_off) passed &= ~(1u << k);
  }
  return passed;
}

// Whether c lies beyond no edge, so that it is over the triangle; most other triangles fail at the first
// edge.
SCREE_HD bool is_over(const MeshView& mesh, const MeshTriangle& triangle, Vec3 normal, Vec3 c) {
  for (int k = 0; k < 3; ++k) {
    const EdgeSide side = side_of_edge(mesh, triangle, k, normal, c);
    const bool inner = triangle.flags & (kInnerEdge << k);
    if (side.inside <= 0 && !(inner && side.inside >= -side.round_off)) return false;
  }
  return true;
}

// Whether c is over the triangle and, even with round-off, over no other triangle of its plane.
SCREE_HD bool is_well_over(const MeshView& mesh, const MeshTriangle& triangle, Vec3 normal, Vec3 c) {
  for (int k = 0; k < 3; ++k) {
    const EdgeSide side = side_of_edge(mesh, triangle, k, normal, c);
    if (!(side.inside > side.round_off)) return false;
  }
  return true;
}

}  // namespace mesh_detail

}  // namespace scree
