// The side of an open (two-sided) surface on which a contact began. The contact keeps it until it ends, also
// where the sphere has penetrated the surface. Host and device, with the same bits.
#pragma once

#include <initializer_list>
#include <limits>

#include "mesh/mesh_contacts.hpp"

namespace scree {

// The history of a contact with an open surface stores one number: the feature, and whether the contact is
// on the side of the outward normal of the face, or of the mean normal of an edge or a vertex.
inline constexpr Index kNoFeature = std::numeric_limits<Index>::min();
SCREE_HD Index with_side(Index feature, bool outward) { return outward ? feature : ~feature; }
SCREE_HD Index without_side(Index sided) { return sided < 0 ? ~sided : sided; }

SCREE_HD Vec3 outward_of(const MeshView& mesh, Index feature) {
  return feature < mesh.part_count ? mesh.parts[feature].normal
                                   : in_double(mesh.features[feature - mesh.part_count].outward);
}

// The number of a contact with an open surface; with a closed mesh it is the feature alone.
SCREE_HD Index side_feature(const MeshView& mesh, const MeshContact& contact) {
  if (!mesh.sheet) return contact.feature;
  return with_side(contact.feature, dot(contact.normal, outward_of(mesh, contact.feature)) >= 0);
}

// Whether an open surface has no sides at this feature: a free edge, or an edge of three faces.
SCREE_HD bool is_open(const MeshView& mesh, Index feature) {
  if (feature < mesh.part_count) return false;
  const MeshFeature& of = mesh.features[feature - mesh.part_count];
  return of.b < 0 ? of.b == kOpenVertex : of.tests != 2;
}

// Direction away from the surface on the contact's side.
SCREE_HD Vec3 side_direction(const MeshView& mesh, Index sided) {
  const Vec3 outward = outward_of(mesh, without_side(sided));
  return sided < 0 ? opposite(outward) : outward;
}
// The feature on this side of the surface as a contact of c.
SCREE_HD MeshContact sided_feature_at(const MeshView& mesh, Index sided, Vec3 c) {
  return mesh_feature_at(mesh, without_side(sided), c, side_direction(mesh, sided));
}

// is_outward(): on which side of the feature c is; is_penetrated(): whether that is not the contact's side.
SCREE_HD bool is_outward(const MeshView& mesh, Index feature, Vec3 c) {
  const MeshContact seen = mesh_feature_at(mesh, feature, c, {});
  return feature < mesh.part_count ? seen.distance >= 0 : dot(seen.normal, outward_of(mesh, feature)) >= 0;
}
SCREE_HD bool is_penetrated(const MeshView& mesh, Index sided, Vec3 c) {
  return (sided >= 0) != is_outward(mesh, without_side(sided), c);
}

// Moves a contact to the other side of the surface, which the sphere has then penetrated.
SCREE_HD void flip_side(MeshContact& contact) {
  contact.distance = -contact.distance;
  contact.normal = opposite(contact.normal);
}

// The contacts of a sphere with an open surface in the previous step.
struct PreviousSides {
  Index sided[kMeshSlots];
  int count = 0;

  SCREE_HD void add(Index of) { sided[count++] = of; }
  SCREE_HD void remove_escaped(int k) {
    for (--count; k < count; ++k) sided[k] = sided[k + 1];
  }
};

// Transfers the sides of the previous contacts to the present contacts that continue them.
class SideTracker {
 public:
  SCREE_HD SideTracker(const MeshView& mesh, Vec3 c, const PreviousSides& old)
      : mesh_(mesh), c_(c), old_(old) {}

  // contacts: as found for the centre c. Contacts whose surface is penetrated get a negative distance and
  // the normal of their side. Returns their number, with the order unchanged: where features continue a
  // penetrated surface, only the nearest of them counts.
  SCREE_HD int keep(MeshContact* contacts, int count) {
    bool continues[kMeshSlots] = {};
    int past = 0;
    for (const Match match : {Match::same, Match::same_side, Match::penetrated, Match::penetrated_neighbour})
      for (int k = 0; k < count && old_.count > 0; ++k) {
        if (continues[k]) continue;
        const int before = find(contacts[k], match);
        if (before < 0) continue;
        past += set_side(old_.sided[before], contacts[k]);
        continues[k] = true, old_.remove_escaped(before);
      }
    return past > 0 ? keep_nearest(contacts, count, continues) : count;
  }

 private:
  enum class Match { same, same_side, penetrated, penetrated_neighbour };

  // The previous contact that matches this one, -1: none; the lowest of several.
  SCREE_HD int find(const MeshContact& now, Match match) const {
    int best = -1;
    for (int k = 0; k < old_.count; ++k)
      if ((best < 0 || without_side(old_.sided[k]) < without_side(old_.sided[best])) &&
          matches(old_.sided[k], now, match))
        best = k;
    return best;
  }
  SCREE_HD bool matches(Index old, const MeshContact& now, Match match) const {
    const Index feature = without_side(old);
    if (match == Match::same) return feature == now.feature;
    const bool same_side = (old < 0) == (side_feature(mesh_, now) < 0);
    if (same_side != (match == Match::same_side)) return false;
    if (!same_side && (is_open(mesh_, feature) || is_open(mesh_, now.feature))) return false;
    const MeshContact previous = sided_feature_at(mesh_, old, c_);
    if (match == Match::penetrated_neighbour)
      return previous.distance < 0 && on_neighbouring_patches(mesh_, feature, now.feature);
    if (!mesh_detail::share_patch(mesh_, feature, now.feature)) return false;
    if (same_side) return dot(previous.normal, now.normal) >= mesh_.cosine;
    const bool are_faces = feature < mesh_.part_count && now.feature < mesh_.part_count;
    return -dot(previous.normal, now.normal) >= (are_faces ? mesh_.cosine : 0);
  }
  SCREE_HD bool set_side(Index old, MeshContact& contact) const {
    if ((old < 0) == (side_feature(mesh_, contact) < 0) || is_open(mesh_, contact.feature)) return false;
    flip_side(contact);
    return true;
  }
  // Whether a new contact is with the continuation of a penetrated surface, on the same side of it.
  SCREE_HD bool is_behind(const MeshContact& begins, const MeshContact& other) const {
    return other.distance < 0 && (side_feature(mesh_, begins) < 0) != (side_feature(mesh_, other) < 0) &&
           on_neighbouring_patches(mesh_, begins.feature, other.feature);
  }
  // The nearest contact alone pushes the sphere out, as inside a closed mesh. contacts: in order of
  // distance.
  SCREE_HD int keep_nearest(MeshContact* contacts, int count, bool* continues) const {
    bool left_out[kMeshSlots] = {};
    for (int k = 0; k < count; ++k) {
      if (continues[k]) continue;
      bool farther[kMeshSlots] = {}, takes_over = false;
      for (int j = 0; j < count && !left_out[k]; ++j) {
        if (!continues[j] || left_out[j] || !is_behind(contacts[k], contacts[j])) continue;
        farther[j] = contacts[k].distance < -contacts[j].distance;
        takes_over = takes_over || farther[j], left_out[k] = !farther[j];
      }
      if (left_out[k] || !takes_over) continue;
      for (int j = 0; j < count; ++j) left_out[j] = left_out[j] || farther[j];
      flip_side(contacts[k]), continues[k] = true;
    }
    int kept = 0;
    for (int k = 0; k < count; ++k)
      if (!left_out[k]) contacts[kept++] = contacts[k];
    return kept;
  }

  const MeshView& mesh_;
  Vec3 c_;
  PreviousSides old_;
};

}  // namespace scree
