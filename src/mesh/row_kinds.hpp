// Classification of the rows of triangles near a particle, their number of contact slots, and the search in
// rows that can hardly have more than one contact. Host and device.
#pragma once

#include "mesh/lane_group.hpp"
#include "mesh/mesh_contacts.hpp"
#include "mesh/open_surface_sides.hpp"

namespace scree {

// smooth: one patch whose faces differ in direction by no more than the feature angle, and with them all
// features that a sphere may touch there: contacts from one side are one contact.
enum class RowKind : std::uint8_t { any, smooth };

namespace mesh_detail {

inline constexpr Real kCosineRoundOff = 0x1p-20;  // of weak vertices' directions, with a large margin

SCREE_HD bool owns_open_feature(const MeshView& mesh, const MeshTriangle& triangle) {
  for (Index row = triangle.first_feature; row < triangle.first_feature + triangle.features; ++row)
    if (is_open(mesh, mesh.part_count + row)) return true;
  return false;
}

}  // namespace mesh_detail

SCREE_HD RowKind kind_of_row(const MeshView& mesh, const Index* triangles, Index count) {
  if (count == 0) return RowKind::any;
  const MeshPart& part = mesh.parts[mesh.triangles[triangles[0]].part];
  for (Index i = 0; i < count; ++i) {
    const MeshTriangle& triangle = mesh.triangles[triangles[i]];
    const MeshPart& other = mesh.parts[triangle.part];
    // Directions within half the feature angle of one normal differ from each other by no more than the
    // feature angle.
    const Real c = dot(other.normal, part.normal), of_twice = 2 * c * c - 1;
    if (other.patch != part.patch || !(c > 0) || !(of_twice > mesh.cosine + mesh_detail::kCosineRoundOff) ||
        mesh_detail::owns_open_feature(mesh, triangle))
      return RowKind::any;
  }
  return RowKind::smooth;
}

// Whether c stays on one side of all planes of a row while it moves by no more than `past` [m].
SCREE_HD bool is_one_sided(const MeshView& mesh, const Index* triangles, Index count, Vec3 c, Real past) {
  const Real margin = past + mesh.flatness + mesh.round_off;
  bool above = true, below = true;
  for (Index i = 0; i < count && (above || below); ++i) {
    const MeshPart& part = mesh.parts[mesh.triangles[triangles[i]].part];
    const Real height = dot(c - part.point, part.normal);
    above = above && height > margin, below = below && height < -margin;
  }
  return above || below;
}

// The largest number of simultaneous contacts with the triangles of a row, at most kMeshSlots. one_sided:
// is_one_sided() of a smooth row.
SCREE_HD int slots_needed(const MeshView& mesh, RowKind kind, bool one_sided, const Index* triangles,
                          Index count) {
  const int most = kind == RowKind::any ? kMeshSlots : mesh.sheet && !one_sided ? 2 : 1;
  int needed = 0, parts = 0;
  Index part[kMeshSlots];
  for (Index i = 0; i < count && needed < most; ++i) {
    const MeshTriangle& triangle = mesh.triangles[triangles[i]];
    int seen = 0;
    while (seen < parts && part[seen] != triangle.part) ++seen;
    if (seen == parts) part[parts++] = triangle.part, ++needed;
    needed += triangle.features;
  }
  return needed < most ? needed : most;
}

// Result of a search: no contact, one, or a case for find_mesh_contacts().
enum class Nearest { none, one, unclear };

// Search equivalent to find_mesh_contacts() where that has one contact at most, so that no slots are needed
// for others. On a smooth row contacts from one side are one contact, and the nearest suffices; on other rows
// a single feature counts. Unclear: contacts from both sides of a smooth row, several features of another
// one, or a result that depends on round-off.
class NearestContact : TriangleQuery<NearestContact> {
  friend TriangleQuery<NearestContact>;

 public:
  SCREE_HD NearestContact(const MeshView& mesh, Vec3 c, Real search_range, RowKind kind)
      : TriangleQuery(mesh, c, search_range), kind_(kind) {}

  // All lanes of the group get the same result.
  SCREE_HD_CALLER template <class LaneGroup>
  SCREE_HD Nearest find(const TriangleRow& row, const LaneGroup& team, MeshContact& out) {
    if (MeshContact face; stays_over(mesh_, row.likely, c_, search_range_, face))
      well_over_ = face.feature, best_ = face;
    for (Index i = team.first(); i < row.count; i += team.stride()) query_triangle(row.triangles[i]);
    take(team.reduce(Found{best_, other_findings_, several_}, [&](const Found& a, const Found& b) {
      take(a), join(b);
      return Found{best_, other_findings_, several_};
    }));
    // A vertex that counts but for round-off is one contact with the nearest feature, if it is on the same
    // side.
    const bool is_found = best_.feature >= 0;
    const Real weak = other_findings_.nearest_round_off_vertex;
    const bool weak_counts = kind_ == RowKind::any || mesh_.sheet || !is_found;
    if (several_ != 0 || (weak < search_range_ && weak_counts)) return Nearest::unclear;
    if (is_inside(is_found && best_.distance < weak ? best_.distance : weak))
      return out = inside(), Nearest::one;
    if (!is_found) return Nearest::none;
    return out = best_, Nearest::one;
  }

 private:
  struct Found {
    MeshContact best;
    OtherFindings beside;
    std::int64_t several;
  };
  SCREE_HD void take(const Found& found) {
    best_ = found.best, other_findings_ = found.beside, several_ = found.several;
  }
  SCREE_HD void join(const Found& found) {
    if (found.best.feature >= 0) add(found.best);
    other_findings_.add(found.beside), several_ |= found.several;
  }
  SCREE_HD bool known(Index part, Index t) const { return best_.feature == part && best_.triangle <= t; }
  // Features on the side of the contact belong to the same contact, and count only if they are nearer.
  SCREE_HD Real range_at(const MeshPart& part, Real height) const {
    if (kind_ == RowKind::any || best_.feature < 0 ||
        (mesh_.sheet && (height < 0) != (dot(best_.normal, part.normal) < 0)))
      return search_range_;
    const Real nearer = best_.distance + mesh_.round_off;
    return nearer < search_range_ ? nearer : search_range_;
  }
  SCREE_HD void add(const MeshContact& contact) {
    if (best_.feature < 0) {
      best_ = contact;
    } else if (kind_ == RowKind::any ? contact.feature != best_.feature
                                     : !(dot(contact.normal, best_.normal) > 0)) {
      several_ = 1;
    } else if (contact.feature == best_.feature) {
      if (contact.triangle < best_.triangle) best_.triangle = contact.triangle;
    } else if (mesh_detail::comes_before(mesh_, contact, best_)) {
      best_ = contact;
    }
  }

  RowKind kind_;
  MeshContact best_{-1, -1, 0, {}, {}};
  std::int64_t several_ = 0;  // 0 or 1: contacts that may not be one
};

// Whether a search finds anything at a triangle: a candidate, a vertex that counts but for round-off, or a
// face behind the centre.
class TriangleProbe : TriangleQuery<TriangleProbe> {
  friend TriangleQuery<TriangleProbe>;

 public:
  SCREE_HD TriangleProbe(const MeshView& mesh, Vec3 c, Real search_range)
      : TriangleQuery(mesh, c, search_range) {}

  SCREE_HD bool finds_at(Index t) {
    is_candidate_ = false, other_findings_ = {search_range_, search_range_};
    query_triangle(t);
    return is_candidate_ || other_findings_.behind >= 0 ||
           other_findings_.nearest_round_off_vertex < search_range_;
  }

 private:
  SCREE_HD static bool known(Index, Index) { return false; }
  SCREE_HD Real range_at(const MeshPart&, Real) const { return search_range_; }
  SCREE_HD void add(const MeshContact&) { is_candidate_ = true; }

  bool is_candidate_ = false;
};

// The row for find_mesh_contacts() without triangles at which it finds nothing. What a search finds at a
// triangle depends on what it found before only in being left out, so that the result is the same.
SCREE_HD_CALLER template <class LaneGroup>
SCREE_HD TriangleRow with_contacts_only(const MeshView& mesh, Vec3 c, Real search_range, TriangleRow row,
                                        const LaneGroup& team) {
  TriangleProbe probe(mesh, c, search_range);
  std::uint64_t chosen = 0;
  for (Index i = team.first(); i < row.count && i < TriangleRow::kBits; i += team.stride())
    chosen |= std::uint64_t{probe.finds_at(row.triangles[i])} << i;
  row.chosen = team.reduce(chosen, [](std::uint64_t a, std::uint64_t b) { return a | b; });
  return row;
}

}  // namespace scree
