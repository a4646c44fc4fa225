// The safe displacement of a cached contact: how far a sphere may move on a mesh before a narrow-phase query
// can find anything but the face that it is over. Host and device.
#pragma once

#include "mesh/mesh_contacts.hpp"
#include "mesh/mesh_tree.hpp"
#include "mesh/row_kinds.hpp"

namespace scree {

// A cached contact. While the centre is within `safe_distance` of `from`, it is over this triangle, or in the
// region of an edge or a vertex, and a query would find the contact with it only; triangle -1: a query would
// find none.
struct CachedContact {
  Vec3 from;                // in the frame of the mesh [m]
  Real safe_distance;       // [m]
  Index triangle, feature;  // as in MeshContact

  SCREE_HD bool holds(Vec3 c) const {
    const Vec3 moved = c - from;
    return dot(moved, moved) < safe_distance * safe_distance;
  }
};
inline constexpr CachedContact kNoCachedContact{{}, 0, -1, -1};

namespace mesh_detail {

SCREE_HD Real distance_to(const MeshView& mesh, const MeshTriangle& triangle, Vec3 c) {
  const Vec3* const v = mesh.vertices;
  return std::sqrt(squared_distance(v[triangle.vertex[0]], v[triangle.vertex[1]], v[triangle.vertex[2]], c));
}

// Bound of the distance errors due to round-off and to vertices off their plane, with a margin.
SCREE_HD Real uncertainty(const MeshView& mesh) { return 2 * mesh.flatness + 4 * mesh.round_off; }

}  // namespace mesh_detail

// The row of a sphere whose contacts are searched within `search_range` of its centre c. All lanes of the
// group get the same result.
template <class LaneGroup>
struct CachedContactRow {
  const MeshView& mesh;
  RowKind kind;
  const Index* triangles;
  Index count;
  Vec3 c;
  Real search_range;
  LaneGroup team{};

  // Safe displacement over triangle t, from outside. Other triangles must stay beyond `search_range`; or, on
  // a smooth row, farther away than the plane of t; or, on another row, c outside the regions of their
  // features.
  SCREE_HD CachedContact over(Index t) const {
    const MeshTriangle& triangle = mesh.triangles[t];
    const MeshPart& part = mesh.parts[triangle.part];
    const Real height = dot(c - part.point, part.normal), distance = std::abs(height);
    if (height < 0 && !mesh.sheet) return kNoCachedContact;
    const Vec3 up = height < 0 ? opposite(part.normal) : part.normal;
    const Below below{part.point,
                      up,
                      distance,
                      {edge_of(triangle, part.normal, 0), edge_of(triangle, part.normal, 1),
                       edge_of(triangle, part.normal, 2)}};
    Real safe_distance = distance;
    for (const Edge& edge : below.edges) shrink(safe_distance, edge.inside);
    for (Index i = team.first(); i < count && safe_distance > 0; i += team.stride()) {
      const MeshTriangle& other = mesh.triangles[triangles[i]];
      // In the same plane it is the same contact.
      if (triangles[i] == t || (other.part == triangle.part && other.features == 0)) continue;
      shrink(safe_distance, permitted_by(other, below, safe_distance));
    }
    return cached(team.reduce(safe_distance, [](Real a, Real b) { return b < a ? b : a; }), t);
  }

  // Safe displacement in the region of an edge or a vertex, on a row that is not smooth.
  SCREE_HD CachedContact in_region_of(const MeshContact& contact) const {
    if (kind == RowKind::smooth) return kNoCachedContact;
    const Index own = contact.feature - mesh.part_count;
    const MeshFeature& feature = mesh.features[own];
    Real safe_distance = feature.b < 0 ? inside_vertex(feature) : inside_edge(feature);
    if (!mesh.sheet) shrink(safe_distance, dot(c - contact.point, in_double(feature.outward)) / kLongest);
    for (Index i = team.first(); i < count && safe_distance > 0; i += team.stride()) {
      const MeshTriangle& other = mesh.triangles[triangles[i]];
      const Real beyond_range = mesh_detail::distance_to(mesh, other, c) - search_range;
      if (beyond_range < safe_distance)
        shrink(safe_distance, outside_regions(other, contact.distance, own, beyond_range));
    }
    CachedContact result =
        cached(team.reduce(safe_distance, [](Real a, Real b) { return b < a ? b : a; }), contact.triangle);
    result.feature = contact.feature;
    return result;
  }

  // Safe displacement beyond the reach of all triangles, or over the nearest one, where that is larger.
  SCREE_HD CachedContact clear() const {
    NearestTriangle nearest{kInfinity, -1};
    for (Index i = team.first(); i < count; i += team.stride()) {
      const Real distance = mesh_detail::distance_to(mesh, mesh.triangles[triangles[i]], c);
      nearest = NearestTriangle::of(nearest, {distance, triangles[i]});
    }
    nearest = team.reduce(nearest, NearestTriangle::of);
    const CachedContact off = cached(nearest.distance - search_range, -1);
    if (nearest.triangle < 0 || off.safe_distance > kLongLasting * search_range) return off;
    const CachedContact on = over(static_cast<Index>(nearest.triangle));
    return on.safe_distance > off.safe_distance ? on : off;
  }

 private:
  static constexpr Real kLongLasting = 0.1;            // fraction of the reach
  static constexpr Real kLongest = 1 + Real(0x1p-20);  // bound of the length of unit vectors in float
  struct NearestTriangle {
    Real distance;
    std::int64_t triangle;

    SCREE_HD static NearestTriangle of(const NearestTriangle& a, const NearestTriangle& b) {
      return b.distance < a.distance || (b.distance == a.distance && b.triangle < a.triangle) ? b : a;
    }
  };
  SCREE_HD static void shrink(Real& safe_distance, Real to) {
    if (!(safe_distance < to)) safe_distance = to;
  }
  SCREE_HD static void grow(Real& safe_distance, Real to) {
    if (safe_distance < to) safe_distance = to;
  }
  SCREE_HD CachedContact cached(Real safe_distance, Index t) const {
    const Real sure = safe_distance - mesh_detail::uncertainty(mesh);
    return {c, sure > 0 ? sure : 0, t, t < 0 ? -1 : mesh.triangles[t].part};
  }
  // An edge of the triangle that c is over: a vertex, the direction in the plane from the edge to the
  // inside, and the distance of c from the edge inwards [m].
  struct Edge {
    Vec3 from, inward;
    Real inside;
  };
  // The triangle that c is over, relative to c.
  struct Below {
    Vec3 point, up;  // point of its plane; unit normal towards c
    Real distance;   // of c from the plane [m]
    Edge edges[3];
  };
  SCREE_HD Edge edge_of(const MeshTriangle& triangle, Vec3 normal, int k) const {
    const Vec3 from = mesh.vertices[triangle.vertex[k]],
               e = mesh.vertices[triangle.vertex[k < 2 ? k + 1 : 0]] - from;
    const Vec3 inward = (1 / std::sqrt(dot(e, e))) * cross(normal, e);
    return {from, inward, dot(c - from, inward)};
  }
  // The displacement that another triangle permits; or at least `enough`, if it permits that.
  SCREE_HD Real permitted_by(const MeshTriangle& other, const Below& below, Real enough) const {
    Real farther = 0, same_side = kInfinity;
    if (kind == RowKind::smooth) {
      if (mesh.sheet) {
        const MeshPart& part = mesh.parts[other.part];
        const Real height = dot(c - part.point, part.normal);
        same_side = dot(part.normal, below.up) < 0 ? -height : height;
      }
      farther = permitted_beyond_edge(other, below);
      if (!(farther < enough) && !(same_side < enough)) return farther;
    }
    const Real away = mesh_detail::distance_to(mesh, other, c), beyond_range = away - search_range;
    if (kind == RowKind::any)
      return beyond_range < enough ? outside_regions(other, below.distance, -1, beyond_range) : beyond_range;
    const Real by_distance = Real(0.5) * (away - below.distance);
    if (farther < by_distance) farther = by_distance;
    shrink(farther, same_side);
    return farther > beyond_range ? farther : beyond_range;
  }
  // Displacement of c for which it stays outside the regions in which a search finds the face and the edges
  // and vertices of another triangle, or beyond their reach; at least `least`. distance: of c from the
  // contact; own: the row of its feature, which is left out; -1: a face.
  SCREE_HD Real outside_regions(const MeshTriangle& other, Real distance, Index own, Real least) const {
    Real safe_distance = beside_face(other, distance);
    for (Index row = other.first_feature; row < other.first_feature + other.features; ++row) {
      if (row == own) continue;
      const MeshFeature& feature = mesh.features[row];
      shrink(safe_distance, feature.b < 0 ? outside_vertex(feature) : outside_edge(feature));
    }
    return safe_distance > least ? safe_distance : least;
  }
  // Beyond one of its edges; or under it, inside a closed mesh, and farther from it than from the contact.
  SCREE_HD Real beside_face(const MeshTriangle& other, Real distance) const {
    const MeshPart& part = mesh.parts[other.part];
    const Real height = dot(c - part.point, part.normal);
    Real most = !mesh.sheet && height < 0 ? Real(0.5) * (-height - distance) : 0;
    for (int k = 0; k < 3; ++k) grow(most, -edge_of(other, part.normal, k).inside);
    return most;
  }
  // Between the ends of an edge and over none of its faces; along none of the edges of a vertex.
  SCREE_HD Real inside_edge(const MeshFeature& edge) const {
    const Vec3 a = mesh.vertices[edge.a], d = c - a, e = mesh.vertices[edge.b] - a;
    const Real along = dot(d, e), square = dot(e, e);
    Real least = along < square - along ? along : square - along;
    for (Index i = edge.first_test; i < edge.first_test + edge.tests; ++i) {
      const Index test = mesh.tests[i];
      const Real left = left_of_edge(d, e, mesh.parts[test < 0 ? ~test : test].normal);
      shrink(least, test < 0 ? left : -left);
    }
    return least / std::sqrt(square);
  }
  SCREE_HD Real inside_vertex(const MeshFeature& vertex) const {
    const Vec3 v = mesh.vertices[vertex.a], d = c - v;
    Real least = std::sqrt(dot(d, d));
    for (Index i = vertex.first_test; i < vertex.first_test + vertex.tests; ++i) {
      const Vec3 e = mesh.vertices[mesh.tests[i]] - v;
      shrink(least, -dot(d, e) / std::sqrt(dot(e, e)));
    }
    return least;
  }
  // Past one of its ends, or over one of its faces.
  SCREE_HD Real outside_edge(const MeshFeature& edge) const {
    const Vec3 a = mesh.vertices[edge.a], b = mesh.vertices[edge.b], d = c - a, e = b - a;
    const Real along = dot(d, e), square = dot(e, e);
    Real most = along - square > -along ? along - square : -along;
    for (Index i = edge.first_test; i < edge.first_test + edge.tests; ++i) {
      const Index test = mesh.tests[i];
      const Real left = left_of_edge(d, e, mesh.parts[test < 0 ? ~test : test].normal);
      grow(most, test < 0 ? -left : left);
    }
    most /= std::sqrt(square);
    grow(most, std::sqrt(squared_distance(a, b, c)) - search_range);
    return most;
  }
  // Along one of its edges, by more than the tolerance of cone_of_vertex().
  SCREE_HD Real outside_vertex(const MeshFeature& vertex) const {
    const Vec3 v = mesh.vertices[vertex.a], d = c - v;
    Real most = std::sqrt(dot(d, d)) - search_range;
    for (Index i = vertex.first_test; i < vertex.first_test + vertex.tests; ++i) {
      const Vec3 e = mesh.vertices[mesh.tests[i]] - v;
      const Real tolerance = mesh_detail::kWeakRoundOff * rough_length(e) + 8 * mesh.flatness;
      grow(most, (dot(d, e) - rough_length(d) * tolerance) / (std::sqrt(dot(e, e)) + 2 * tolerance));
    }
    return most;
  }
  // Displacement of c for which a triangle beyond an edge stays farther away than the plane below; 0: it is
  // beyond no edge. Derived in src/mesh/README.md, "Cached narrow-phase queries".
  SCREE_HD Real permitted_beyond_edge(const MeshTriangle& other, const Below& below) const {
    const Real u = mesh_detail::uncertainty(mesh);
    const Vec3 corners[] = {mesh.vertices[other.vertex[0]], mesh.vertices[other.vertex[1]],
                            mesh.vertices[other.vertex[2]]};
    Real most = 0;
    for (const Edge& edge : below.edges) {
      Real slope = 0;
      bool is_penetrated = true;
      for (const Vec3& v : corners) {
        const Real out = -dot(v - edge.from, edge.inward), up = dot(v - below.point, below.up);
        is_penetrated = is_penetrated && out > -u && (up < u || up < out);
        if (is_penetrated && up > slope * out && !(up < u)) slope = up / out;
      }
      if (!is_penetrated) continue;
      const Real safe_distance = (edge.inside - u - slope * below.distance) / (1 + slope);
      if (most < safe_distance) most = safe_distance;
    }
    most -= 2 * std::sqrt(2 * u * below.distance);
    return most > 0 ? most : 0;
  }
};

}  // namespace scree
