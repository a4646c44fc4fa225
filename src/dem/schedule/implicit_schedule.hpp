// The schedule of an implicit step, for all backends and for particles with and without rotation.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "dem/backend/implicit_step.hpp"
#include "dem/implicit/block_solver.hpp"
#include "dem/implicit/line_search.hpp"
#include "dem/implicit/rotation_items.hpp"

namespace scree {

// FreedomsOn: `ThreeFreedoms` or `SixFreedoms`, with the items of particles that do not rotate or do. On: the
// operations of a backend on the particles of one rank. Its constructor stores the state at the start of the
// step.
//   items(), now(), start(), arrays(), h()  what the backend's objects share; state at the iterate and at the
//                                      start of the step; StepArrays; length of the step [s]
//   views(), rows(), surface_offsets(), surface_entries(), surface_moves(), side(), has_surfaces()
//   for_each(item), max(item)          over the particles; max(): over all ranks
//   queue_max(item), queue_sum(item)   the same, and a sum, for a later queued_max() and queued_sum()
//   largest_displacement()             of the particles of this rank since the start of the step [m]
//   copy(from, to)                     arrays of the particles
//   iterate_changed()                  ghosts are to be updated before contacts are evaluated
//   find_surface_steps(start), take_surface_steps()  contacts with surfaces on bodies, and their sums
//   form_system(system, residual, norms)  contacts of the particles, then the two items
//   norms()                            the maxima over all ranks of the last form_system()
//   solve(freedoms, stiffness_ratio, tolerance)  linear solve; returns the number of products
//   lag_limits(start)                  stores the friction limits of the iterate
//   account_contacts(start)            energies and contact history of an accepted step
//   worst(item), report_not_finite()   ids of particles; the latter reads StepArrays::residual and throws
//   undo()                             restores the start of the step
template <class On, template <class> class FreedomsOn>
class ImplicitSchedule : public ImplicitStep {
 public:
  template <class... Args>
  explicit ImplicitSchedule(Args&&... args) : on_(std::forward<Args>(args)...), freedoms_(on_) {}

  void predict() override { move(); }

  Real step_displacement() override {
    return on_.items().ranks.max(std::max(on_.largest_displacement(), on_.side().step_displacement()));
  }

  ParticleNorms contact_force() override {
    on_.find_surface_steps(start());
    on_.form_system(freedoms_.system(start()), freedoms_.residual(), freedoms_.norms());
    on_.take_surface_steps();
    if constexpr (!Freedoms::kRotates)
      if (search_.is_open()) on_.queue_sum(freedoms_.slope());
    norms_ = on_.norms();
    if (!std::isfinite(norms_.residual)) report_not_finite();
    const Real residual = scaled_residual(norms_);
    if (search_.is_open()) {
      if constexpr (Freedoms::kRotates)
        search_.update(residual);
      else
        search_.update(on_.queued_sum());
    }
    return {residual, norms_.correction_bound, search_.overshoots()};
  }

  GlobalId worst_particle() override { return on_.worst(freedoms_.size()); }

  void reduce_wrench(ContactWrenches& step, std::vector<BodyWrench>& end) override {
    on_.side().reduce(step, end);
  }

  ParticleCorrection particle_correct() override {
    ParticleCorrection out;
    search_ = {};
    const Real size = right_hand_side();
    if (size > 0) {
      freedoms_.begin_solve(size, is_consistent());
      const Real tolerance = tolerance_.next(is_consistent(), on_.items().model.integrator.residual_tolerance,
                                             norms_.force, size);
      out.iterations = on_.solve(freedoms_, norms_.stiffness_ratio, tolerance);
      on_.queue_max(freedoms_.correct(1));
      if constexpr (!Freedoms::kRotates) on_.queue_sum(freedoms_.slope_at_start());
    }
    move();
    if (size > 0) {
      out.correction = on_.queued_max();
      if constexpr (Freedoms::kRotates)
        search_.open(std::max(scaled_residual(norms_), size / norms_.force));
      else
        search_.open(on_.queued_sum());
    }
    return out;
  }

  void shorten_correction() override {
    on_.for_each(freedoms_.correct(search_.shorten()));
    move();
  }

  void lag_limits() override {
    if constexpr (Freedoms::kRotates) {
      on_.lag_limits(start());
      lagged_ = true, search_ = {};
    }
  }

  Real error() override { return on_.max(freedoms_.error()); }

  void accept() override {
    on_.find_surface_steps(start());
    on_.account_contacts(start());
    freedoms_.accept();
    on_.take_surface_steps();
    on_.side().book_step();
  }

  void undo() override { on_.undo(); }

 private:
  using Freedoms = FreedomsOn<On>;

  FrictionStart start() { return freedoms_.start(lagged_); }
  void move() {
    freedoms_.move();
    on_.iterate_changed();
  }
  // Whether the matrix is the derivative but for small terms. Lagged limits have no derivative.
  bool is_consistent() const {
    return Freedoms::kRotates && !lagged_ && ::scree::is_consistent(norms_.phase_squared);
  }
  // Prepares the right-hand side for the solve and returns its largest component [N]. The bodies have already
  // taken their correction: as a known part of the solution it moves to the right-hand side.
  Real right_hand_side() {
    if (!on_.has_surfaces()) return Freedoms::size(norms_);
    on_.for_each(freedoms_.shift(is_consistent()));
    const Real largest = on_.max(freedoms_.size());
    // The surfaces' displacements may be not finite: without a correction of the particles only the bodies
    // would report it.
    if (!std::isfinite(largest)) report_not_finite();
    return largest;
  }
  void report_not_finite() {
    freedoms_.show_residual();
    on_.report_not_finite();
  }

  On on_;
  Freedoms freedoms_;
  FrictionNorms norms_{};             // of the last contact_force
  typename Freedoms::Search search_;  // along the last correction
  FrictionTolerance tolerance_;
  bool lagged_ = false;  // whether friction limits are those of an earlier iterate
};

}  // namespace scree
