// Surfaces in contact with particles, in the frame of their parent: the ground or a body.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "base/hd.hpp"
#include "base/spatial_velocity.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "mesh/mesh_view.hpp"
#include "model/data/body_exchange.hpp"
#include "model/data/model.hpp"
#include "partition/halo_plan.hpp"
#include "partition/subdomain.hpp"
#include "physics/contact_geometry.hpp"

namespace scree {

enum class SurfaceKind : int { plane, sphere, mesh };  // discs are spheres with centres in one plane

// Constant description of a surface other than a static plane.
struct Surface {
  SurfaceKind kind;
  int parent;  // index into Model::bodies; after these the walls of SurfaceSet, one after the other
  int material;
  Vec3 point;    // of a plane, centre of a sphere, origin of a mesh; in the parent's frame [m]
  Vec3 normal;   // of a plane: unit vector into its free side
  Real radius;   // of a sphere [m]
  int mesh = 0;  // of a mesh: index into Model::meshes
  bool moves = true;
};

// Search distance beyond touch of moving meshes over that of other surfaces, as long as their speed is not
// known: vertices of a mesh may move far while particles hardly move, and rows of triangles are cheap
// compared with a new list.
inline constexpr Real kMeshSkins = 2;

// A wall for the kernels; complete for a static plane. placed: number of another wall among the placed
// surfaces, else -1.
struct WallPlane {
  Vec3 point, normal;
  int material;
  Index placed = -1;
};
std::vector<WallPlane> wall_planes(const Model& model);
// Whether the model has open (two-sided) meshes.
bool has_open_surfaces(const Model& model);

// Numbering of a model's surfaces: the walls in the deck's order, then the shapes of the bodies, then their
// meshes. All but static planes are placed surfaces, whose poses may change; these have a second number,
// first those on bodies, then the walls.
class SurfaceSet {
 public:
  explicit SurfaceSet(const Model& model);
  Index ground() const { return ground_; }  // number of walls
  Index placed() const { return static_cast<Index>(surfaces_.size()); }
  const Surface& at(Index placed) const { return surfaces_[static_cast<std::size_t>(placed)]; }
  Index number_of(Index placed) const {
    return placed < on_bodies_ ? ground_ + placed : walls_[static_cast<std::size_t>(placed - on_bodies_)];
  }
  // Number among the placed surfaces of a body's mesh; meshes come after the shapes of all bodies.
  static Index posed_mesh(const Model& model, int body, int mesh);
  bool is_on_body(Index placed) const { return placed < on_bodies_; }
  // Number of bodies and placed walls.
  std::size_t parents() const { return parents_; }
  // Whether no placed surface ever moves or is a conveyor.
  bool is_static() const { return all_static_; }

 private:
  Index ground_, on_bodies_ = 0;
  std::size_t parents_;
  bool all_static_;
  std::vector<Surface> surfaces_;
  std::vector<Index> walls_;
};

// Maps the surface number of an entry to a plane or a placed surface.
struct SurfaceNumbers {
  const WallPlane* planes;
  Index ground;  // number of walls

  SCREE_HD bool is_static(Index number) const { return number < ground && planes[number].placed < 0; }
  SCREE_HD Index placed(Index number) const {
    return number < ground ? planes[number].placed : number - ground;
  }
};

// Pose and motion of a placed surface at one instant, for the kernels.
struct SurfacePose {
  SurfaceKind kind;
  int material;
  Real radius;          // of a sphere [m]
  Vec3 point, normal;   // as in `Surface`, in the global frame
  Vec3 arm;             // from the body's centre to the point [m]
  Vec3 velocity, spin;  // of the body [m/s], [rad/s]
  // Since the start of the step, where needed: displacement of the point [m], and rotation of the body about
  // its centre [rad]. The displacement is exact, so that it cancels for a surface that returns.
  Vec3 displacement, turn;
  Index frame = 0;  // of a plane or a mesh: index of its SurfaceFrame

  // Velocity of a point of the body; from_point: relative to the surface's point.
  SCREE_HD Vec3 velocity_at(Vec3 from_point) const { return velocity + cross(spin, arm + from_point); }
  // Whether it is a plane or a mesh that has rotated since the start of the step.
  SCREE_HD bool turns() const { return kind != SurfaceKind::sphere && !(turn == Vec3{}); }
};

// Inertia of the body of a placed surface at one instant; zero for walls, which nothing moves. Joints do not
// count: the body is as free as if it had none.
struct FreeBody {
  Vec3 inverse_mass;     // along x, y and z [1/kg]; a planar body does not leave its plane
  Sym3 inverse_inertia;  // J^-1 about its centre, in the global frame [1/(kg m^2)]

  // The parts of its inverse effective mass for a force along the unit vector n [1/kg]. arm: of any point of
  // the force's line from the centre [m].
  SCREE_HD Real translation(Vec3 n) const {
    return inverse_mass.x * n.x * n.x + inverse_mass.y * n.y * n.y + inverse_mass.z * n.z * n.z;
  }
  SCREE_HD Real rotation(Vec3 arm, Vec3 n) const {
    const Vec3 moment = cross(arm, n);
    return dot(moment, inverse_inertia * moment);
  }
  // `translation()` less that of the whole mass, for laws that have the mass: zero but for planar bodies. Two
  // partners that cannot move along n keep a finite effective mass.
  SCREE_HD Real held(Vec3 n) const {
    constexpr Real kMost = 1 - 1e-9;
    return kMost * (inverse_mass.z - inverse_mass.x) * n.z * n.z;
  }
};

// A shape of a body, or a corner of its mesh, as an item. arm: of its centre from the body's [m].
struct FreeShape {
  Vec3 arm;
  FreeBody body;

  // What the body's motion adds to its inverse mass for a force through the centre of the shape [1/kg].
  SCREE_HD Real beside_mass(Vec3 n) const { return body.rotation(arm, n) + body.held(n); }
};

// Orientation of a placed plane or mesh. Spheres have none.
struct SurfaceFrame {
  Mat3 axes;    // rotation from the parent's frame to the global one, now
  Mat3 before;  // the rotation at the start of the step
  Vec3 normal;  // of a plane, in the parent's frame
  Index mesh;   // index into the meshes
  // spanned: periods that a mesh spans, through whose sides it continues. Along these it has no images, and
  // the particles' images nearest to its middle are used.
  Vec3 spanned{}, middle{};  // [m]; middle: in the parent's frame
  // From the surface's point to the mesh's middle, in quanta of the domain [m]. Images are chosen by the
  // middle, because the point may be anywhere.
  Vec3 to_middle{};
  Vec3 surface_velocity{};  // conveyor velocity, in the parent's frame [m/s]

  // Displacement, relative to the surface's point, of the material halfway along the path of a contact since
  // the start of the step [m]; arguments: the contact's positions now and then, each from the point at that
  // time. Exactly zero without rotation. See dem/README.md.
  SCREE_HD Vec3 material_displacement(Vec3 now, Vec3 at_start) const {
    const Vec3 local = Real(0.5) * (transposed_times(axes, now) + transposed_times(before, at_start));
    return axes * local - before * local;
  }
  SCREE_HD bool is_conveyor() const { return !(surface_velocity == Vec3{}); }
  // Conveyor velocity at mid-step [m/s].
  SCREE_HD Vec3 middle_surface_velocity() const {
    return Real(0.5) * (axes * surface_velocity + before * surface_velocity);
  }
};

// Image of a particle's position nearest to the mesh's middle, along the periods that it spans [m].
SCREE_HD Vec3 nearest_image(const SurfacePose& surface, const SurfaceFrame& frame, Vec3 p) {
  const Vec3 period = frame.spanned;
  if (period == Vec3{}) return p;
  ImageCount unused;
  return wrap(surface.point + frame.to_middle - Real(0.5) * period, period, p, unused);
}

// Calls visit(position) for all images that may become the nearest while the particle moves by less than the
// margin [m].
SCREE_HD_CALLER template <class Visit>
SCREE_HD void for_each_near_image(const SurfacePose& surface, const SurfaceFrame& frame, Vec3 p, Real margin,
                                  const Visit& visit) {
  const Vec3 period = frame.spanned, position = nearest_image(surface, frame, p);
  visit(position);
  if (period == Vec3{}) return;
  const Vec3 from_middle = position - (surface.point + frame.to_middle);
  const auto beyond = [&](Real x, Real length) { return std::abs(x) > length / 2 + margin; };
  for_each_shift(period, [&](Vec3 shift, std::int8_t image) {
    const Vec3 x = from_middle + shift;
    if (image == kZeroShift || (shift.x != 0 && beyond(x.x, period.x)) ||
        (shift.y != 0 && beyond(x.y, period.y)) || (shift.z != 0 && beyond(x.z, period.z)))
      return;
    visit(position + shift);
  });
}

// All placed surfaces at one instant; on the host.
struct SurfacePoses {
  std::span<const SurfacePose> placed;
  std::span<const SurfaceFrame> frames;
  std::span<const MeshView> meshes;
  std::span<const SurfacePose> start{};  // at the start of an implicit step
  // Per placed surface: how much farther than a particle it may move before the list expires; empty: no
  // farther [m].
  std::span<const Real> extra_travel{};
  // Per placed surface; empty where no law depends on masses, or there are no bodies.
  std::span<const FreeBody> free_bodies{};

  // Search distance beyond touch of a placed surface; skin: that of static planes [m].
  Real skin_of(Index s, Real skin) const {
    return extra_travel.empty() ? skin : skin + extra_travel[static_cast<std::size_t>(s)];
  }
  Real most_extra_travel() const {
    return extra_travel.empty() ? 0 : *std::max_element(extra_travel.begin(), extra_travel.end());
  }
};

// A sphere at p (x, y, z, radius) and a plane or sphere shifted by `shift`.
struct SurfacePair {
  ContactGeometry geometry;
  // Contact point from the surface's point [m]: on a sphere; at a plane one particle radius below the centre,
  // where its material rotates with a particle that sticks to it without slip.
  Vec3 contact;
};

SCREE_HD SurfacePair surface_pair(const SurfacePose& surface, Vec3 shift, Vec4 p) {
  if (surface.kind == SurfaceKind::plane) {
    const Vec3 position = xyz(p) - shift;
    const ContactGeometry g = plane_pair(position, p.w, surface.point, surface.normal);
    return {g, position - p.w * g.direction - surface.point};
  }
  const ContactGeometry g = sphere_pair(xyz(p) - (surface.point + shift), p.w + surface.radius);
  return {g, surface.radius * g.normal()};
}

// Neighbour list of particles and surfaces, with the range of the particles' list. Entries are grouped by
// particle, and ordered by surface and image within a row.
struct SurfaceEntries {
  const Index* surfaces;      // per entry
  const std::int8_t* images;  // number of the surface's shift, 13 for none
  const Index* particles;     // particle of the entry's row
  const Index* by_surface;    // entries with placed surfaces, ordered by surface
};

}  // namespace scree
