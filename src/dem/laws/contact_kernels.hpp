// Contact stages for the law of a run, which is chosen once: the loops inside are monomorphic.
#pragma once

#include <memory>
#include <vector>

#include "dem/contact/contact_items.hpp"
#include "dem/contact/system_items.hpp"
#include "dem/implicit/step_items.hpp"
#include "dem/reports/contact_line_items.hpp"
#include "dem/reports/escape_items.hpp"
#include "dem/reports/output_fields.hpp"
#include "dem/search/pair_list.hpp"
#include "dem/surface_contact/body_items.hpp"
#include "dem/surface_contact/friction_surfaces.hpp"
#include "dem/surface_contact/surface_items.hpp"
#include "dem/surface_contact/wall_items.hpp"
#include "model/data/model.hpp"
#include "partition/ranks.hpp"

namespace scree {

// Degrees of freedom of a particle in implicit steps with this law; 0: there are none.
template <class Law>
inline constexpr int kStepFreedoms = !Law::kNeedsMotion       ? 3
                                     : kHasFrictionSteps<Law> ? 6
                                                              : 0;

// Forces and Newton matrix of the particles over an implicit step. With three degrees of freedom the
// particles do not rotate: the last three members are not used, nor is `start` but for `start.step`.
struct StepSystem {
  Vec3 gravity;
  NewtonWeights weights;
  FrictionStart start;
  StepForces forces;
  ContactMatrix matrix;  // with three degrees of freedom
  StepTorques torques;
  FrictionMatrix friction_matrix;
  Real* phase_squared;
};

// Contacts with surfaces over an implicit step, per entry, with three or with six degrees of freedom.
struct SurfaceStepsTo {
  SurfaceStep* steps;
  SurfaceFriction* friction_steps;
};

class ContactKernels {
 public:
  virtual ~ContactKernels() = default;
  virtual int history() const = 0;  // numbers of history per contact
  virtual bool rolls() const = 0;   // whether the law's type has rolling resistance
  virtual void forces(const ContactViews<PackedRows>& in, Vec3 gravity, Index n, Vec3* force,
                      Real* loss_power, Vec3* angular_acceleration) const = 0;
  // Closes an explicit step of all n owned particles; pairs: of the list, with their history, for laws with
  // `kNeedsMotion`. Returns the square of the largest acceleration; a NaN if one is not finite.
  virtual Real verlet_finish(const ContactViews<PackedRows>& in, PairList& pairs, Vec3 gravity, Index n,
                             const VerletViews& state, Vec3* force) = 0;
  // Closes an explicit step and opens the next. Returns the square of the largest displacement.
  virtual Real verlet_advance(const ContactViews<PackedRows>& in, PairList& pairs, Vec3 gravity, Index n,
                              const VerletViews& state) = 0;
  // Writes the pairs' history back to the slots, for laws with `kNeedsMotion`.
  virtual void return_records(PairList& pairs, const HistoryViews& history) const = 0;
  // Contacts of n entries of particles with surfaces on bodies, at an instant and over an implicit step.
  virtual void surface_loads(const SurfaceViews& in, Index n, SurfaceLoad* loads) const = 0;
  virtual void surface_steps(const SurfaceViews& in, Index n, const FrictionStart& start,
                             const SurfacePose* start_surface_poses, const SurfaceStepsTo& to) const = 0;
  // Contacts of n shapes of bodies with each other and with surfaces: at an instant or over an explicit step,
  // and over an implicit one. The history of a step is stored.
  virtual void body_loads(const ContactViews<PackedRows>& in, Index n, const BodyQuery& query,
                          BodyLoad* out) const = 0;
  virtual void body_steps(const ContactViews<PackedRows>& in, Index n, const FrictionStart& start,
                          const Vec3* arm, BodyStep* out, const ShapeContactsTo& to) const = 0;
  // Sums of the first n `WallContactItem`, over all ranks.
  virtual void wall_sums(const ContactViews<PackedRows>& in, Index n, const WallChoice& choice,
                         const Ranks& ranks, Real (&sums)[kWallTerms]) const = 0;
  virtual void energies(const ContactViews<PackedRows>& in, Index n, const EnergyOutputs& out) const = 0;
  // Output field that reads contacts.
  virtual void output(const ContactViews<PackedRows>& in, const OutputRequest& request) const = 0;
  // Output of the contacts in `loads` of n entries with placed surfaces; and the first n `ContactLineItem`.
  virtual void shown_surfaces(const SurfaceViews& in, Index n, const SurfaceLoad* loads,
                              ShownContact* shown) const = 0;
  virtual void contact_lines(const ContactViews<PackedRows>& in, Index n,
                             const LineRequest& request) const = 0;
  // Implicit steps: system, energy accounting of an accepted step, with the friction where particles rotate,
  // and the friction limits at an iterate.
  virtual void system(const ContactViews<PackedRows>& in, Index n, const StepSystem& request) const = 0;
  virtual void step_losses(const ContactViews<PackedRows>& in, Index n, const FrictionStart& start,
                           const FrictionLossOutputs& to) const = 0;
  virtual void store_lagged_limits(const ContactViews<PackedRows>& in, Index n, const FrictionStart& start,
                                   const LaggedLimits& to) const = 0;
  // n escaped particles, and the removal of their contacts from all others: see the items.
  virtual void escaped_particles(const ContactViews<PackedRows>& in, const OpenBox& box, Index n,
                                 EscapedParticle* escaped_particles) const = 0;
  virtual void departures(const ContactViews<PackedRows>& in, Vec3 gravity, const OpenBox& box, Index n,
                          const StartViews& start) const = 0;
};

// Contact stages of one type of law on the CPU, for the laws of all pairs of `materials`. Each type is
// compiled in a source file of its own, which is generated from law.cpp.in.
template <class Law>
std::unique_ptr<ContactKernels> cpu_kernels(const std::vector<Law>& laws, int materials);

std::unique_ptr<ContactKernels> make_contact_kernels(const Contact& contact);

// Contact lines of the first counts.size() items, one item after the other; counts: receives the number of
// each. to: a request without output pointers.
std::vector<ContactLine> contact_lines(const ContactKernels& kernels, const ContactViews<PackedRows>& in,
                                       LineRequest to, std::vector<Index>& counts);

}  // namespace scree
