// The meshes of walls and bodies where they are at t = 0, and how far spheres overlap them.
#pragma once

#include <vector>

#include "base/twist.hpp"
#include "mesh/mesh_view.hpp"
#include "model/data/model.hpp"

namespace scree {

struct StartMesh {
  MeshView mesh;
  int body = kGround, wall = -1;  // what carries it: index into Model::bodies or Model::walls
  int material = 0;
  Vec3 point;  // of its origin, in the periodic box [m]
  Mat3 axes;   // rows: its axes in the global frame
  // As in a run: along an axis on which it is as long as the periodic space it goes on for ever, and a sphere
  // is where it lies beside its middle; along others it has images.
  Vec3 middle, spanned;      // [m], the latter 0 along the other axes
  std::vector<Vec3> shifts;  // of its images, itself included [m]

  // Of a sphere at p in the periodic box, with the images of either [m]; 0: none. Where the centre is inside,
  // the radius and its depth, which is not looked for beyond a radius: at most the diameter.
  Real overlap(Vec3 p, Real radius) const;
};

// A point many periods outside the space at its place in the periodic box.
Vec3 in_periodic_box(const Space& space, Vec3 p);
// Periods of the space; 0 along axes without [m].
Vec3 periods_of(const Space& space);
// Displacements of the images, that of the thing itself included [m].
std::vector<Vec3> image_shifts(Vec3 periods);

// Lives no longer than the model that it is made of.
class StartMeshes {
 public:
  explicit StartMeshes(const Model& model);

  // Those of bodies in their order, then those of walls.
  const std::vector<StartMesh>& all() const { return meshes_; }
  // Whether a sphere keeps `gap` from all.
  bool is_clear(Vec3 p, Real radius, Real gap) const;

 private:
  const Space& space_;
  std::vector<StartMesh> meshes_;
};

}  // namespace scree
