// Contact keys of meshes: by feature, and on an open surface by whether the particle's centre has penetrated
// it, so that keys do not depend on the orientation of its faces. Shared by the CPU and CUDA backends.
#pragma once

#include "dem/history/history_slots.hpp"
#include "dem/surfaces/surfaces.hpp"
#include "mesh/open_surface_sides.hpp"

namespace scree {

// The centre of a particle in the frame of a mesh near it; shift: of the mesh's image.
struct InMeshFrame {
  const MeshView& mesh;
  Vec3 c;

  SCREE_HD InMeshFrame(const MeshView& of, const SurfacePose& surface, const SurfaceFrame& frame, Vec3 p,
                       Vec3 shift)
      : mesh(of),
        c(transposed_times(frame.axes, (nearest_image(surface, frame, p) - shift) - surface.point)) {}

  // Id of the contact in its key, from the stored feature; and the stored feature from the key.
  SCREE_HD GlobalId name(Index surface, Index stored_feature) const {
    if (!mesh.sheet) return surface_id(surface, stored_feature);
    return surface_id(surface, without_side(stored_feature), is_penetrated(mesh, stored_feature, c));
  }
  SCREE_HD Index stored_feature(std::int64_t contact_key) const {
    const Index feature = feature_of(contact_key);
    if (!mesh.sheet) return feature;
    return with_side(feature, is_outward(mesh, feature, c) != is_penetrated(contact_key));
  }
};

}  // namespace scree
