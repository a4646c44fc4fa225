// Placed surfaces of a backend: poses, contact sums, and the energy accounting of bodies' contacts. They are
// few and are kept on the host by every backend.
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

// Losses of the contacts of bodies with each other and with surfaces.
struct ShapeLosses {
  Real contact_loss = 0;          // dissipated since t = 0 [J]
  Real loss_power = 0;            // current dissipation, for velocity Verlet without friction [W]
  Real integrator_loss = 0;       // taken out by HHT since t = 0 [J]
  TangentialLosses tangential{};  // parts of contact_loss
};

// Output of the shapes of all bodies.
struct ShapePack {
  std::vector<int> body;
  std::vector<Real> radius;
  std::vector<Vec3> position, velocity, force;
  std::vector<int> contacts;
};

class HostSurfaces {
 public:
  HostSurfaces(const Model& model, const Subdomain& subdomain, const Ranks& ranks);

  const SurfaceSet& surfaces() const { return surfaces_; }
  Index size() const { return surfaces_.placed(); }
  // Motion of the parents: the bodies, then the placed walls.
  void set_motion(std::span<const BodyMotion> motion) { motion_.assign(motion.begin(), motion.end()); }
  const std::vector<BodyMotion>& motion() const { return motion_; }
  // Chooses the periodic image of each surface for a new list. Called before update_poses().
  void bring_into_box();
  // Before a list with this skin is built: how far each moving mesh shall be able to move before it expires.
  // If particles have moved by at most `moved` since the last list, a mesh shall last as long as they;
  // kNoMotion: nothing is known. Called before bring_into_box().
  static constexpr Real kNoMotion = -1;
  void plan_list(Real skin, Real moved);
  // Finds possible contacts of bodies until a surface has moved by half the skin and its extra travel.
  void build_list(Real skin);
  // Updates the poses to the motion of the parents.
  void update_poses();
  // Largest displacement by the last update_poses(), weighted such that it counts as a particle's
  // displacement for the list [m].
  Real last_displacement() const;
  // One entry per placed surface.
  const std::vector<SurfacePose>& placed() const { return placed_; }
  const std::vector<SurfaceFrame>& frames() const { return frames_; }
  SurfacePoses poses() const { return {placed_, frames_, meshes_, start_, extra_travel_, free_bodies_}; }
  // Changes by the last update_poses(): displacements, and rotations; of spheres, for laws with
  // `kNeedsMotion`, times the radii [m], else [rad].
  const std::vector<Vec3>& step() const { return step_; }
  const std::vector<Vec3>& step_rotation() const { return step_rotation_; }

  // Laws with `kNeedsMotion` use the displacements of the surfaces since the last step was closed.
  // reopen_step(): reopens the last explicit step from its start to the current poses.
  void close_step();
  void reopen_step();
  // For walls alone: returns to the end of an earlier explicit step, at which the parents had this motion.
  void return_to(std::span<const BodyMotion> motion);

  // Stores the start of an implicit step.
  void store_start();
  // Largest displacement of any point of a surface since then [m].
  Real step_displacement() const { return displacement_since(start_, start_axes_, Weight::one); }
  // Largest displacement since the list was built, weighted as in last_displacement() [m].
  Real list_displacement() const { return displacement_since(listed_, listed_axes_, Weight::of_list); }

  // Takes the contact sums of the backend's particles at an instant (h = 0) or over the explicit step that
  // ends now, and over an implicit step, in any order and in any number of parts per surface; rank 0 adds the
  // contacts of bodies' shapes.
  void take_loads(std::span<const InstantSums> of_particles, Real h) {
    find_shape_loads(h), take_particle_loads(of_particles);
  }
  // The same in two parts, for a backend that evaluates the particles' contacts meanwhile.
  void find_shape_loads(Real h);
  void take_particle_loads(std::span<const InstantSums> sums);
  void take_steps(std::span<const StepSums> of_particles, Real h);

  // Stage reduce_wrench: gathers the sums of all ranks on rank 0, one message per rank, and adds them up to
  // the contact wrenches on the bodies: for the step and at its end, or at an instant. Zero on other ranks.
  // Collective.
  void reduce(ContactWrenches& step, std::vector<BodyWrench>& end) const;
  void reduce(std::vector<BodyWrench>& end) const;
  // contacts: of particles, per parent.
  void reduce(std::vector<BodyWrench>& end, std::vector<std::int64_t>& contacts) const;

  // Energy accounting of bodies' shapes. accumulate_losses(): over an explicit step of length h from the last
  // loads, by the trapezoidal rule without friction, like the particles'; book_step(): over an accepted
  // implicit step, from the last take_steps().
  void accumulate_losses(Real h);
  void book_step();
  const ShapeLosses& losses() const { return losses_; }
  BodyContactTotals shape_totals() const { return bodies_.totals(); }  // at the last take_loads()
  // Loads the losses of a state, on rank 0, and clears contact history and works.
  void load(const ShapeLosses& losses);
  // Packed history of the shapes' contacts, on rank 0; load_contacts(): before the first list.
  void load_contacts(const ShapeContacts& contacts) { bodies_.load(contacts); }
  ShapeContacts shape_contacts();

  // From the last take_loads(). Collective; complete on rank 0.
  std::vector<ContactSum> parent_contacts() const;   // bodies, then placed walls
  std::vector<ContactSum> surface_contacts() const;  // of surfaces()
  ShapePack pack() const;                            // of the spheres
  ContactSum on_wall(int wall) { return bodies_.on_wall(wall); }
  // Contacts of the bodies' shapes, on rank 0.
  std::vector<ContactLine> contact_lines();
  // Loads of all ranks' particles and of shapes, ordered by surface and triangle. Collective; complete on
  // rank 0.
  std::vector<TriangleLoad> triangle_loads(std::vector<TriangleSums> contacts) const;
  // Adds the work of shapes' contacts at the triangles to the limbs of TriangleWorks; on rank 0.
  void add_works(std::vector<std::int64_t>& words) const;

 private:
  // Position of a surface's point, on the grid of the periodic domain, but unwrapped like its body's [m].
  Vec3 point_with(const std::vector<BodyMotion>& motion, Index surface) const;
  Vec3 to_middle(Index surface) const;  // SurfaceFrame::to_middle of a mesh
  // of_list: a displacement that uses up a surface's share of the list counts as half the skin.
  enum class Weight { one, of_list };
  // Largest displacement of any point of a surface [m]. moved: displacements of the surfaces' points; from:
  // previous axes of the frames.
  Real largest_displacement(std::span<const Vec3> moved, std::span<const Mat3> from, Weight weight) const;
  Real displacement_since(const std::vector<SurfacePose>& then, const std::vector<Mat3>& axes,
                          Weight weight) const;
  Real weight_in_list(std::size_t s) const;
  Real extra_travel_for(Index s, Real skin, Real moved) const;
  Real displacement_of(const SurfacePose& surface, Vec3 moved, const Mat3& from) const;
  std::vector<Mat3> axes() const;  // of the frames
  void begin_step();
  void rotate_parents();
  void rotate_frames();
  void find_free_bodies();
  void span(const Surface& surface, SurfaceFrame& frame) const;
  // Whether displacements since the start of a step are needed.
  bool tracks_displacement() const { return model_.rotates() || !frames_.empty(); }
  template <class Where>
  std::vector<ContactSum> contacts_of(std::size_t count, const Where& where) const;

  const Model& model_;
  const Subdomain& subdomain_;
  Ranks ranks_;
  SurfaceSet surfaces_;
  BodyContacts bodies_;
  // Motion of the parents: current, at the start of the explicit step, and at the start of the previous one.
  std::vector<BodyMotion> motion_, step_start_, start_before_;
  std::vector<ImageCount> image_;  // image of each surface's middle for the current list
  std::vector<SurfacePose> placed_, start_, listed_;
  std::vector<Real> extra_travel_;  // SurfacePoses::extra_travel
  Real skin_ = 0;                   // of the list [m]
  std::vector<MeshView> meshes_;
  std::vector<MeshBox> boxes_;  // bounding boxes of the meshes
  std::vector<SurfaceFrame> frames_;
  std::vector<Mat3> start_axes_, listed_axes_, axes_before_;  // axes_before_: before the last update_poses()
  struct ParentRotation {
    Mat3 axes, start_axes;  // of the parent's frame, now and at the start of the step
    Vec3 spin, turn;        // [rad/s], since the start of the step [rad]
  };
  std::vector<ParentRotation> rotations_;
  std::vector<FreeBody> free_bodies_;   // SurfacePoses::free_bodies
  std::vector<Sym3> inverse_inertias_;  // of the bodies, in their frames [1/(kg m^2)]
  std::vector<bool> has_axes_;          // per parent: spatial, or with surfaces other than spheres
  std::vector<Vec3> step_, step_rotation_;
  std::vector<InstantSums> loads_;  // of particles, then of shapes
  std::size_t particle_loads_ = 0;  // number of the particles' sums in loads_
  std::vector<StepSums> steps_;
  ShapeLosses losses_;
};

}  // namespace scree
