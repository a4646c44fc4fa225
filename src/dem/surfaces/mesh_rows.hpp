// Particles near meshes, and where they touch them: what the search and the look leave to the contacts'
// items.
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

// A particle and a placed mesh that is moved by `shift`, when a list is built.
struct MeshSight {
  const PlacedSurface& surface;
  const SurfaceFrame& frame;
  const MeshView& mesh;
  Vec4 p;  // x, y, z, radius
  Vec3 shift;
  Real past;  // how far past touch triangles are looked for, and as far as the two may move [m]

  // Calls visit(triangle) for those of the row.
  SCREE_HD_CALLER template <class Visit>
  SCREE_HD void for_each_triangle(const Visit& visit) const {
    for_each_centre([&](Vec3 c) { for_each_triangle_near(mesh, c, p.w + past, visit); });
  }
  // How many entries the row needs for the mesh, of whose contacts the particle remembers so many.
  SCREE_HD Index entries(RowKind kind, const Index* triangles, Index count, Index remembered) const {
    bool one_sided = mesh.sheet && kind == RowKind::smooth;
    if (one_sided)
      for_each_centre(
          [&](Vec3 c) { one_sided = one_sided && is_one_sided(mesh, triangles, count, c, past); });
    const Index slots = slots_needed(mesh, kind, one_sided, triangles, count);
    return slots > remembered ? slots : remembered < kMeshSlots ? remembered : kMeshSlots;
  }

 private:
  // In the frame of the mesh.
  SCREE_HD_CALLER template <class Visit>
  SCREE_HD void for_each_centre(const Visit& visit) const {
    for_each_place_beside(surface, frame, xyz(p), past, [&](Vec3 place) {
      visit(transposed_times(frame.axes, (place - shift) - surface.point));
    });
  }
};

// A particle near a mesh: the entries of its row that stand for that mesh, one for each contact that it may
// have there or remembers, and the triangles that it may touch.
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
  bool touches;  // else nothing below has a meaning
  bool is_face;  // or acts as one
  ContactGeometry geometry;
  Vec3 contact;    // where forces act, from the surface's point [m]
  Vec3 normal0;    // where the step began
  Index feature;   // on a sheet with the side (mesh/sheet_sides.hpp)
  Index triangle;  // over a step, a contact that ended in it has the triangle of its start
  Index from;      // entry whose memory the contact goes on from; -1: none

  // Both flags: they are read at once.
  SCREE_HD void set_none() { touches = is_face = false; }
};

// The same contact where an implicit step began. One that was open then, or is open at the end, has no
// overlap there, unless it changes over.
struct MeshTouchBefore {
  ContactGeometry geometry;
  Vec3 contact;
  Changeover change{};
};

}  // namespace scree
