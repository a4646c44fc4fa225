// The side of a sheet on which a contact began: it is kept until the contact ends, also past the sheet. Host
// and device, with the same bits.
#pragma once

#include <initializer_list>
#include <limits>

#include "mesh/mesh_contacts.hpp"

namespace scree {

// What a contact with a sheet remembers of it is one number: the feature, and whether the contact is on the
// side to which the sheet's faces, or the mean normal of an edge or a vertex, point.
inline constexpr Index kNoFeature = std::numeric_limits<Index>::min();
SCREE_HD Index with_side(Index feature, bool outward) { return outward ? feature : ~feature; }
SCREE_HD Index without_side(Index sided) { return sided < 0 ? ~sided : sided; }

SCREE_HD Vec3 outward_of(const MeshView& mesh, Index feature) {
  return feature < mesh.part_count ? mesh.parts[feature].normal
                                   : in_double(mesh.features[feature - mesh.part_count].outward);
}

// Of a contact with a sheet; with a closed mesh the feature alone.
SCREE_HD Index sided_feature(const MeshView& mesh, const MeshContact& contact) {
  if (!mesh.sheet) return contact.feature;
  return with_side(contact.feature, dot(contact.normal, outward_of(mesh, contact.feature)) >= 0);
}

// Whether a sheet has no sides there: at a free edge, and where three faces meet.
SCREE_HD bool is_open(const MeshView& mesh, Index feature) {
  if (feature < mesh.part_count) return false;
  const MeshFeature& of = mesh.features[feature - mesh.part_count];
  return of.b < 0 ? of.b == kOpenVertex : of.tests != 2;
}

// Away from the sheet, on the contact's side.
SCREE_HD Vec3 side_direction(const MeshView& mesh, Index sided) {
  const Vec3 outward = outward_of(mesh, without_side(sided));
  return sided < 0 ? opposite(outward) : outward;
}
// The feature as a contact on this side of it lies to c.
SCREE_HD MeshContact sided_feature_at(const MeshView& mesh, Index sided, Vec3 c) {
  return mesh_feature_at(mesh, without_side(sided), c, side_direction(mesh, sided));
}

// On which side of the feature c is now; and whether that is not the contact's.
SCREE_HD bool is_outward(const MeshView& mesh, Index feature, Vec3 c) {
  const MeshContact seen = mesh_feature_at(mesh, feature, c, {});
  return feature < mesh.part_count ? seen.distance >= 0 : dot(seen.normal, outward_of(mesh, feature)) >= 0;
}
SCREE_HD bool is_past(const MeshView& mesh, Index sided, Vec3 c) {
  return (sided >= 0) != is_outward(mesh, without_side(sided), c);
}

// To the other side, past the sheet.
SCREE_HD void turn_over(MeshContact& contact) {
  contact.distance = -contact.distance;
  contact.normal = opposite(contact.normal);
}

// The contacts of a sphere with a sheet at the last step.
struct RememberedSides {
  Index sided[kMeshSlots];
  int count = 0;

  SCREE_HD void add(Index of) { sided[count++] = of; }
  SCREE_HD void take_out(int k) {
    for (--count; k < count; ++k) sided[k] = sided[k + 1];
  }
};

// Gives the contacts that are found the sides of those that they go on from.
class SideKeeper {
 public:
  SCREE_HD SideKeeper(const MeshView& mesh, Vec3 c, const RememberedSides& old)
      : mesh_(mesh), c_(c), old_(old) {}

  // contacts: as the centre c sees them. Those that c is past get a negative distance and the normal of their
  // side. Returns how many there are, in the same order: of what continues the sheet that c is past the
  // nearest alone counts.
  SCREE_HD int keep(MeshContact* contacts, int count) {
    bool goes_on[kMeshSlots] = {};
    int past = 0;
    for (const Kin kin : {Kin::same, Kin::same_side, Kin::past, Kin::past_neighbour})
      for (int k = 0; k < count && old_.count > 0; ++k) {
        if (goes_on[k]) continue;
        const int before = find(contacts[k], kin);
        if (before < 0) continue;
        past += turn_to(old_.sided[before], contacts[k]);
        goes_on[k] = true, old_.take_out(before);
      }
    return past > 0 ? keep_nearest(contacts, count, goes_on) : count;
  }

 private:
  enum class Kin { same, same_side, past, past_neighbour };

  // Which of those that were there this one goes on from, -1: none; of several the lowest.
  SCREE_HD int find(const MeshContact& now, Kin kin) const {
    int best = -1;
    for (int k = 0; k < old_.count; ++k)
      if ((best < 0 || without_side(old_.sided[k]) < without_side(old_.sided[best])) &&
          is_kin(old_.sided[k], now, kin))
        best = k;
    return best;
  }
  SCREE_HD bool is_kin(Index old, const MeshContact& now, Kin kin) const {
    const Index feature = without_side(old);
    if (kin == Kin::same) return feature == now.feature;
    const bool same_side = (old < 0) == (sided_feature(mesh_, now) < 0);
    if (same_side != (kin == Kin::same_side)) return false;
    if (!same_side && (is_open(mesh_, feature) || is_open(mesh_, now.feature))) return false;
    const MeshContact was = sided_feature_at(mesh_, old, c_);
    if (kin == Kin::past_neighbour)
      return was.distance < 0 && on_neighbouring_patches(mesh_, feature, now.feature);
    if (!mesh_detail::share_patch(mesh_, feature, now.feature)) return false;
    if (same_side) return dot(was.normal, now.normal) >= mesh_.cosine;
    const bool are_faces = feature < mesh_.part_count && now.feature < mesh_.part_count;
    return -dot(was.normal, now.normal) >= (are_faces ? mesh_.cosine : 0);
  }
  SCREE_HD bool turn_to(Index old, MeshContact& contact) const {
    if ((old < 0) == (sided_feature(mesh_, contact) < 0) || is_open(mesh_, contact.feature)) return false;
    turn_over(contact);
    return true;
  }
  // Whether a contact that begins is with what continues the sheet that c is past, from the same side of it.
  SCREE_HD bool is_behind(const MeshContact& begins, const MeshContact& other) const {
    return other.distance < 0 && (sided_feature(mesh_, begins) < 0) != (sided_feature(mesh_, other) < 0) &&
           on_neighbouring_patches(mesh_, begins.feature, other.feature);
  }
  // As inside a closed mesh the nearest pushes out, and that alone. contacts: in order of distance.
  SCREE_HD int keep_nearest(MeshContact* contacts, int count, bool* goes_on) const {
    bool left_out[kMeshSlots] = {};
    for (int k = 0; k < count; ++k) {
      if (goes_on[k]) continue;
      bool farther[kMeshSlots] = {}, takes_over = false;
      for (int j = 0; j < count && !left_out[k]; ++j) {
        if (!goes_on[j] || left_out[j] || !is_behind(contacts[k], contacts[j])) continue;
        farther[j] = contacts[k].distance < -contacts[j].distance;
        takes_over = takes_over || farther[j], left_out[k] = !farther[j];
      }
      if (left_out[k] || !takes_over) continue;
      for (int j = 0; j < count; ++j) left_out[j] = left_out[j] || farther[j];
      turn_over(contacts[k]), goes_on[k] = true;
    }
    int kept = 0;
    for (int k = 0; k < count; ++k)
      if (!left_out[k]) contacts[kept++] = contacts[k];
    return kept;
  }

  const MeshView& mesh_;
  Vec3 c_;
  RememberedSides old_;
};

}  // namespace scree
