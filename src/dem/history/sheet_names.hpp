// Contact keys of meshes: by feature, and on an open surface by whether the particle's centre has penetrated
// it, so that keys do not depend on the orientation of its faces. Shared by the CPU and CUDA backends.
#pragma once

#include "dem/history/history_slots.hpp"
#include "dem/surfaces/surfaces.hpp"
#include "mesh/sheet_sides.hpp"

namespace scree {

// The centre of a particle in the frame of a mesh near it; shift: of the mesh's image.
struct BesideMesh {
  const MeshView& mesh;
  Vec3 c;

  SCREE_HD BesideMesh(const MeshView& of, const PlacedSurface& surface, const SurfaceFrame& frame, Vec3 p,
                      Vec3 shift)
      : mesh(of),
        c(transposed_times(frame.axes, (place_beside(surface, frame, p) - shift) - surface.point)) {}

  // Id of the contact in its key, from the stored feature; and the stored feature from the key.
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
