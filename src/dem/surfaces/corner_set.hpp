// The corners of bodies' meshes as items of the pass in which bodies meet planes.
#pragma once

#include <span>
#include <vector>

#include "dem/surfaces/surfaces.hpp"
#include "mesh/hull_corners.hpp"
#include "model/data/model.hpp"

namespace scree {

// Corners are numbered behind the placed surfaces, mesh by mesh.
class CornerSet {
 public:
  struct OfMesh {
    Index surface;  // number of the placed mesh
    Index first;    // number of its first corner
    const HullCorners* hull;
  };

  CornerSet(const Model& model, const SurfaceSet& surfaces);
  bool empty() const { return meshes_.empty(); }
  bool has(Index item) const { return item >= surfaces_; }
  // The placed surface that an item is, or whose corner it is.
  Index surface_of(Index item) const { return has(item) ? mesh_of(item).surface : item; }
  const OfMesh& mesh_of(Index corner) const;
  // Position of a corner in the frame of its mesh [m].
  Vec3 position_of(Index corner) const {
    const OfMesh& mesh = mesh_of(corner);
    return mesh.hull->corners[static_cast<std::size_t>(corner - mesh.first)];
  }
  // Adds the corners that are less than the margin [m] over one of the planes, or below it, by number: a mesh
  // that is far from all of them costs one test.
  void add_near_planes(const SurfacePlaces& places, std::span<const WallPlane> planes, Real margin,
                       std::vector<Index>& to) const;
  // A corner neither rolls nor resists twisting: where the deck has laws for that, the materials stand twice
  // in what comes out, behind the others without these laws.
  Contact with_own_materials(Contact contact) const;

 private:
  Index surfaces_;  // how many are placed
  std::vector<OfMesh> meshes_;
};

// A corner at one instant, with the members that PlacedSurface has for spheres.
struct PlacedCorner {
  Vec3 point, arm, velocity, travel;
};
// snap_constant: of the Subdomain. at_start: the corner is where the step began, with the mesh as it was
// there.
PlacedCorner placed_corner(const PlacedSurface& mesh, const SurfaceFrame& frame, Vec3 place, bool at_start,
                           Vec3 snap_constant);

}  // namespace scree
