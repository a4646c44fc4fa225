// The meshes of walls and bodies in their poses at one instant, and the overlaps of spheres with them.
#pragma once

#include <span>
#include <vector>

#include "base/spatial_velocity.hpp"
#include "mesh/mesh_view.hpp"
#include "model/data/body_exchange.hpp"
#include "model/data/model.hpp"

namespace scree {

struct PosedMesh {
  MeshView mesh;
  int body = kGround, wall = -1;  // its owner: index into Model::bodies or Model::walls
  int material = 0;
  Vec3 point;  // of the mesh's origin, in the periodic box [m]
  Mat3 axes;   // rows: its axes in the global frame
  // As in a run: along an axis on which the mesh is as long as the periodic domain it continues without end,
  // and spheres are taken relative to its middle; along other axes it has images.
  Vec3 middle{}, spanned{};    // [m]; spanned is 0 along the other axes
  std::vector<Vec3> shifts{};  // displacements of its images, zero for itself included [m]

  // Overlap with a sphere at p in the periodic box, images included [m]; 0: none. Where the centre is inside,
  // the radius plus its depth, which is searched up to one radius: at most the diameter.
  Real overlap(Vec3 p, Real radius) const;
};

// Wraps a point any number of periods outside the domain into the periodic box.
Vec3 in_periodic_box(const Space& space, Vec3 p);
// Periods of the domain; 0 along axes without a period [m].
Vec3 periods_of(const Space& space);
// Displacements of the images, zero for the object itself included [m].
std::vector<Vec3> image_shifts(Vec3 periods);

// Must not outlive its model.
class PosedMeshes {
 public:
  // At t = 0.
  explicit PosedMeshes(const Model& model);
  // motion: of the bodies, then of the walls with a pose.
  PosedMeshes(const Model& model, std::span<const BodyMotion> motion);

  // Meshes of bodies in their order, then meshes of walls.
  const std::vector<PosedMesh>& all() const { return meshes_; }
  // Whether a sphere has a distance of at least `gap` to all meshes.
  bool is_clear(Vec3 p, Real radius, Real gap) const;

 private:
  void add(PosedMesh mesh, const SurfaceMesh& surface);

  const Space& space_;
  std::vector<PosedMesh> meshes_;
};

}  // namespace scree
