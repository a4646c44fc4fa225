// Contacts of a sphere with a mesh: the local minima of its distance. Near-equal minima on one smooth patch
// count once. Host and device, with the same bits: no result depends on the order in which triangles are
// visited.
#pragma once

#include <cmath>

#include "base/hd.hpp"
#include "base/root.hpp"
#include "base/vec3.hpp"
#include "mesh/mesh_view.hpp"
#include "mesh/triangle_edges.hpp"

namespace scree {

// The largest number of contacts of one sphere with one mesh; further ones than the nearest are dropped.
inline constexpr int kMeshSlots = 8;

// A contact, in the frame of the mesh.
struct MeshContact {
  Index feature;   // part of a face; part_count + row of MeshView::features of an edge or a vertex
  Index triangle;  // the lowest of its triangles; -1 where it was not determined
  Real distance;   // of the centre from the surface, negative inside [m]
  Vec3 point;      // a point of the part's plane; otherwise the nearest point [m]
  Vec3 normal;     // unit, from the surface to the centre; inside a closed mesh outwards
};

namespace mesh_detail {

inline constexpr Real kWeakRoundOff = 0x1p-36;   // at corners of slivers, where regions meet at small angles
inline constexpr Real kLeastSquare = 0x1p-1000;  // of a distance that still defines a direction [m^2]

// The patches next to a feature.
struct PatchList {
  const Index* first;
  Index count;
};

SCREE_HD PatchList patches_of(const MeshView& mesh, Index feature) {
  if (feature < mesh.part_count) return {&mesh.parts[feature].patch, 1};
  const MeshFeature& f = mesh.features[feature - mesh.part_count];
  return {mesh.patches + f.first_patch, f.patches};
}

SCREE_HD bool share_patch(const MeshView& mesh, Index a, Index b) {
  const PatchList of_a = patches_of(mesh, a), of_b = patches_of(mesh, b);
  for (Index i = 0; i < of_a.count; ++i)
    for (Index j = 0; j < of_b.count; ++j)
      if (of_a.first[i] == of_b.first[j]) return true;
  return false;
}

// 0 for a face, 1 for an edge, 2 for a vertex.
SCREE_HD int feature_type(const MeshView& mesh, Index feature) {
  return feature < mesh.part_count ? 0 : mesh.features[feature - mesh.part_count].b < 0 ? 2 : 1;
}

// Priority of contacts: by distance, then by type, then by feature.
SCREE_HD bool comes_before(const MeshView& mesh, const MeshContact& a, const MeshContact& b) {
  if (a.distance != b.distance) return a.distance < b.distance;
  const int of_a = feature_type(mesh, a.feature), of_b = feature_type(mesh, b.feature);
  return of_a != of_b ? of_a < of_b : a.feature < b.feature;
}

// Whether c lies in the edge's normal cone and within `search_range` of its nearest point; `from`: from
// that point to c.
SCREE_HD bool in_cone_of_edge(const MeshView& mesh, const MeshFeature& edge, Vec3 c, Real search_range,
                              Vec3& from) {
  const Vec3 a = mesh.vertices[edge.a], b = mesh.vertices[edge.b], d = c - a, e = b - a;
  const Real along = dot(d, e);
  if (!(along > 0 && dot(c - b, a - b) > 0)) return false;
  from = d - (along / dot(e, e)) * e;
  if (dot(from, from) > search_range * search_range) return false;
  for (Index i = edge.first_test; i < edge.first_test + edge.tests; ++i) {
    const Index test = mesh.tests[i];
    const Real left = left_of_edge(d, e, mesh.parts[test < 0 ? ~test : test].normal);
    if ((test < 0 ? -left : left) > 0) return false;
  }
  return true;
}

enum class Cone { outside, weak, inside };

// Position of d, measured from a vertex, relative to the vertex' normal cone; weak: outside, but possibly by
// round-off.
SCREE_HD Cone cone_of_vertex(const MeshView& mesh, const MeshFeature& vertex, Vec3 d) {
  const Vec3 v = mesh.vertices[vertex.a];
  Cone cone = Cone::inside;
  for (Index i = vertex.first_test; i < vertex.first_test + vertex.tests; ++i) {
    const Vec3 e = mesh.vertices[mesh.tests[i]] - v;
    const Real along = dot(d, e);
    if (along <= 0) continue;
    if (along > rough_length(d) * (kWeakRoundOff * rough_length(e) + 8 * mesh.flatness)) return Cone::outside;
    cone = Cone::weak;
  }
  return cone;
}

// Contact with the edge or vertex in this row, whose nearest point is c - from.
SCREE_HD MeshContact contact_from(const MeshView& mesh, Index row, Vec3 c, Vec3 from) {
  const Real square = dot(from, from);
  if (!(square > kLeastSquare)) {
    const Vec3 outward = in_double(mesh.features[row].outward);
    return {mesh.part_count + row, -1, 0, c, root_and_inverse(dot(outward, outward)).inverse * outward};
  }
  const RootAndInverse<Real> distance = root_and_inverse(square);
  return {mesh.part_count + row, -1, distance.root, c - from, distance.inverse * from};
}

}  // namespace mesh_detail

// Whether two contacts count as one: they share a patch, and their normals differ by no more than the
// feature angle.
SCREE_HD bool same_cluster(const MeshView& mesh, const MeshContact& a, const MeshContact& b) {
  return dot(a.normal, b.normal) >= mesh.cosine && mesh_detail::share_patch(mesh, a.feature, b.feature);
}

// Whether two features share a patch, or are next to patches that share an edge.
SCREE_HD bool on_neighbouring_patches(const MeshView& mesh, Index feature_a, Index feature_b) {
  if (mesh_detail::share_patch(mesh, feature_a, feature_b)) return true;
  const auto of_a = mesh_detail::patches_of(mesh, feature_a), of_b = mesh_detail::patches_of(mesh, feature_b);
  for (Index i = 0; i < of_a.count; ++i) {
    const Index end = mesh.first_neighbour[of_a.first[i] + 1];
    for (Index n = mesh.first_neighbour[of_a.first[i]]; n < end; ++n)
      for (Index j = 0; j < of_b.count; ++j)
        if (mesh.neighbours[n] == of_b.first[j]) return true;
  }
  return false;
}

// A feature as a contact of c, wherever c is: the plane of a part, the line of an edge, a vertex. Its normal
// does not oppose `side`; the distance is negative where c is on the other side.
SCREE_HD MeshContact mesh_feature_at(const MeshView& mesh, Index feature, Vec3 c, Vec3 side) {
  MeshContact contact;
  if (feature < mesh.part_count) {
    const MeshPart& part = mesh.parts[feature];
    contact = {feature, -1, dot(c - part.point, part.normal), part.point, part.normal};
  } else {
    const Index row = feature - mesh.part_count;
    const MeshFeature& f = mesh.features[row];
    const Vec3 a = mesh.vertices[f.a], d = c - a;
    const Vec3 e = f.b < 0 ? Vec3{} : mesh.vertices[f.b] - a;
    contact = mesh_detail::contact_from(mesh, row, c, f.b < 0 ? d : d - (dot(d, e) / dot(e, e)) * e);
  }
  if (dot(contact.normal, side) < 0) {
    contact.normal = opposite(contact.normal);
    contact.distance = -contact.distance;
  }
  return contact;
}

// How far beyond touch the triangles of a row are collected [m]. Features touched in the previous step must
// be among them, as their contacts continue, even where the skin is shorter than the displacement of a step:
// no step should move a particle farther than this fraction of its radius.
SCREE_HD Real mesh_skin(Real radius, Real skin) {
  constexpr Real kLeastShare = Real(1) / 16;
  return skin > kLeastShare * radius ? skin : kLeastShare * radius;
}

// Whether c, less than `search_range` away, is well over this triangle (-1: none) from outside. `face` is
// then the contact with its plane, and no other triangle of that plane adds information.
SCREE_HD bool stays_over(const MeshView& mesh, Index t, Vec3 c, Real search_range, MeshContact& face) {
  if (t < 0 || t >= mesh.triangle_count) return false;
  const MeshTriangle& triangle = mesh.triangles[t];
  const MeshPart& part = mesh.parts[triangle.part];
  const Real height = dot(c - part.point, part.normal);
  if (!(std::abs(height) < search_range) || (height < 0 && !mesh.sheet)) return false;
  if (!mesh_detail::is_well_over(mesh, triangle, part.normal, c)) return false;
  face = {triangle.part, t, std::abs(height), part.point, height >= 0 ? part.normal : opposite(part.normal)};
  return true;
}

// Narrow-phase query of triangles for the possible contacts of a sphere. The derived class Search receives
// candidates by add(), reports by known() which triangles add nothing new to their part, and by range_at()
// the largest distance at which a triangle counts.
template <class Search>
class TriangleQuery {
 protected:
  SCREE_HD TriangleQuery(const MeshView& mesh, Vec3 c, Real search_range)
      : mesh_(mesh), c_(c), search_range_(search_range), other_findings_{search_range, search_range} {}

  // Results of the query other than candidates.
  struct OtherFindings {
    Real nearest_round_off_vertex;  // distance of vertices whose cone contains c but for round-off [m]
    Real depth;  // of c behind the nearest face of a closed mesh over whose back it lies [m]
    Index behind = -1, behind_triangle = -1;  // that face, and the lowest of its triangles

    SCREE_HD void add(const OtherFindings& other) {
      if (other.nearest_round_off_vertex < nearest_round_off_vertex)
        nearest_round_off_vertex = other.nearest_round_off_vertex;
      if (other.behind >= 0) add_behind(other.behind_triangle, other.behind, other.depth);
    }
    SCREE_HD void add_behind(Index t, Index id, Real deep) {
      if (deep < depth || (deep == depth && id < behind))
        depth = deep, behind = id, behind_triangle = t;
      else if (id == behind && t < behind_triangle)
        behind_triangle = t;
    }
  };

  SCREE_HD void query_triangle(Index t) {
    const MeshTriangle& triangle = mesh_.triangles[t];
    if (triangle.features == 0 && (weak_pass_ || triangle.part == well_over_)) return;
    const MeshPart& part = mesh_.parts[triangle.part];
    const Real height = dot(c_ - part.point, part.normal);
    const Real search_range = search().range_at(part, height);
    if (!(std::abs(height) < search_range + mesh_.flatness)) return;
    if (triangle.features == 0) {
      if (std::abs(height) < search_range && !search().known(triangle.part, t) &&
          mesh_detail::is_over(mesh_, triangle, part.normal, c_))
        add_face(t, triangle.part, part, height);
      return;
    }
    const unsigned passed = mesh_detail::edges_passed(mesh_, triangle, part.normal, c_);
    if (passed != 0) return query_features(t, triangle, passed, search_range);
    // Over a triangle no normal cone of its edges and vertices contains c.
    if (!weak_pass_ && std::abs(height) < search_range) add_face(t, triangle.part, part, height);
  }

  // The centre is inside a closed mesh and nearer to a face than to any other feature: that face alone
  // pushes it out.
  SCREE_HD bool is_inside(Real nearest) const {
    return other_findings_.behind >= 0 && other_findings_.depth < nearest;
  }
  SCREE_HD MeshContact inside() const {
    const MeshPart& part = mesh_.parts[other_findings_.behind];
    return {other_findings_.behind, other_findings_.behind_triangle, -other_findings_.depth, part.point,
            part.normal};
  }

  const MeshView& mesh_;
  Vec3 c_;
  Real search_range_;
  OtherFindings other_findings_;
  Index well_over_ = -1;  // part of the triangle that c is known to be well over
  bool weak_pass_ = false;

 private:
  SCREE_HD Search& search() { return static_cast<Search&>(*this); }

  SCREE_HD void add_face(Index t, Index id, const MeshPart& part, Real height) {
    if (height >= 0) return search().add({id, t, height, part.point, part.normal});
    if (mesh_.sheet) return search().add({id, t, -height, part.point, opposite(part.normal)});
    other_findings_.add_behind(t, id, -height);
  }

  // passed: the edges of the triangle beyond which c lies; c is in no cone of the others.
  SCREE_HD void query_features(Index t, const MeshTriangle& triangle, unsigned passed, Real search_range) {
    Index row = triangle.first_feature;
    for (int k = 0; k < 3; ++k) {
      if (!(triangle.flags & (kOwnsEdge << k))) continue;
      if (!weak_pass_ && passed & (1u << k)) query_edge(t, row, search_range);
      ++row;
    }
    for (const Index end = triangle.first_feature + triangle.features; row < end; ++row)
      query_vertex(t, row, search_range);
  }

  SCREE_HD void query_edge(Index t, Index row, Real search_range) {
    Vec3 from;
    if (mesh_detail::in_cone_of_edge(mesh_, mesh_.features[row], c_, search_range + mesh_.round_off, from))
      add_feature(t, row, from, false);
  }

  SCREE_HD void query_vertex(Index t, Index row, Real search_range) {
    using mesh_detail::Cone;
    const MeshFeature& feature = mesh_.features[row];
    const Vec3 from = c_ - mesh_.vertices[feature.a];
    if (!(dot(from, from) < search_range * search_range)) return;
    const Cone cone = mesh_detail::cone_of_vertex(mesh_, feature, from);
    if (cone == Cone::outside || (cone == Cone::inside && weak_pass_)) return;
    add_feature(t, row, from, cone == Cone::weak && !weak_pass_);
  }

  // wait: postpones the feature until it is known whether any other one counts.
  SCREE_HD void add_feature(Index t, Index row, Vec3 from, bool wait) {
    if (!mesh_.sheet && dot(from, in_double(mesh_.features[row].outward)) < 0) return;
    MeshContact contact = mesh_detail::contact_from(mesh_, row, c_, from);
    contact.triangle = t;
    if (!(contact.distance < search_range_)) return;
    if (!wait) return search().add(contact);
    if (contact.distance < other_findings_.nearest_round_off_vertex)
      other_findings_.nearest_round_off_vertex = contact.distance;
  }
};

// Queries the triangles of a row once or, with more contacts than slots, several times.
class MeshContactSearch : TriangleQuery<MeshContactSearch> {
  friend TriangleQuery<MeshContactSearch>;

 public:
  SCREE_HD MeshContactSearch(const MeshView& mesh, Vec3 c, Real search_range, MeshContact* out)
      : TriangleQuery(mesh, c, search_range), out_(out) {}

  SCREE_HD int contacts_of(const TriangleRow& row) {
    if (MeshContact face; stays_over(mesh_, row.likely, c_, search_range_, face))
      well_over_ = face.feature, add(face);
    query_all(row);
    const Real weak = other_findings_.nearest_round_off_vertex;
    const Real nearest = found_ > 0 && out_[0].distance < weak ? out_[0].distance : weak;
    if (is_inside(nearest)) {
      out_[0] = inside();
      return 1;
    }
    const bool any_weak = weak < search_range_;
    keep();
    well_over_ = -1;  // its face may have been dropped
    for (; left_out_ && kept_ < kMeshSlots; keep()) query_all(row);
    if (any_weak && kept_ < kMeshSlots) add_weak(row);
    return kept_;
  }

 private:
  // Finds the nearest candidates for the free slots, in order.
  SCREE_HD void query_all(const TriangleRow& row) {
    left_out_ = false;
    for (Index i = 0; i < row.count; ++i)
      if (row.is_chosen(i)) query_triangle(row.triangles[i]);
  }

  SCREE_HD Real range_at(const MeshPart&, Real) const { return search_range_; }
  SCREE_HD bool known(Index part, Index t) const {
    for (int i = 0; i < found_; ++i)
      if (out_[i].feature == part && out_[i].triangle <= t) return true;
    return false;
  }

  SCREE_HD void add(const MeshContact& contact) {
    for (int i = 0; i < found_; ++i) {
      if (i < kept_ && same_cluster(mesh_, contact, out_[i])) return;
      if (out_[i].feature != contact.feature) continue;
      if (contact.triangle < out_[i].triangle) out_[i].triangle = contact.triangle;
      return;
    }
    if (found_ == kMeshSlots) {
      left_out_ = true;
      if (!mesh_detail::comes_before(mesh_, contact, out_[found_ - 1])) return;
      --found_;
    }
    int slot = found_++;
    for (; slot > kept_ && mesh_detail::comes_before(mesh_, contact, out_[slot - 1]); --slot)
      out_[slot] = out_[slot - 1];
    out_[slot] = contact;
  }

  // Keeps the candidates that are not in a cluster with a nearer one.
  SCREE_HD void keep() {
    for (int i = kept_; i < found_; ++i) {
      bool one = false;
      for (int j = 0; j < kept_ && !one; ++j) one = same_cluster(mesh_, out_[i], out_[j]);
      if (one) continue;
      if (kept_ != i) out_[kept_] = out_[i];
      ++kept_;
    }
    found_ = kept_;
  }

  // Adds vertices that are outside all regions by round-off, where nothing else counts.
  SCREE_HD void add_weak(const TriangleRow& row) {
    weak_pass_ = true;
    const int strict = kept_;
    do {
      query_all(row);
      keep();
    } while (left_out_ && kept_ < kMeshSlots);
    for (int i = strict; i < kept_; ++i) {
      const MeshContact contact = out_[i];
      int slot = i;
      for (; slot > 0 && mesh_detail::comes_before(mesh_, contact, out_[slot - 1]); --slot)
        out_[slot] = out_[slot - 1];
      out_[slot] = contact;
    }
  }

  MeshContact* out_;  // contacts, then candidates, each in order
  int kept_ = 0, found_ = 0;
  bool left_out_ = false;  // candidates were dropped for lack of slots
};

// Finds the contacts less than `search_range` from c [m], in order of distance, type (face, edge, vertex) and
// feature; the nearest kMeshSlots, if there are more. row: all triangles within `search_range` of c; further
// ones do not change the result. Returns the number of contacts; entries of `out` behind them are undefined.
// Inside a closed mesh the only contact is the nearest face, with a negative distance.
SCREE_HD int find_mesh_contacts(const MeshView& mesh, Vec3 c, Real search_range, const TriangleRow& row,
                                MeshContact out[kMeshSlots]) {
  return MeshContactSearch(mesh, c, search_range, out).contacts_of(row);
}

}  // namespace scree
