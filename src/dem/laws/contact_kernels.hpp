// Contact stages for the law of a run, which is chosen once: the loops inside are monomorphic.
#pragma once

#include <memory>
#include <vector>

#include "dem/implicit/step_items.hpp"
#include "dem/laws/contact_requests.hpp"
#include "dem/search/pair_list.hpp"
#include "dem/surface_contact/friction_surfaces.hpp"
#include "dem/surface_contact/surface_items.hpp"
#include "dem/surface_contact/wall_items.hpp"
#include "model/data/model.hpp"
#include "partition/ranks.hpp"

namespace scree {

// Contacts with surfaces over an implicit step, per entry, with three or with six degrees of freedom.
struct SurfaceStepsTo {
  SurfaceStep* steps;
  SurfaceFriction* friction_steps;
};

class ContactKernels {
 public:
  virtual ~ContactKernels() = default;
  virtual LawTraits traits() const = 0;
  // Applies the item of the request to n items.
  virtual void run(const ContactViews<PackedRows>& in, Index n, const CpuRequest& request) const = 0;
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
  // Sums of the first n `WallContactItem`, over all ranks.
  virtual void wall_sums(const ContactViews<PackedRows>& in, Index n, const WallChoice& choice,
                         const Ranks& ranks, Real (&sums)[kWallTerms]) const = 0;
  // Output of the contacts in `loads` of n entries with placed surfaces.
  virtual void shown_surfaces(const SurfaceViews& in, Index n, const SurfaceLoad* loads,
                              ShownContact* shown) const = 0;
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
