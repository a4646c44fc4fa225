// Contact keys of meshes: by feature, and on an open surface by whether the particle's centre has penetrated
// it, so that keys do not depend on the orientation of its faces. Shared by the CPU and CUDA backends.
#pragma once

#include "dem/history/contact_key.hpp"
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

  // Completes the contact key of the mesh with the feature that the contact stores
  // (`HistoryViews::features`), and with its side.
  SCREE_HD ContactKey key_at(ContactKey key, Index stored) const {
    key.feature = mesh.sheet ? without_side(stored) : stored;
    key.penetrated = mesh.sheet && is_penetrated(mesh, stored, c);
    return key;
  }
  // Feature to be stored, from the packed key.
  SCREE_HD Index stored_feature(std::int64_t key) const {
    const Index feature = feature_of(key);
    if (!mesh.sheet) return feature;
    return with_side(feature, is_outward(mesh, feature, c) != is_penetrated(key));
  }
};

}  // namespace scree
