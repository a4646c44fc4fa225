// The contact stages for the law of this run, chosen once: loops over items are monomorphic inside.
#pragma once

#include <memory>
#include <vector>

#include "dem/contact_items.hpp"
#include "dem/leaver_items.hpp"
#include "dem/shape_items.hpp"
#include "dem/step_items.hpp"
#include "dem/system_items.hpp"
#include "dem/wall_items.hpp"
#include "model/model.hpp"
#include "partition/ranks.hpp"

namespace scree {

struct EnergyOutputs {
  Real* energy;
  Index* contacts;
  Real* pairs;
};

class ContactKernels {
 public:
  virtual ~ContactKernels() = default;
  virtual void forces(const ContactViews<PackedRows>& in, Vec3 gravity, Index n, Vec3* force,
                      Real* loss_power) const = 0;
  // The square of the largest acceleration; a NaN if one is not finite.
  virtual Real verlet_finish(const ContactViews<PackedRows>& in, Vec3 gravity, Index n,
                             const VerletViews& state, Vec3* force) const = 0;
  // The square of the largest displacement.
  virtual Real verlet_advance(const ContactViews<PackedRows>& in, Vec3 gravity, Index n,
                              const VerletViews& state) const = 0;
  virtual void system(const ContactViews<PackedRows>& in, Vec3 gravity, Index n, NewtonWeights weights,
                      const StepStart& start, const StepForces& out, const ContactMatrix& matrix) const = 0;
  // Contacts of shapes over an implicit step, and at one instant.
  virtual void shapes(const ContactViews<PackedRows>& in, Index n, const StepStart& start,
                      ShapeContact* out) const = 0;
  virtual void shapes(const ContactViews<PackedRows>& in, const ShapePlaces& places, Index n,
                      ShapeContact* out) const = 0;
  // Of the first n items of WallContactItem, over all ranks.
  virtual void wall_sums(const ContactViews<PackedRows>& in, Index n, const WallChoice& choice,
                         const Ranks& ranks, Real (&sums)[kWallTerms]) const = 0;
  virtual void energies(const ContactViews<PackedRows>& in, Index n, const EnergyOutputs& out) const = 0;
  // What the contacts of the particles, and of the shapes among themselves, add to the ledger over an
  // accepted implicit step.
  virtual void books(const ContactViews<PackedRows>& in, Index n, const StepStart& start, Real* contact_loss,
                     Real* integrator_loss) const = 0;
  virtual void shape_books(const ContactViews<PackedRows>& in, Index n, const StepStart& start,
                           ContactBooks* out) const = 0;
  // n particles that leave, and what they leave to all others: see the items.
  virtual void leavers(const ContactViews<PackedRows>& in, const OpenBox& box, Index n,
                       Leaver* leavers) const = 0;
  virtual void departures(const ContactViews<PackedRows>& in, Vec3 gravity, const OpenBox& box, Index n,
                          const StartViews& start) const = 0;
};

// The walls in the form the items read.
std::vector<WallPlane> wall_planes(const Model& model);

std::unique_ptr<ContactKernels> make_contact_kernels(const Contact& contact);

}  // namespace scree
