// The contact stages for the law of this run, chosen once: loops over items are monomorphic inside.
#pragma once

#include <memory>
#include <vector>

#include "dem/contact/contact_items.hpp"
#include "dem/contact/system_items.hpp"
#include "dem/implicit/step_items.hpp"
#include "dem/reports/contact_line_items.hpp"
#include "dem/reports/leaver_items.hpp"
#include "dem/reports/output_fields.hpp"
#include "dem/search/pair_list.hpp"
#include "dem/surface_contact/body_items.hpp"
#include "dem/surface_contact/rubbing_surfaces.hpp"
#include "dem/surface_contact/surface_items.hpp"
#include "dem/surface_contact/wall_items.hpp"
#include "model/data/model.hpp"
#include "partition/ranks.hpp"

namespace scree {

// Force, torque and Newton matrix of particles over an implicit step in which contacts rub.
struct RubbingRequest {
  Vec3 gravity;
  NewtonWeights weights;
  RubbingStart start;
  StepForces forces;
  StepTorques torques;
  RubbingMatrix matrix;
  Real* sharpness;
};

class ContactKernels {
 public:
  virtual ~ContactKernels() = default;
  virtual int history() const = 0;  // how many numbers the law remembers of a contact
  virtual void forces(const ContactViews<PackedRows>& in, Vec3 gravity, Index n, Vec3* force,
                      Real* loss_power, Vec3* angular_acceleration) const = 0;
  // Of all n owned particles; pairs: of the list, where the law moves, with what they remember. The square of
  // the largest acceleration; a NaN if one is not finite.
  virtual Real verlet_finish(const ContactViews<PackedRows>& in, PairList& pairs, Vec3 gravity, Index n,
                             const VerletViews& state, Vec3* force) = 0;
  // The square of the largest displacement.
  virtual Real verlet_advance(const ContactViews<PackedRows>& in, PairList& pairs, Vec3 gravity, Index n,
                              const VerletViews& state) = 0;
  // Where the law moves: what the pairs keep goes back to the slots.
  virtual void leave_records(PairList& pairs, const HistoryViews& history) const = 0;
  virtual void system(const ContactViews<PackedRows>& in, Vec3 gravity, Index n, NewtonWeights weights,
                      const StepStart& start, const StepForces& out, const ContactMatrix& matrix) const = 0;
  // n entries of particles with surfaces on bodies, at an instant and over an implicit step.
  virtual void surface_loads(const SurfaceViews& in, Index n, SurfaceLoad* loads) const = 0;
  virtual void surface_steps(const SurfaceViews& in, Index n, const StepStart& start,
                             const PlacedSurface* start_placed, SurfaceStep* steps) const = 0;
  // The shapes of bodies as items: what n of them get from each other and from surfaces, at an instant or
  // over an explicit step, and over an implicit one, without friction and with it. A step is accepted.
  virtual void body_loads(const ContactViews<PackedRows>& in, Index n, const BodyLook& look,
                          BodyLoad* out) const = 0;
  virtual void body_steps(const ContactViews<PackedRows>& in, Index n, const StepStart& start,
                          const Vec3* arm, BodyStep* out, const ShapeContactsTo& to) const = 0;
  virtual void body_rubs(const ContactViews<PackedRows>& in, Index n, const RubbingStart& start,
                         const Vec3* arm, BodyStep* out, const ShapeContactsTo& to) const = 0;
  // Of the first n items of WallContactItem, over all ranks.
  virtual void wall_sums(const ContactViews<PackedRows>& in, Index n, const WallChoice& choice,
                         const Ranks& ranks, Real (&sums)[kWallTerms]) const = 0;
  virtual void energies(const ContactViews<PackedRows>& in, Index n, const EnergyOutputs& out) const = 0;
  // An output field that reads contacts.
  virtual void output(const ContactViews<PackedRows>& in, const OutputRequest& request) const = 0;
  // Of n entries of particles with placed surfaces what is shown of the contacts, which are in `loads`; and
  // the first n items of ContactLineItem.
  virtual void shown_surfaces(const SurfaceViews& in, Index n, const SurfaceLoad* loads,
                              ShownContact* shown) const = 0;
  virtual void contact_lines(const ContactViews<PackedRows>& in, Index n,
                             const LineRequest& request) const = 0;
  // What the contacts of the particles add to the ledger over an accepted implicit step.
  virtual void books(const ContactViews<PackedRows>& in, Index n, const StepStart& start, Real* contact_loss,
                     Real* integrator_loss) const = 0;
  // The same where contacts rub, for laws of which kFrictionAlone holds; and the limits at an iterate. rubs:
  // per entry, of which n are with surfaces on bodies.
  virtual void surface_rubs(const SurfaceViews& in, Index n, const RubbingStart& start,
                            const PlacedSurface* start_placed, SurfaceRub* rubs) const = 0;
  virtual void rubbing_system(const ContactViews<PackedRows>& in, Index n,
                              const RubbingRequest& request) const = 0;
  virtual void rubbing_books(const ContactViews<PackedRows>& in, Index n, const RubbingStart& start,
                             const RubbingBooksTo& to) const = 0;
  virtual void freeze(const ContactViews<PackedRows>& in, Index n, const RubbingStart& start,
                      const FrozenLimits& to) const = 0;
  // n particles that leave, and what they leave to all others: see the items.
  virtual void leavers(const ContactViews<PackedRows>& in, const OpenBox& box, Index n,
                       Leaver* leavers) const = 0;
  virtual void departures(const ContactViews<PackedRows>& in, Vec3 gravity, const OpenBox& box, Index n,
                          const StartViews& start) const = 0;
};

// The stages of one type of law, on the CPU, for the laws of all pairs of `materials`: each type is compiled
// in a source file of its own, laws/*.cpp.
template <class Law>
std::unique_ptr<ContactKernels> cpu_kernels(const std::vector<Law>& laws, int materials);

std::unique_ptr<ContactKernels> make_contact_kernels(const Contact& contact);

// The lines of the first items, one item after the other: as many as counts has places, whose lines it
// counts. to: without where lines go.
std::vector<ContactLine> contact_lines(const ContactKernels& kernels, const ContactViews<PackedRows>& in,
                                       LineRequest to, std::vector<Index>& counts);

}  // namespace scree
