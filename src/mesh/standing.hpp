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
    const Below below{triangle, part.point, height < 0 ? opposite(part.normal) : part.normal, distance};
    Real room = distance;
    for (int k = 0; k < 3; ++k) shrink(room, edge_of(below, k).inside);
    for (Index i = team.first(); i < count && room > 0; i += team.stride()) {
      const MeshTriangle& other = mesh.triangles[triangles[i]];
      // Of the same plane it is the same contact.
      if (triangles[i] == t || (other.part == triangle.part && other.features == 0)) continue;
      shrink(room, beside(other, below, room));
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
  // The triangle that c is over, as seen from there.
  struct Below {
    const MeshTriangle& triangle;
    Vec3 point, normal;  // of its plane, towards c
    Real distance;       // of c from it [m]
  };
  // One of its edges: a vertex, the direction in the plane from the edge to the inside, and how far inside c
  // is [m].
  struct Edge {
    Vec3 from, inward;
    Real inside;
  };
  SCREE_HD Edge edge_of(const Below& below, int k) const {
    const Index* const vertex = below.triangle.vertex;
    const Vec3 from = mesh.vertices[vertex[k]], e = mesh.vertices[vertex[k < 2 ? k + 1 : 0]] - from;
    const Vec3 across = cross(mesh.parts[below.triangle.part].normal, e);
    const Vec3 inward = (1 / std::sqrt(dot(e, e))) * across;
    return {from, inward, dot(c - from, inward)};
  }
  // What another triangle leaves, or more than `enough` if it leaves that.
  SCREE_HD Real beside(const MeshTriangle& other, const Below& below, Real enough) const {
    Real farther = 0, same_side = kInfinity;
    if (kind == RowKind::smooth) {
      if (mesh.sheet) {
        const MeshPart& part = mesh.parts[other.part];
        const Real height = dot(c - part.point, part.normal);
        same_side = dot(part.normal, below.normal) < 0 ? -height : height;
      }
      farther = past_an_edge(other, below);
      if (!(farther < enough) && !(same_side < enough)) return farther;
    }
    const Real away = mesh_detail::distance_to(mesh, other, c), beyond_reach = away - reach;
    if (kind == RowKind::any) return beyond_reach;
    const Real nearer_by = Real(0.5) * (away - below.distance);
    if (farther < nearer_by) farther = nearer_by;
    shrink(farther, same_side);
    return farther > beyond_reach ? farther : beyond_reach;
  }
  // How far c may move until a triangle that lies past an edge could be as near as the plane below; 0: it
  // lies past none. With s [m] inside the edge and h over the plane, all that rises past the edge by no more
  // than `slope` is farther than h while slope h < s. (src/mesh/README.md, "Looks that can be spared")
  SCREE_HD Real past_an_edge(const MeshTriangle& other, const Below& below) const {
    const Real u = mesh_detail::uncertainty(mesh);
    Real most = 0;
    for (int k = 0; k < 3; ++k) {
      const Edge edge = edge_of(below, k);
      Real slope = 0;
      bool past = true;
      for (int corner = 0; corner < 3; ++corner) {
        const Vec3 v = mesh.vertices[other.vertex[corner]];
        const Real out = -dot(v - edge.from, edge.inward), up = dot(v - below.point, below.normal);
        if (up < u)
          past = past && out > -u;
        else if (out > kClear * u)
          slope = slope < up / out ? up / out : slope;
        else
          past = false;
      }
      slope *= 1 + 2 / kClear;  // what u makes of it
      if (!past || slope > 1) continue;
      const Real room = (edge.inside - u - slope * below.distance) / (1 + slope);
      if (most < room) most = room;
    }
    return most - 2 * std::sqrt(2 * u * below.distance);
  }
  static constexpr Real kClear = 1024;  // times the uncertainty
};

}  // namespace scree
