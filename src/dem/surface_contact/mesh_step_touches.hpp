// Contacts of particles with meshes over an implicit step. Shared by the CPU and CUDA backends.
#pragma once

#include "dem/surface_contact/mesh_touches.hpp"

namespace scree {

// Contacts of the g-th group at both ends of the step; those at the start are matched with those at the end.
template <bool kOpenSurfaces>
struct MeshStepTouchItem {
  SurfaceViews in;
  const Vec4* start_position;
  const SurfacePose* start_surface_poses;
  MeshTouch* touches;       // per entry; touches: a contact at either end
  MeshTouchBefore* before;  // per entry

  SCREE_HD void operator()(Index g) const {
    const MeshGroup group = in.meshes.groups[g];
    const Index i = in.entries.particles[group.entry], s = in.surface_of(group.entry);
    const SurfacePose &surface = in.placed[s], &surface0 = start_surface_poses[s];
    const SurfaceFrame& frame = in.frames[surface.frame];
    const MeshView& mesh = in.meshes.meshes[frame.mesh];
    const Vec4 p = in.position[i];
    const Vec3 position = nearest_image(surface, frame, xyz(p)) - in.shift_of(group.entry),
               position0 = position - (xyz(p) - xyz(start_position[i]));
    const SphereInMesh end{frame.axes, transposed_times(frame.axes, position - surface.point), p.w},
        start{frame.before, transposed_times(frame.before, position0 - surface0.point), p.w};
    const TriangleRow row{in.meshes.triangles + group.first_triangle, group.triangles};
    MeshContact now[kMeshSlots];
    PreviousTouches old;
    int count = find_mesh_contacts(mesh, end.c, p.w, row, now);
    old.count = find_mesh_contacts(mesh, start.c, p.w, row, old.contact);
    if (is_open_surface<kOpenSurfaces>(mesh))
      count = track_sides(group, {mesh, end.c, start.c}, now, count, old);
    for (int k = 0; k < old.count; ++k)
      old.entry[k] = entry_of_feature(group, stored_feature<kOpenSurfaces>(mesh, old.contact[k]));
    // The contacts at the end of the step come first, whether they existed at the start or not.
    bool matched[kMeshSlots] = {};
    for (const HistoryMatch match : {HistoryMatch::same, HistoryMatch::same_patch})
      for (int k = 0; k < count && k < group.entries; ++k) {
        if (matched[k]) continue;
        const int at = find_matching_contact(mesh, now[k], old, match, 0);
        if (at < 0) continue;
        put(group.entry + k, mesh, now[k], old.contact[at], {end, start}, old.entry[at]);
        matched[k] = true, old.remove_escaped(at);
      }
    Overlaps ending{}, beginning{};  // of the nearest contacts that exist at one end only
    for (int k = 0; k < count && k < group.entries; ++k) {
      if (matched[k]) continue;
      const MeshContact was = mesh_feature_at(mesh, now[k].feature, start.c, now[k].normal);
      put(group.entry + k, mesh, now[k], was, {end, start}, -1);
      if (k == 0) beginning = overlaps_at(group.entry);
      open(before[group.entry + k].geometry);
    }
    Index next = count;
    for (int k = 0; k < old.count && next < group.entries; ++k, ++next) {
      const MeshContact& was = old.contact[k];
      put(group.entry + next, mesh, mesh_feature_at(mesh, was.feature, end.c, was.normal), was, {end, start},
          old.entry[k]);
      if (k == 0) ending = overlaps_at(group.entry + next);
      open(touches[group.entry + next].geometry);
    }
    if (!mesh.sheet && (beginning.at_end > p.w || ending.at_start > p.w))
      change_over(group.entry + count, ending, group.entry, beginning);
    for (; next < group.entries; ++next) touches[group.entry + next].set_none();
    if (is_open_surface<kOpenSurfaces>(mesh))
      for (Index k = 0; k < group.entries; ++k)
        memory().keep(group.entry + k, k < count ? touches[group.entry + k].feature : kNoFeature);
  }

 private:
  // A sphere in the frame of a mesh.
  struct SphereInMesh {
    const Mat3& axes;
    Vec3 c;
    Real radius;
  };
  struct SphereAtEnds {
    const SphereInMesh &end, &start;
  };
  // Sphere centre in the frame of an open surface, at both ends of the step.
  struct CentreAtEnds {
    const MeshView& mesh;
    Vec3 c, c0;
  };
  SCREE_HD SideHistory memory() const { return {in.history, in.records}; }
  // Tracks the sides of the contacts at the start, then of those at the end, which continue them.
  SCREE_HD int track_sides(const MeshGroup& group, const CentreAtEnds& of, MeshContact* now, int count,
                           PreviousTouches& old) const {
    old.count = SideTracker(of.mesh, of.c0, memory().of(group)).keep(old.contact, old.count);
    PreviousSides sides;
    for (int k = 0; k < old.count; ++k) sides.add(side_feature(of.mesh, old.contact[k]));
    return SideTracker(of.mesh, of.c, sides).keep(now, count);
  }
  SCREE_HD void put(Index entry, const MeshView& mesh, const MeshContact& now, const MeshContact& was,
                    const SphereAtEnds& ends, Index from) const {
    const SphereInMesh &end = ends.end, &start = ends.start;
    const FeaturePair pair = feature_pair<kOpenSurfaces>(mesh, now, end.axes, end.c, end.radius),
                      pair0 = feature_pair<kOpenSurfaces>(mesh, was, start.axes, start.c, start.radius);
    touches[entry] = {true,
                      acts_as_face<kOpenSurfaces>(mesh, now),
                      pair.geometry,
                      pair.contact,
                      pair0.geometry.normal(),
                      stored_feature<kOpenSurfaces>(mesh, now),
                      now.triangle >= 0 ? now.triangle : was.triangle,
                      from};
    before[entry] = {pair0.geometry, pair0.contact};
  }
  // Overlaps of a contact with its feature at both ends of the step; zero: no contact.
  struct Overlaps {
    Real at_start, at_end;
  };
  SCREE_HD Overlaps overlaps_at(Index entry) const {
    return {before[entry].geometry.overlap, touches[entry].geometry.overlap};
  }
  // A sphere whose centre is inside a closed mesh (overlap above its radius) touches the nearest face only.
  // Where that face changes within the step, the contact does not begin or end at touch: it changes over
  // where both faces are equally near, with linear interpolation of their overlaps.
  SCREE_HD void change_over(Index ends, const Overlaps& ending, Index begins,
                            const Overlaps& beginning) const {
    const Real nearer0 = beginning.at_start - ending.at_start, nearer1 = ending.at_end - beginning.at_end;
    if (!(nearer0 > 0 && nearer1 > 0 && ending.at_start > 0 && beginning.at_end > 0)) return;
    const Real share = nearer0 / (nearer0 + nearer1);
    const Real overlap = ending.at_start + share * (ending.at_end - ending.at_start);
    touches[ends].geometry.overlap = ending.at_end, before[begins].geometry.overlap = beginning.at_start;
    before[ends].change = {Changeover::Kind::ends, overlap, share};
    before[begins].change = {Changeover::Kind::begins, overlap, 1 - share};
  }
  // Sets the overlap at the end of the step at which the contact does not exist.
  SCREE_HD static void open(ContactGeometry& geometry) {
    if (geometry.overlap > 0) geometry.overlap = 0;
  }
  // Entry with the history of the contact with a feature; -1: none.
  SCREE_HD Index entry_of_feature(const MeshGroup& group, Index feature) const {
    if (in.history.bodies != nullptr)
      for (Index e = group.entry; e < group.entry + group.entries; ++e)
        if (in.history.bodies[std::int64_t{e} * in.records].w == in.history.step &&
            in.history.features[e] == feature)
          return e;
    return -1;
  }
};

}  // namespace scree
