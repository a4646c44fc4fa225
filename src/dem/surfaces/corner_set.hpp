// Vertices of bodies' meshes as items of the pass that finds contacts of bodies with planes.
#pragma once

#include <span>
#include <vector>

#include "dem/surfaces/surfaces.hpp"
#include "mesh/hull_corners.hpp"
#include "model/data/model.hpp"

namespace scree {

// Vertices are numbered after the placed surfaces, mesh by mesh.
class CornerSet {
 public:
  struct OfMesh {
    Index surface;  // number of the placed mesh
    Index first;    // number of its first vertex
    const HullCorners* hull;
  };

  CornerSet(const Model& model, const SurfaceSet& surfaces);
  bool empty() const { return meshes_.empty(); }
  bool has(Index item) const { return item >= surfaces_; }
  // The placed surface that is the item, or to which the vertex belongs.
  Index surface_of(Index item) const { return has(item) ? mesh_of(item).surface : item; }
  const OfMesh& mesh_of(Index corner) const;
  // Position of a vertex in the frame of its mesh [m].
  Vec3 position_of(Index corner) const {
    const OfMesh& mesh = mesh_of(corner);
    return mesh.hull->corners[static_cast<std::size_t>(corner - mesh.first)];
  }
  // Adds the vertices that are less than the margin [m] above one of the planes, or below it, by number. A
  // mesh that is far from all planes costs one test.
  void add_near_planes(const SurfacePoses& poses, std::span<const WallPlane> planes, Real margin,
                       std::vector<Index>& to) const;
  // Contact parameters with every material twice. Vertices neither resist rolling and twisting nor attract,
  // since they stand for flat faces: they use the second set of materials, without these laws. Unchanged
  // where the deck has none.
  Contact with_own_materials(Contact contact) const;
  int material(int of_mesh) const { return of_mesh + own_materials_; }

 private:
  int own_materials_ = 0;  // number of the first material of the second set; 0: there is none
  Index surfaces_;         // number of placed surfaces
  std::vector<OfMesh> meshes_;
};

// A vertex at one instant, with the members that `SurfacePose` has for spheres.
struct CornerPose {
  Vec3 point, arm, velocity, displacement;
};
// snap_constant: of the Subdomain. at_start: at the start of the step.
CornerPose corner_pose(const SurfacePose& mesh, const SurfaceFrame& frame, Vec3 position, bool at_start,
                       Vec3 snap_constant);

}  // namespace scree
