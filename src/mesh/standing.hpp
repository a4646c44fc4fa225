// How far a sphere may move on a mesh before anything but the face that it is over needs a look. Host and
// device.
#pragma once

#include "mesh/mesh_contacts.hpp"
#include "mesh/mesh_tree.hpp"
#include "mesh/row_kinds.hpp"

namespace scree {

// As long as the centre is nearer than `room` to `from`, it is over this triangle, and a contact there is all
// that a search would find; -1: it would find none.
struct Standing {
  Vec3 from;             // in the frame of the mesh [m]
  Real room;             // [m]
  Index triangle, part;  // the latter that of the triangle

  SCREE_HD bool holds(Vec3 c) const {
    const Vec3 moved = c - from;
    return dot(moved, moved) < room * room;
  }
};
inline constexpr Standing kNoStanding{{}, 0, -1, -1};

namespace mesh_detail {

SCREE_HD Real distance_to(const MeshView& mesh, const MeshTriangle& triangle, Vec3 c) {
  const Vec3* const v = mesh.vertices;
  return std::sqrt(squared_distance(v[triangle.vertex[0]], v[triangle.vertex[1]], v[triangle.vertex[2]], c));
}

// What round-off and vertices beside their plane make of a distance, with some to spare.
SCREE_HD Real uncertainty(const MeshView& mesh) { return 2 * mesh.flatness + 4 * mesh.round_off; }

}  // namespace mesh_detail

// The row of a sphere whose contacts are looked for within `reach` of its centre c. All of the team get the
// same.
template <class Team>
struct StandingRow {
  const MeshView& mesh;
  RowKind kind;
  const Index* triangles;
  Index count;
  Vec3 c;
  Real reach;
  Team team{};

  // Over triangle t, from outside. Others must stay beyond reach or, on a smooth row, farther than its plane.
  SCREE_HD Standing over(Index t) const {
    const MeshTriangle& triangle = mesh.triangles[t];
    const MeshPart& part = mesh.parts[triangle.part];
    const Real height = dot(c - part.point, part.normal), distance = std::abs(height);
    if (height < 0 && !mesh.sheet) return kNoStanding;
    Real room = distance;
    for (int k = 0; k < 3; ++k) {
      const Vec3 e = mesh.vertices[triangle.vertex[(k + 1) % 3]] - mesh.vertices[triangle.vertex[k]];
      shrink(room,
             mesh_detail::side_of_edge(mesh, triangle, k, part.normal, c).inside / std::sqrt(dot(e, e)));
    }
    for (Index i = team.first(); i < count && room > 0; i += team.stride()) {
      const MeshTriangle& other = mesh.triangles[triangles[i]];
      // Of the same plane it is the same contact.
      if (triangles[i] == t || (other.part == triangle.part && other.features == 0)) continue;
      shrink(room, beside(other, height < 0, distance));
    }
    return standing(team.agree(room, [](Real a, Real b) { return b < a ? b : a; }), t);
  }

  // Beyond reach of all; or over the nearest of them, where that lasts longer.
  SCREE_HD Standing clear() const {
    NearestTriangle nearest{kInfinity, -1};
    for (Index i = team.first(); i < count; i += team.stride()) {
      const Real distance = mesh_detail::distance_to(mesh, mesh.triangles[triangles[i]], c);
      nearest = NearestTriangle::of(nearest, {distance, triangles[i]});
    }
    nearest = team.agree(nearest, NearestTriangle::of);
    const Standing off = standing(nearest.distance - reach, -1);
    if (nearest.triangle < 0 || off.room > kLongLasting * reach) return off;
    const Standing on = over(static_cast<Index>(nearest.triangle));
    return on.room > off.room ? on : off;
  }

 private:
  static constexpr Real kLongLasting = 0.1;  // part of the reach
  struct NearestTriangle {
    Real distance;
    std::int64_t triangle;

    SCREE_HD static NearestTriangle of(const NearestTriangle& a, const NearestTriangle& b) {
      return b.distance < a.distance || (b.distance == a.distance && b.triangle < a.triangle) ? b : a;
    }
  };
  SCREE_HD static void shrink(Real& room, Real to) {
    if (!(room < to)) room = to;
  }
  SCREE_HD Standing standing(Real room, Index t) const {
    const Real sure = room - mesh_detail::uncertainty(mesh);
    return {c, sure > 0 ? sure : 0, t, t < 0 ? -1 : mesh.triangles[t].part};
  }
  // What another triangle leaves. from_below: c is under the sheet.
  SCREE_HD Real beside(const MeshTriangle& other, bool from_below, Real distance) const {
    const Real away = mesh_detail::distance_to(mesh, other, c), beyond_reach = away - reach;
    if (kind == RowKind::any) return beyond_reach;
    Real farther = Real(0.5) * (away - distance);
    if (mesh.sheet) {  // and on the same side
      const MeshPart& part = mesh.parts[other.part];
      const Real height = dot(c - part.point, part.normal);
      shrink(farther, from_below ? -height : height);
    }
    return farther > beyond_reach ? farther : beyond_reach;
  }
};

}  // namespace scree
