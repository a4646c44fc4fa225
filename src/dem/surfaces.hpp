// Surfaces that particles touch, in the frame of what carries them: the ground or a body.
#pragma once

#include <vector>

#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "model/body_exchange.hpp"
#include "model/model.hpp"
#include "partition/subdomain.hpp"
#include "physics/contact_geometry.hpp"

namespace scree {

enum class SurfaceKind : int { plane, sphere };  // discs are spheres: their centres lie in one plane

// A surface on a body; constant.
struct Surface {
  SurfaceKind kind;
  int carrier;  // index into Model::bodies
  int material;
  Vec3 point;   // of a plane, or a sphere's centre; in the carrier's frame [m]
  Vec3 normal;  // of a plane: unit, into its free side
  Real radius;  // of a sphere [m]
};

// A surface of the ground in the form the items read: half space.
struct WallPlane {
  Vec3 point, normal;
  int material;
};
std::vector<WallPlane> wall_planes(const Model& model);

// The surfaces of a model are numbered: the walls in the deck's order, on the ground, then the shapes of the
// bodies.
class SurfaceSet {
 public:
  explicit SurfaceSet(const Model& model);
  Index ground() const { return ground_; }  // how many are on the ground; they do not move
  Index on_bodies() const { return static_cast<Index>(on_bodies_.size()); }
  // moving: counts from the first surface on a body.
  const Surface& on_body(Index moving) const { return on_bodies_[static_cast<std::size_t>(moving)]; }

 private:
  Index ground_;
  std::vector<Surface> on_bodies_;
};

// A surface on a body where it is at one instant, as the items read it.
struct PlacedSurface {
  SurfaceKind kind;
  int material;
  Real radius;          // [m]
  Vec3 point, normal;   // as in Surface, in the global frame
  Vec3 arm;             // of the point, from the body's centre [m]
  Vec3 velocity, spin;  // of the body [m/s], [rad/s]
  // Since the explicit step began, for laws that move: of the point [m], and of the body about its centre
  // [rad]. The point's is exact, so that nothing is left over of a surface that comes back.
  Vec3 travel, turn;

  // Of the place on the body at `from_point` from the point.
  SCREE_HD Vec3 velocity_at(Vec3 from_point) const { return velocity + cross(spin, arm + from_point); }
};

// A sphere at p (x, y, z, radius) as it lies to a surface that is moved by `shift`.
struct SurfacePair {
  ContactGeometry geometry;
  Vec3 contact;  // where they touch, on the surface, from its point [m]
};

SCREE_HD SurfacePair surface_pair(const PlacedSurface& surface, Vec3 shift, Vec4 p) {
  if (surface.kind == SurfaceKind::plane) {
    const Vec3 place = xyz(p) - shift;
    const ContactGeometry g = plane_pair(place, p.w, surface.point, surface.normal);
    return {g, place - g.distance * g.direction - surface.point};
  }
  const ContactGeometry g = sphere_pair(xyz(p) - (surface.point + shift), p.w + surface.radius);
  return {g, surface.radius * g.normal()};
}

// Near which surfaces each particle is: a list of the same reach as the neighbour list. An entry stands in
// the row of its particle, ordered by surface and image.
struct SurfaceEntries {
  const Index* surfaces;      // per entry; those of the ground have the lowest numbers
  const std::int8_t* images;  // number of the shift of the surface, 13 for none
  const Index* particles;     // whose row it stands in
  const Index* by_surface;    // the entries with surfaces on bodies, surface by surface
};

}  // namespace scree
