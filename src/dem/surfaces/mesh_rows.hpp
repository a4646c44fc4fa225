// Particles near meshes and their contacts with them: output of the search and of the narrow phase.
#pragma once

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "dem/surfaces/surfaces.hpp"
#include "mesh/mesh_tree.hpp"
#include "mesh/mesh_view.hpp"
#include "mesh/row_kinds.hpp"
#include "physics/contact_geometry.hpp"
#include "physics/step_contact.hpp"

namespace scree {

// A particle and a placed mesh shifted by `shift`, when a list is built.
struct MeshQuery {
  const SurfacePose& surface;
  const SurfaceFrame& frame;
  const MeshView& mesh;
  Vec4 p;  // x, y, z, radius
  Vec3 shift;
  Real past;  // search margin beyond touch, which also bounds the relative motion until the next list [m]

  // Calls visit(triangle) for the triangles of the row.
  SCREE_HD_CALLER template <class Visit>
  SCREE_HD void for_each_triangle(const Visit& visit) const {
    for_each_centre([&](Vec3 c) { for_each_triangle_near(mesh, c, p.w + past, visit); });
  }
  // Number of entries that the row needs for the mesh. stored: contacts of the particle with it in the
  // history.
  SCREE_HD Index entries(RowKind kind, const Index* triangles, Index count, Index stored) const {
    bool one_sided = mesh.sheet && kind == RowKind::smooth;
    if (one_sided)
      for_each_centre(
          [&](Vec3 c) { one_sided = one_sided && is_one_sided(mesh, triangles, count, c, past); });
    const Index slots = slots_needed(mesh, kind, one_sided, triangles, count);
    return slots > stored ? slots : stored < kMeshSlots ? stored : kMeshSlots;
  }

 private:
  // Centres in the frame of the mesh.
  SCREE_HD_CALLER template <class Visit>
  SCREE_HD void for_each_centre(const Visit& visit) const {
    for_each_near_image(surface, frame, xyz(p), past, [&](Vec3 position) {
      visit(transposed_times(frame.axes, (position - shift) - surface.point));
    });
  }
};

// A particle near a mesh: its entries for that mesh, one for each contact that is possible or in the history,
// and the triangles in range.
struct MeshGroup {
  Index entry, entries;
  Index first_triangle, triangles;
  RowKind kind;
};

// Rows of meshes near particles; a part of the surface rows.
struct MeshRows {
  const MeshGroup* groups;
  const Index* triangles;
  const MeshView* meshes;
};

// A contact with a mesh, per entry.
struct MeshTouch {
  bool touches;  // else all members below are undefined
  bool is_face;  // a face, or acting as one
  ContactGeometry geometry;
  Vec3 contact;    // application point of forces, from the surface's point [m]
  Vec3 normal0;    // normal at the start of the step
  Index feature;   // on open surfaces with the side (mesh/open_surface_sides.hpp)
  Index triangle;  // over a step: of a contact that ended, the triangle at its start
  Index from;      // entry whose history the contact continues; -1: none

  // Resets both flags, because they are read together.
  SCREE_HD void set_none() { touches = is_face = false; }
};

// A mesh contact at the start of an implicit step. A contact that exists at only one end of the step has an
// overlap of zero at the other, unless it changes over.
struct MeshTouchBefore {
  ContactGeometry geometry;
  Vec3 contact;
  Changeover change{};
};

}  // namespace scree
