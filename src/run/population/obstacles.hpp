// Surfaces at one instant that particles must not overlap when they are born.
#pragma once

#include <span>
#include <vector>

#include "model/data/body_exchange.hpp"
#include "model/data/model.hpp"
#include "model/derived/posed_meshes.hpp"
#include "partition/subdomain.hpp"

namespace scree {

// Planes, meshes and the shapes of bodies. Must not outlive its model.
class Obstacles {
 public:
  // motion: of the bodies, then of the walls with a pose.
  Obstacles(const Model& model, std::span<const BodyMotion> motion);

  // Whether a sphere is inside the domain and farther than `gap` from all surfaces. p: in the periodic box
  // [m].
  bool is_clear(Vec3 p, Real radius, Real gap) const;

 private:
  struct Plane {
    Vec3 point, normal;  // normal: unit vector into the free side
  };
  struct Sphere {
    Vec3 center;  // in the periodic box [m]
    Real radius;  // [m]
  };

  Subdomain subdomain_;
  std::vector<Vec3> shifts_;  // of images across periodic sides [m]
  std::vector<Plane> planes_;
  std::vector<Sphere> spheres_;
  PosedMeshes meshes_;
};

}  // namespace scree
