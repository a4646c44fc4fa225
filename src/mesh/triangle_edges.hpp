// Where a point lies to the edges of a triangle. Host and device.
#pragma once

#include <cmath>

#include "base/hd.hpp"
#include "base/vec3.hpp"
#include "mesh/mesh_view.hpp"

namespace scree {

// Twice the area between an edge e and a point d from its lower vertex, seen along the normal of a face:
// above 0 to the left of the edge, where the face is that runs along it [m^2]. Faces and edges ask this
// function alone, so that each place belongs to one of them.
SCREE_HD Real left_of_edge(Vec3 d, Vec3 e, Vec3 normal) { return dot(d, cross(normal, e)); }

// |x| + |y| + |z|: not less than the length, without a root.
SCREE_HD Real rough_length(Vec3 a) { return std::abs(a.x) + std::abs(a.y) + std::abs(a.z); }

namespace mesh_detail {

inline constexpr Real kSideRoundOff = 0x1p-49;  // of left_of_edge, relative to rough lengths

// How far c lies to the inside of edge k of a triangle, seen along the normal of its part, times the length
// of the edge; and what its round-off can be [m^2].
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

// Past which edges of a triangle c lies: bit k for edge k; 0: c is over the triangle. Across an edge to the
// same plane round-off counts for both sides: it is the same contact.
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

// Whether it lies past none, so that c is over the triangle; most that it is not over fail at the first edge.
SCREE_HD bool is_over(const MeshView& mesh, const MeshTriangle& triangle, Vec3 normal, Vec3 c) {
  for (int k = 0; k < 3; ++k) {
    const EdgeSide side = side_of_edge(mesh, triangle, k, normal, c);
    const bool inner = triangle.flags & (kInnerEdge << k);
    if (side.inside <= 0 && !(inner && side.inside >= -side.round_off)) return false;
  }
  return true;
}

// Whether c is over the triangle and, even with round-off, over no other of its plane.
SCREE_HD bool is_well_over(const MeshView& mesh, const MeshTriangle& triangle, Vec3 normal, Vec3 c) {
  for (int k = 0; k < 3; ++k) {
    const EdgeSide side = side_of_edge(mesh, triangle, k, normal, c);
    if (!(side.inside > side.round_off)) return false;
  }
  return true;
}

}  // namespace mesh_detail

}  // namespace scree
