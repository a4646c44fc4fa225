// Narrow phase of particles and meshes: found once for each particle and mesh near each other, before a law
// is evaluated. Shared by the CPU and CUDA backends.
#pragma once

#include "dem/surface_contact/surface_items.hpp"
#include "dem/surfaces/mesh_rows.hpp"
#include "mesh/cached_contact.hpp"
#include "mesh/mesh_contacts.hpp"
#include "mesh/open_surface_sides.hpp"
#include "physics/contact_geometry.hpp"

namespace scree {

// Geometry of a sphere and a feature in contact.
struct FeaturePair {
  ContactGeometry geometry;  // direction in the global frame
  Vec3 contact;              // see `MeshTouch`
};

SCREE_HD bool is_face(const MeshView& mesh, Index feature) { return feature < mesh.part_count; }
// Whether a mesh is an open (two-sided) surface. kOpenSurfaces: whether the model has any, so that other
// models pay nothing for it.
template <bool kOpenSurfaces>
SCREE_HD bool is_open_surface(const MeshView& mesh) {
  return kOpenSurfaces && mesh.sheet;
}
// An edge or a vertex of an open surface that the centre has penetrated acts as the tangent plane there.
template <bool kOpenSurfaces>
SCREE_HD bool acts_as_face(const MeshView& mesh, const MeshContact& found) {
  return is_face(mesh, found.feature) || (is_open_surface<kOpenSurfaces>(mesh) && found.distance < 0);
}
template <bool kOpenSurfaces>
SCREE_HD Index stored_feature(const MeshView& mesh, const MeshContact& contact) {
  return is_open_surface<kOpenSurfaces>(mesh) ? side_feature(mesh, contact) : contact.feature;
}

// c: the sphere's centre in the mesh's frame. A face uses the same function as an analytic plane, with the
// contact one radius below the centre; an edge or a vertex acts as a sphere of zero radius.
template <bool kOpenSurfaces>
SCREE_HD FeaturePair feature_pair(const MeshView& mesh, const MeshContact& found, const Mat3& axes, Vec3 c,
                                  Real radius) {
  const Vec3 normal = axes * found.normal;
  if (acts_as_face<kOpenSurfaces>(mesh, found)) {
    ContactGeometry g = plane_pair(c, radius, found.point, found.normal);
    g.direction = normal;
    return {g, axes * (c - radius * found.normal)};
  }
  return {{radius - found.distance, found.distance, normal, 1}, axes * found.point};
}

// Sides of the contacts of a group with an open surface: read from the history and, in a step that may be
// accepted, stored. Laws with a history store the sides in their own records.
struct SideHistory {
  const HistoryViews& history;
  int records;

  SCREE_HD bool sides_only() const { return history.bodies == nullptr && history.features != nullptr; }
  SCREE_HD bool has_history(Index entry) const {
    if (history.bodies != nullptr) return history.bodies[std::int64_t{entry} * records].w == history.step;
    return history.features != nullptr && history.features[entry] != kNoFeature;
  }
  SCREE_HD PreviousSides of(const MeshGroup& group) const {
    PreviousSides sides;
    for (Index e = group.entry; e < group.entry + group.entries; ++e)
      if (has_history(e)) sides.add(history.features[e]);
    return sides;
  }
  SCREE_HD void keep(Index entry, Index sided) const {
    if (sides_only()) history.next_features[entry] = sided;
  }
};

// Previous contacts of the particle, each with its entry.
struct PreviousTouches {
  Index entry[kMeshSlots];
  MeshContact contact[kMeshSlots];  // at the position of the particle at the start of the step
  int count = 0;

  SCREE_HD void remove_escaped(int k) {
    --count;
    for (; k < count; ++k) entry[k] = entry[k + 1], contact[k] = contact[k + 1];
  }
};

// Index of the previous contact that a contact continues; -1: none. First the one with the same feature;
// then, of those on the same smooth patch in about the same direction, the one with the lowest feature
// number; then, over a sharp edge, one on a neighbouring patch that acted close by. The result does not
// depend on the order of entries.
enum class HistoryMatch { same, same_patch, neighbour };
SCREE_HD int find_matching_contact(const MeshView& mesh, const MeshContact& now, const PreviousTouches& old,
                                   HistoryMatch match, Real contact_radius) {
  int best = -1;
  for (int k = 0; k < old.count; ++k) {
    const MeshContact& c = old.contact[k];
    if (best >= 0 && !(c.feature < old.contact[best].feature)) continue;
    const Vec3 difference = now.normal - c.normal;
    const bool related = match == HistoryMatch::same ? c.feature == now.feature
                         : match == HistoryMatch::same_patch
                             ? same_cluster(mesh, now, c)
                             : on_neighbouring_patches(mesh, now.feature, c.feature) &&
                                   dot(difference, difference) < contact_radius * contact_radius;
    if (related) best = k;
  }
  return best;
}

// Contacts of the g-th group, a particle and a mesh, at an instant or, with in.h above 0, over the explicit
// step that ends there. kHasRange: also pairs within in.interaction_range beyond touch, for which the law
// decides whether they are in contact. The contacts found are the same either way, unless the centre is
// deeper than its radius inside a closed mesh.
template <bool kHasRange, bool kOpenSurfaces>
struct MeshTouchItem {
  SurfaceViews in;
  MeshTouch* touches;              // per entry
  CachedContact* cached_contacts;  // per group; valid for this list

  SCREE_HD void operator()(Index g) const {
    if (use_cached(g, touches[in.meshes.groups[g].entry]) == Nearest::unclear) query(g, SingleLane{});
  }

  // Uses the cached contact where the particle has moved so little that no triangle needs to be tested:
  // writes the contact to `first`, the first entry of the group. Unclear: the cache is invalid.
  SCREE_HD Nearest use_cached(Index g, MeshTouch& first) const {
    const MeshGroup group = in.meshes.groups[g];
    const Sphere sphere = sphere_of(group);
    const CachedContact cached = cached_contacts[g];
    if (!cached.holds(sphere.c)) return Nearest::unclear;
    MeshContact contact;
    const Nearest found =
        cached.triangle >= 0 && is_within_range(sphere, cached, contact) ? Nearest::one : Nearest::none;
    return write(group, sphere, found, contact, first) ? found : Nearest::unclear;
  }

  // Narrow-phase query of a group over its triangles.
  SCREE_HD_CALLER template <class LaneGroup>
  SCREE_HD void query(Index g, const LaneGroup& team) const {
    const MeshGroup group = in.meshes.groups[g];
    const Sphere sphere = sphere_of(group);
    const MeshView& mesh = sphere.mesh;
    const Real range = searched(sphere.radius);
    TriangleRow row{in.meshes.triangles + group.first_triangle, group.triangles,
                    touches[group.entry].triangle};
    QueryResult result{Nearest::unclear, {}};
    result.found = NearestContact(mesh, sphere.c, range, group.kind).find(row, team, result.contact);
    // One lane searches in full, as far as the others have not excluded triangles.
    if (result.found == Nearest::unclear && team.stride() > 1)
      row = with_contacts_only(mesh, sphere.c, range, row, team);
    if (team.is_leader()) {
      if (result.found == Nearest::unclear)
        result.found = query_in_full(group, sphere, row, result.contact);
      else if (!write(group, sphere, result.found, result.contact, touches[group.entry]))
        result.found = write_all(group, sphere, &result.contact, result.found == Nearest::one ? 1 : 0);
    }
    result = team.from_leader(result);
    const CachedContactRow<LaneGroup> cache{mesh,     group.kind, row.triangles, row.count,
                                            sphere.c, range,      team};
    const bool on_face = result.found == Nearest::one && is_face(mesh, result.contact.feature);
    const CachedContact cached = result.found == Nearest::none  ? cache.clear()
                                 : on_face                      ? cache.over(result.contact.triangle)
                                 : result.found == Nearest::one ? cache.in_region_of(result.contact)
                                                                : kNoCachedContact;
    if (team.is_leader()) cached_contacts[g] = cached;
  }

 private:
  // Result of a query; `contact` is defined for exactly one contact.
  struct QueryResult {
    Nearest found;
    MeshContact contact;
  };
  // The sphere in the frame of the mesh, now and at the start of the step.
  struct Sphere {
    const MeshView& mesh;
    const Mat3 &axes, &axes0;
    Vec3 c, c0;
    Real radius;

    // Contact normal of this feature at the start of the step; side: as in mesh_feature_at().
    SCREE_HD Vec3 normal0_of(Index feature, Vec3 side) const {
      return normal0_of(mesh_feature_at(mesh, feature, c0, side));
    }
    SCREE_HD Vec3 normal0_of(const MeshContact& contact) const {
      return feature_pair<kOpenSurfaces>(mesh, contact, axes0, c0, radius).geometry.normal();
    }
  };
  SCREE_HD Sphere sphere_of(const MeshGroup& group) const {
    const Index i = in.entries.particles[group.entry];
    const SurfacePose& surface = in.placed[in.surface_of(group.entry)];
    const SurfaceFrame& frame = in.frames[surface.frame];
    const Vec4 p = in.position[i];
    const Vec3 from_point =
        (nearest_image(surface, frame, xyz(p)) - in.shift_of(group.entry)) - surface.point;
    const Vec3 c = transposed_times(frame.axes, from_point);
    const Vec3 displacement = in.h > 0 ? in.h * xyz(in.velocity[i]) - surface.displacement : Vec3{};
    const Vec3 c0 = in.h > 0 ? transposed_times(frame.before, from_point - displacement) : c;
    return {in.meshes.meshes[frame.mesh], frame.axes, in.h > 0 ? frame.before : frame.axes, c, c0, p.w};
  }
  SCREE_HD void put(MeshTouch& to, const Sphere& of, const MeshContact& found) const {
    const FeaturePair pair = feature_pair<kOpenSurfaces>(of.mesh, found, of.axes, of.c, of.radius);
    // Member by member: a whole load right after partial stores would stall.
    to.touches = pair.geometry.overlap > (kHasRange ? -in.interaction_range : 0);
    to.is_face = acts_as_face<kOpenSurfaces>(of.mesh, found);
    to.geometry = pair.geometry, to.contact = pair.contact;
    to.normal0 = pair.geometry.normal();
    to.feature = stored_feature<kOpenSurfaces>(of.mesh, found), to.triangle = found.triangle;
    to.from = -1;
  }
  // Full search for several contacts; a single one is also returned.
  SCREE_HD Nearest query_in_full(const MeshGroup& group, const Sphere& sphere, const TriangleRow& row,
                                 MeshContact& only_one) const {
    MeshContact found[kMeshSlots];
    const int count = find_mesh_contacts(sphere.mesh, sphere.c, searched(sphere.radius), row, found);
    const Nearest kept = write_all(group, sphere, found, min_of(count, static_cast<int>(group.entries)));
    if (kept == Nearest::one) only_one = found[0];
    return kept;
  }
  // Writes these contacts as the result of a group, with the sides and the history that they continue; the
  // sides change `found`. Returns how many are left; several are unclear.
  SCREE_HD Nearest write_all(const MeshGroup& group, const Sphere& sphere, MeshContact* found,
                             int count) const {
    const MeshView& mesh = sphere.mesh;
    if (is_open_surface<kOpenSurfaces>(mesh))
      count = SideTracker(mesh, sphere.c, memory().of(group)).keep(found, count);
    for (Index k = count; k < group.entries; ++k) touches[group.entry + k].set_none();
    for (int k = 0; k < count; ++k) put(touches[group.entry + k], sphere, found[k]);
    if (is_open_surface<kOpenSurfaces>(mesh) && in.h > 0) store_sides(group, count);
    if (in.history.bodies != nullptr) go_on(group, sphere, {found, count});
    return count == 0 ? Nearest::none : count == 1 ? Nearest::one : Nearest::unclear;
  }
  // Contact with the cached feature. Returns whether it is within range.
  SCREE_HD bool is_within_range(const Sphere& sphere, const CachedContact& on, MeshContact& contact) const {
    contact = mesh_feature_at(sphere.mesh, on.feature, sphere.c, {});
    contact.triangle = on.triangle;
    if (contact.distance < 0) flip_side(contact);
    return contact.distance < searched(sphere.radius);
  }
  // Writes this contact, or none, as the result of a group. Returns false, without writing, if the contact
  // continues other history than its own.
  SCREE_HD bool write(const MeshGroup& group, const Sphere& sphere, Nearest found, MeshContact contact,
                      MeshTouch& first) const {
    const MeshView& mesh = sphere.mesh;
    const Before before = before_of(group);
    const bool is_one = found == Nearest::one;
    if (before.entries > 1 || (is_one && !continues(mesh, before, contact))) return false;
    for (Index k = is_one ? 1 : 0; k < group.entries; ++k) touches[group.entry + k].set_none();
    if (is_one) {
      put(first, sphere, contact);
      if (in.history.bodies != nullptr) continue_sides_only(first, sphere, before, contact);
    }
    if (is_open_surface<kOpenSurfaces>(mesh) && in.h > 0)
      for (Index k = 0; k < group.entries; ++k)
        memory().keep(group.entry + k, is_one && k == 0 ? first.feature : kNoFeature);
    return true;
  }
  SCREE_HD SideHistory memory() const { return {in.history, in.records}; }
  SCREE_HD void store_sides(const MeshGroup& group, int count) const {
    for (Index k = 0; k < group.entries; ++k)
      memory().keep(group.entry + k, k < count ? touches[group.entry + k].feature : kNoFeature);
  }
  // Search radius for contacts of a sphere of this radius [m].
  SCREE_HD Real searched(Real radius) const { return kHasRange ? radius + in.interaction_range : radius; }
  SCREE_HD bool has_history(Index entry) const {
    return in.history.bodies[std::int64_t{entry} * in.records].w == in.history.step;
  }
  // Previous contacts of a group: their number, and the last one's entry and feature.
  struct Before {
    Index entries = 0, entry = -1, feature = kNoFeature;
  };
  SCREE_HD Before before_of(const MeshGroup& group) const {
    Before before;
    // Without branches, so that a GPU loads from all entries at once.
    for (Index e = group.entry; e < group.entry + group.entries; ++e) {
      const bool has = memory().has_history(e);
      before.entries += has, before.entry = has ? e : before.entry;
    }
    if (before.entries > 0) before.feature = in.history.features[before.entry];
    return before;
  }
  // Whether the contact continues its own history, or none exists. Sets the side on which a contact with an
  // open surface began, where that has sides.
  SCREE_HD static bool continues(const MeshView& mesh, const Before& before, MeshContact& contact) {
    if (before.entries == 0) return true;
    if (!is_open_surface<kOpenSurfaces>(mesh)) return before.feature == contact.feature;
    if (without_side(before.feature) != contact.feature) return false;
    if (before.feature != side_feature(mesh, contact) && !is_open(mesh, contact.feature)) flip_side(contact);
    return true;
  }
  SCREE_HD static void continue_sides_only(MeshTouch& touch, const Sphere& sphere, const Before& before,
                                           const MeshContact& contact) {
    touch.from = before.entry;
    const bool has_side = is_open_surface<kOpenSurfaces>(sphere.mesh) && before.entries > 0 &&
                          !is_open(sphere.mesh, contact.feature);
    touch.normal0 = sphere.normal0_of(
        contact.feature, has_side ? side_direction(sphere.mesh, before.feature) : contact.normal);
  }
  struct Found {
    const MeshContact* contacts;
    int count;
  };
  // Finds the history that the contacts continue, and the normals of all contacts at the start of the step.
  SCREE_HD void go_on(const MeshGroup& group, const Sphere& sphere, const Found& found) const {
    const MeshView& mesh = sphere.mesh;
    PreviousTouches old;
    for (Index e = group.entry; e < group.entry + group.entries; ++e) {
      if (!has_history(e)) continue;
      const Index stored = in.history.features[e],
                  feature = is_open_surface<kOpenSurfaces>(mesh) ? without_side(stored) : stored;
      const bool has_side = is_open_surface<kOpenSurfaces>(mesh) && !is_open(mesh, feature);
      const Vec3 side = has_side ? side_direction(mesh, stored) : side_of(found, mesh, feature);
      old.entry[old.count] = e;
      old.contact[old.count++] = mesh_feature_at(mesh, feature, sphere.c0, side);
    }
    for (const HistoryMatch match : {HistoryMatch::same, HistoryMatch::same_patch, HistoryMatch::neighbour})
      for (int k = 0; k < found.count && old.count > 0; ++k) {
        MeshTouch& out = touches[group.entry + k];
        if (out.from >= 0) continue;
        const Real overlap = out.geometry.overlap;
        const Real close = std::sqrt((overlap > 0 ? 2 * overlap : 0) / sphere.radius);
        const int before = find_matching_contact(mesh, found.contacts[k], old, match, close);
        if (before < 0) continue;
        out.from = old.entry[before];
        out.normal0 = sphere.normal0_of(old.contact[before]);
        old.remove_escaped(before);
      }
    for (int k = 0; k < found.count; ++k) {
      MeshTouch& out = touches[group.entry + k];
      if (out.from < 0) out.normal0 = sphere.normal0_of(found.contacts[k].feature, found.contacts[k].normal);
    }
  }
  // Direction in which a previous feature without sides is evaluated.
  SCREE_HD static Vec3 side_of(const Found& found, const MeshView& mesh, Index feature) {
    for (int k = 0; k < found.count; ++k)
      if (found.contacts[k].feature == feature) return found.contacts[k].normal;
    return found.count > 0          ? found.contacts[0].normal
           : is_face(mesh, feature) ? mesh.parts[feature].normal
                                    : Vec3{};
  }
  SCREE_HD static int min_of(int a, int b) { return a < b ? a : b; }
};

}  // namespace scree
