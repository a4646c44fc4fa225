// Surfaces that particles touch, in the frame of what carries them: the ground or a body.
#pragma once

#include <span>
#include <vector>

#include "base/hd.hpp"
#include "base/twist.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "model/data/body_exchange.hpp"
#include "model/data/model.hpp"
#include "partition/halo_plan.hpp"
#include "partition/subdomain.hpp"
#include "physics/contact_geometry.hpp"

namespace scree {

enum class SurfaceKind : int { plane, sphere, mesh };  // discs are spheres: their centres lie in one plane

// A surface that is not a plane at rest; constant.
struct Surface {
  SurfaceKind kind;
  int carrier;  // index into Model::bodies; past these the walls of SurfaceSet, one after the other
  int material;
  Vec3 point;    // of a plane, a sphere's centre, the origin of a mesh; in the carrier's frame [m]
  Vec3 normal;   // of a plane: unit, into its free side
  Real radius;   // of a sphere [m]
  int mesh = 0;  // of a mesh: index into Model::meshes
  bool moves = true;
};

// Meshes that move are looked for so many times as far past touch as other surfaces: corners of theirs go far
// while particles hardly do, and rows of triangles are cheap beside a new list.
inline constexpr Real kMeshSkins = 2;
// What a list must cover of their motion, as that of a particle: which has half a skin, and they all beyond.
inline constexpr Real kMeshWear = 1 / (2 * kMeshSkins - 1);

// A wall in the form the items read. Of a plane at rest that is all; `placed`: of another wall its number
// among the placed surfaces, else -1.
struct WallPlane {
  Vec3 point, normal;
  int material;
  Index placed = -1;
};
std::vector<WallPlane> wall_planes(const Model& model);
// Whether a mesh of the model has two sides.
bool has_sheets(const Model& model);

// The surfaces of a model are numbered: the walls in the deck's order, then the shapes of the bodies, then
// their meshes. All but the planes at rest are placed anew as time goes on; these have a second number, first
// those on bodies, then the walls.
class SurfaceSet {
 public:
  explicit SurfaceSet(const Model& model);
  Index ground() const { return ground_; }  // how many are walls
  Index placed() const { return static_cast<Index>(surfaces_.size()); }
  const Surface& at(Index placed) const { return surfaces_[static_cast<std::size_t>(placed)]; }
  Index number_of(Index placed) const {
    return placed < on_bodies_ ? ground_ + placed : walls_[static_cast<std::size_t>(placed - on_bodies_)];
  }
  // Of the mesh-th of a body's meshes: they stand behind the shapes of all bodies.
  static Index placed_mesh(const Model& model, int body, int mesh);
  bool is_on_body(Index placed) const { return placed < on_bodies_; }
  // How far past touch it is looked for where planes at rest are by `skin` [m].
  Real skin_of(Index placed, Real skin) const {
    const Surface& surface = at(placed);
    return surface.kind == SurfaceKind::mesh && surface.moves ? kMeshSkins * skin : skin;
  }
  // Bodies, and walls that are placed.
  std::size_t carriers() const { return carriers_; }
  // Whether nothing that carries them ever moves, nor do surfaces run along themselves.
  bool at_rest() const { return at_rest_; }

 private:
  Index ground_, on_bodies_ = 0;
  std::size_t carriers_;
  bool at_rest_;
  std::vector<Surface> surfaces_;
  std::vector<Index> walls_;
};

// Which surface an entry of a row is about.
struct SurfaceNumbers {
  const WallPlane* planes;
  Index ground;  // how many are walls

  SCREE_HD bool at_rest(Index number) const { return number < ground && planes[number].placed < 0; }
  SCREE_HD Index placed(Index number) const {
    return number < ground ? planes[number].placed : number - ground;
  }
};

// A placed surface where it is at one instant, as the items read it.
struct PlacedSurface {
  SurfaceKind kind;
  int material;
  Real radius;          // of a sphere [m]
  Vec3 point, normal;   // as in Surface, in the global frame
  Vec3 arm;             // of the point, from the body's centre [m]
  Vec3 velocity, spin;  // of the body [m/s], [rad/s]
  // Since the step began, where something asks for it: of the point [m], and of the body about its centre
  // [rad]. The point's is exact, so that nothing is left over of a surface that comes back.
  Vec3 travel, turn;
  Index frame = 0;  // of a plane or a mesh: its SurfaceFrame

  // Of the place on the body at `from_point` from the point.
  SCREE_HD Vec3 velocity_at(Vec3 from_point) const { return velocity + cross(spin, arm + from_point); }
  // A plane or a mesh that has turned since then.
  SCREE_HD bool turns() const { return kind != SurfaceKind::sphere && !(turn == Vec3{}); }
};

// How a placed plane or mesh is turned. Spheres have none.
struct SurfaceFrame {
  Mat3 axes;    // from the carrier's frame to the global one, now
  Mat3 before;  // the same where the step began
  Vec3 normal;  // of a plane, in the carrier's frame
  Index mesh;   // index into the meshes
  // Of a mesh: the periods along which it goes on past its ends, as the space does. There it has no images,
  // and particles are where they are beside its middle.
  Vec3 spanned{}, middle{};  // [m], the latter in the carrier's frame
  // From the surface's point to its middle, on the space's quanta: what is beside what is told by the middle,
  // as the point may be anywhere [m].
  Vec3 to_middle{};
  Vec3 slide{};  // velocity of a surface that runs along itself, in the carrier's frame [m/s]

  // How far the surface's material halfway along the path of a contact has come since, beside its point; the
  // contact's positions now and where the step began, each from the point then [m]. README.md, "Surfaces that
  // turn", says why. Exactly zero where nothing turns.
  SCREE_HD Vec3 travel_under(Vec3 now, Vec3 at_start) const {
    const Vec3 local = Real(0.5) * (transposed_times(axes, now) + transposed_times(before, at_start));
    return axes * local - before * local;
  }
  SCREE_HD bool runs() const { return !(slide == Vec3{}); }
  // The surface's own velocity in the middle of the step [m/s].
  SCREE_HD Vec3 middle_slide() const { return Real(0.5) * (axes * slide + before * slide); }
};

// A particle's place beside the mesh [m].
SCREE_HD Vec3 place_beside(const PlacedSurface& surface, const SurfaceFrame& frame, Vec3 p) {
  const Vec3 period = frame.spanned;
  if (period == Vec3{}) return p;
  ImageCount unused;
  return wrap(surface.point + frame.to_middle - Real(0.5) * period, period, p, unused);
}

// Calls visit(place) for all that this may be while the particle moves by less than the margin [m].
SCREE_HD_CALLER template <class Visit>
SCREE_HD void for_each_place_beside(const PlacedSurface& surface, const SurfaceFrame& frame, Vec3 p,
                                    Real margin, const Visit& visit) {
  const Vec3 period = frame.spanned, place = place_beside(surface, frame, p);
  visit(place);
  if (period == Vec3{}) return;
  const Vec3 from_middle = place - (surface.point + frame.to_middle);
  const auto beyond = [&](Real x, Real length) { return std::abs(x) > length / 2 + margin; };
  for_each_shift(period, [&](Vec3 shift, std::int8_t image) {
    const Vec3 x = from_middle + shift;
    if (image == kNoShift || (shift.x != 0 && beyond(x.x, period.x)) ||
        (shift.y != 0 && beyond(x.y, period.y)) || (shift.z != 0 && beyond(x.z, period.z)))
      return;
    visit(place + shift);
  });
}

// All placed surfaces at one instant; on the host.
struct SurfacePlaces {
  std::span<const PlacedSurface> placed;
  std::span<const SurfaceFrame> frames;
  std::span<const MeshView> meshes;
  std::span<const PlacedSurface> start{};  // where an implicit step began
};

// A sphere at p (x, y, z, radius) as it lies to a plane or sphere that is moved by `shift`.
struct SurfacePair {
  ContactGeometry geometry;
  // Where they touch, from the surface's point: on a sphere; at the particle's radius below its centre at a
  // plane, whose material there turns with a particle that sticks to it without slip [m].
  Vec3 contact;
};

SCREE_HD SurfacePair surface_pair(const PlacedSurface& surface, Vec3 shift, Vec4 p) {
  if (surface.kind == SurfaceKind::plane) {
    const Vec3 place = xyz(p) - shift;
    const ContactGeometry g = plane_pair(place, p.w, surface.point, surface.normal);
    return {g, place - p.w * g.direction - surface.point};
  }
  const ContactGeometry g = sphere_pair(xyz(p) - (surface.point + shift), p.w + surface.radius);
  return {g, surface.radius * g.normal()};
}

// Near which surfaces each particle is: a list of the same reach as the neighbour list. An entry stands in
// the row of its particle, ordered by surface and image.
struct SurfaceEntries {
  const Index* surfaces;      // per entry
  const std::int8_t* images;  // number of the shift of the surface, 13 for none
  const Index* particles;     // whose row it stands in
  const Index* by_surface;    // the entries with placed surfaces, surface by surface
};

}  // namespace scree
