// How contacts with meshes are named while there is no list: by the feature, and on a sheet by whether the
// particle's centre is past it, so that the name does not depend on how a sheet's faces are turned. One text
// for the CPU and CUDA.
#pragma once

#include "dem/history/history_slots.hpp"
#include "dem/surfaces/surfaces.hpp"
#include "mesh/sheet_sides.hpp"

namespace scree {

// A mesh, and the centre of a particle beside it in its frame; shift: of the mesh's image.
struct BesideMesh {
  const MeshView& mesh;
  Vec3 c;

  SCREE_HD BesideMesh(const MeshView& of, const PlacedSurface& surface, const SurfaceFrame& frame, Vec3 p,
                      Vec3 shift)
      : mesh(of),
        c(transposed_times(frame.axes, (place_beside(surface, frame, p) - shift) - surface.point)) {}

  // From what the contact remembers, and back.
  SCREE_HD GlobalId name(Index surface, Index remembered) const {
    if (!mesh.sheet) return surface_id(surface, remembered);
    return surface_id(surface, without_side(remembered), is_past(mesh, remembered, c));
  }
  SCREE_HD Index remembered(std::int64_t contact_key) const {
    const Index feature = feature_of(contact_key);
    if (!mesh.sheet) return feature;
    return with_side(feature, is_outward(mesh, feature, c) != is_past(contact_key));
  }
};

}  // namespace scree
