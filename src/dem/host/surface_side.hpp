// The placed surfaces beside the particles of a backend: where they are, what their contacts sum to, what
// the bodies lose among each other. Few and small, they live on the host for every backend.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dem/host/body_contacts.hpp"
#include "dem/surfaces/surface_sums.hpp"
#include "dem/surfaces/surfaces.hpp"
#include "dem/surfaces/triangle_sums.hpp"
#include "model/data/body_exchange.hpp"
#include "model/data/model.hpp"
#include "partition/ranks.hpp"
#include "partition/subdomain.hpp"

namespace scree {

// Of the contacts of bodies with each other and with surfaces.
struct ShapeLosses {
  Real contact_loss = 0;     // dissipated since t = 0 [J]
  Real loss_power = 0;       // the same at t_n, with velocity-Verlet where nothing rubs [W]
  Real integrator_loss = 0;  // taken out by HHT since t = 0 [J]
  RubbingLosses rubbing{};   // of contact_loss
};

// Of the shapes of all bodies.
struct ShapePack {
  std::vector<int> body;
  std::vector<Real> radius;
  std::vector<Vec3> position, velocity, force;
  std::vector<int> contacts;
};

class SurfaceSide {
 public:
  SurfaceSide(const Model& model, const Subdomain& subdomain, const Ranks& ranks);

  const SurfaceSet& surfaces() const { return surfaces_; }
  Index size() const { return surfaces_.placed(); }
  // Of the carriers: the bodies, then the placed walls.
  void set_motion(std::span<const BodyMotion> motion) { motion_.assign(motion.begin(), motion.end()); }
  // When a list is built: brings each surface into the periodic box, where it stays until the next one.
  // Before, the surfaces are placed where the bodies are.
  void bring_into_box();
  // What bodies can touch, until a surface has moved by half the skin.
  void build_list(Real skin);
  // Moves the surfaces to where the bodies are; returns how much of the list that takes, as the displacement
  // of a particle that takes as much [m].
  Real place();
  // One entry per placed surface.
  const std::vector<PlacedSurface>& placed() const { return placed_; }
  const std::vector<SurfaceFrame>& frames() const { return frames_; }
  SurfacePlaces places() const { return {placed_, frames_, meshes_, start_}; }
  // By the last place(): displacements, and turns: of spheres, for laws that move, times the radii [m], of
  // others as they are [rad].
  const std::vector<Vec3>& step() const { return step_; }
  const std::vector<Vec3>& step_turn() const { return step_turn_; }

  // Steps of laws that move see how far the surfaces have come since the last one was closed, where they were
  // then. An explicit one may be opened again, for the surfaces where they are now: it then began where it
  // did.
  void close_step();
  void reopen_step();

  // Start of an implicit step, to look back at.
  void keep_start();
  // Of any place on a surface since then [m].
  Real step_displacement() const { return displacement_since(start_, start_axes_, 1); }
  // Since the list was built, as place() counts [m].
  Real list_displacement() const { return displacement_since(listed_, listed_axes_, kMeshWear); }

  // What touches the surfaces at an instant (h = 0) or over the explicit step that ends now, and over an
  // implicit step: the backend hands over what its particles do, in any order and a surface in any number of
  // parts; rank 0 adds what the bodies' shapes do.
  void take_loads(std::span<const InstantSums> of_particles, Real h);
  void take_steps(std::span<const StepSums> of_particles, Real h);

  // reduce_wrench: brings the sums of all ranks to rank 0, one message per rank, and adds them up to the
  // contact wrenches on the bodies for the step and at its end, or at an instant; on other ranks they come
  // out as zero. Collective.
  void reduce(ContactWrenches& step, std::vector<BodyWrench>& end) const;
  void reduce(std::vector<BodyWrench>& end) const;
  // contacts: of particles, per carrier.
  void reduce(std::vector<BodyWrench>& end, std::vector<std::int64_t>& contacts) const;

  // Of the bodies' shapes. book_losses: of an explicit step of length h from the last loads, like the
  // particles', by the trapezoidal rule unless contacts rub; book_step: of an implicit step, which is
  // accepted, from the last take_steps().
  void book_losses(Real h);
  void book_step();
  const ShapeLosses& losses() const { return losses_; }
  BodyContactTotals shape_totals() const { return bodies_.totals(); }  // at the last take_loads()
  // Of a state, on rank 0: what shapes have lost; of what their contacts remember, and of works, there is
  // none yet.
  void load(const ShapeLosses& losses);
  // What shapes' contacts remember, on rank 0; load: before the first list.
  void load_contacts(const ShapeContacts& contacts) { bodies_.load(contacts); }
  ShapeContacts shape_contacts();

  // From the last take_loads(). Collective; complete on rank 0.
  std::vector<ContactSum> carrier_contacts() const;  // bodies, then placed walls
  std::vector<ContactSum> surface_contacts() const;  // of surfaces()
  ShapePack pack() const;                            // of the spheres
  ContactSum on_wall(int wall) { return bodies_.on_wall(wall); }
  // Of the bodies' shapes, on rank 0.
  std::vector<ContactLine> contact_lines();
  // Of all ranks' particles, and of shapes, ordered by surface and triangle. Collective; complete on rank 0.
  std::vector<TriangleLoad> triangle_loads(std::vector<TriangleSums> contacts) const;
  // Adds what shapes have lost at the triangles to the words of TriangleWorks; on rank 0.
  void add_works(std::vector<std::int64_t>& words) const;

 private:
  // Of its point, on the grid of the periodic box, but with the body, however far that has gone [m].
  Vec3 point_with(const std::vector<BodyMotion>& motion, Index surface) const;
  Vec3 to_middle(Index surface) const;  // SurfaceFrame::to_middle, of a mesh
  // Of any place on a surface, on meshes times of_mesh [m].
  // moved: of the surfaces' points; from: the axes of the frames before.
  Real largest_displacement(std::span<const Vec3> moved, std::span<const Mat3> from, Real of_mesh) const;
  Real displacement_since(const std::vector<PlacedSurface>& then, const std::vector<Mat3>& axes,
                          Real of_mesh) const;
  Real displacement_of(const PlacedSurface& surface, Vec3 moved, const Mat3& from) const;
  std::vector<Mat3> axes() const;  // of the frames
  void begin_step();
  void turn_frames();
  void span(const Surface& surface, SurfaceFrame& frame) const;
  // Whether something asks how far the surfaces have come since a step began.
  bool keeps_travel() const { return model_.rotates() || !frames_.empty(); }
  template <class Where>
  std::vector<ContactSum> contacts_of(std::size_t count, const Where& where) const;
  template <class Sums>
  std::vector<Sums> merged(std::vector<Sums> sums) const;

  const Model& model_;
  const Subdomain& subdomain_;
  Ranks ranks_;
  SurfaceSet surfaces_;
  BodyContacts bodies_;
  // Of the carriers as last set, where the explicit step began, and the one before it.
  std::vector<BodyMotion> motion_, step_start_, start_before_;
  std::vector<ImageCount> image_;  // of each surface's middle when it was brought into the box
  std::vector<PlacedSurface> placed_, start_, listed_;
  std::vector<MeshView> meshes_;
  std::vector<MeshBox> boxes_;  // of the meshes
  std::vector<SurfaceFrame> frames_;
  std::vector<Mat3> start_axes_, listed_axes_;
  std::vector<Vec3> step_, step_turn_;
  std::vector<InstantSums> loads_;  // of particles, then of shapes
  std::size_t particle_loads_ = 0;  // of these
  std::vector<StepSums> steps_;
  ShapeLosses losses_;
};

}  // namespace scree
