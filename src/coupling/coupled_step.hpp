// One step of particles and bodies: Fig. 5 of the paper, and an explicit variant.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/timer.hpp"
#include "coupling/body_coupling.hpp"
#include "dem/backend/backend.hpp"
#include "mbs/multibody.hpp"
#include "model/data/model.hpp"

namespace scree {

enum class Verdict { accepted, not_converged, inaccurate };

struct StepOutcome {
  Verdict verdict = Verdict::accepted;
  Real error = 0;       // local error over the tolerance, of particles and bodies
  std::string trouble;  // reason why the step did not converge: stage, id
};

// Counters over the run; part of the state.
struct StepCounts {
  std::int64_t steps = 0, newton_iterations = 0, linear_iterations = 0;
  std::int64_t rejected_error = 0, rejected_newton = 0;
  std::int64_t lagged_steps = 0;  // accepted with lagged friction limits: ImplicitStep::lag_limits
};

class CoupledStep {
 public:
  CoupledStep(const Model& model, Backend& backend, BodyCoupling& link, StageTimers& timers);

  // Computes forces, accelerations and multipliers at the start.
  void start(MultibodyState& bodies);
  // Prepares steps after a restart without recomputing what the state holds. t [s].
  void resume(const MultibodyState& bodies, Real t);
  // After resume(): recomputes forces, accelerations and multipliers for this model, if the state is of
  // another one. t [s].
  void renew_forces(MultibodyState& bodies, Real t);
  // Advances particles and bodies from t by h [s], or leaves both unchanged if the step is not accepted.
  // Throws SimulationError, with both unchanged, if a particle would leave the domain where that is an error
  // (see check_inside).
  StepOutcome implicit_step(MultibodyState& bodies, Real t, Real h);
  // Why no step from this state can succeed, if a driver is at a dead point; otherwise empty. Collective.
  std::string dead_point() { return body_coupling_.dead_point(); }
  // Advances particles and bodies by up to times.size() steps of length h [s], the particles in substeps.
  // times: start of each step [s]; end: end of the last step [s]. Returns the number of steps taken, which is
  // less if a particle is outside the domain after one of them.
  std::size_t explicit_steps(MultibodyState& bodies, const std::vector<Real>& times, Real h, Real end);
  // The particles outside the domain now, and those in the outlets. Throws SimulationError for the first one
  // beyond a wall, or for the first one outside at all if the deck makes that an error.
  std::vector<EscapedParticle> check_inside(std::span<const OutletRegion> outlets = {}) const;
  // Rebuilds the neighbour list for the current particles and bodies.
  void rebuild_list();

  StepCounts& counts() { return counts_; }
  const StepCounts& counts() const { return counts_; }

 private:
  struct Iteration;
  struct ExplicitStep {
    Real t, h, end;  // end: t + h up to round-off [s]
    bool keep_open;  // whether another step follows
  };
  using OpenStep = std::unique_ptr<ImplicitStep>;  // of the particles; null if none is open
  void open_step(OpenStep& step, const MultibodyState& bodies, Real t, Real h);
  void undo_step(OpenStep& step, const MultibodyState& bodies, Real t);
  bool covered(OpenStep& step, const MultibodyState& bodies, Real t, int builds);
  void solve_step(OpenStep& step, const MultibodyState& bodies, Real t, Real h);
  void iterate(ImplicitStep& step);
  void lag_friction(ImplicitStep& step, const Iteration& last);
  bool iterate_once(ImplicitStep& step, Iteration& last, bool final);
  std::string convergence_error(ImplicitStep& step, const Iteration& last, int iterations) const;
  bool explicit_step(ExplicitRun& run, MultibodyState& bodies, const ExplicitStep& step);
  // A step of the bodies within an explicit step, or all of it: from `first` to `last` substeps after its
  // start.
  struct BodyStep {
    Real t, h, end;  // [s]
    int first, last;
    Real end_of_last = t;    // end of the previous substep [s]
    bool predicted = false;  // the bodies' step is open
  };
  bool explicit_substeps(ExplicitRun& run, MultibodyState& bodies, const ExplicitStep& step, BodyStep& part);
  void solve_bodies(ExplicitRun& run, MultibodyState& bodies, const BodyStep& step);
  void correct_bodies(BodyIterations& iterations);
  void evaluate_contacts(ExplicitRun& run, const MultibodyState& bodies, BodyIterations& iterations);
  // Beside walls with prescribed motion, without bodies; defined in driven_steps.cpp.
  std::vector<Real> instants_of(const std::vector<Real>& times, Real h, Real end) const;
  std::size_t driven_steps(ExplicitRun& run, MultibodyState& bodies, const std::vector<Real>& instants);

  const Model& model_;
  Backend& backend_;
  BodyCoupling& body_coupling_;
  StageTimers& timers_;
  const bool has_contacts_;    // otherwise no contact detection is needed
  const Real largest_radius_;  // of particles and shapes, otherwise of meshes that touch planes [m]
  StepCounts counts_;
  bool lagged_ = false;                 // friction limits are lagged in the open step
  std::vector<BodyWrench> wrench_sum_;  // over the substeps of an explicit step
};

}  // namespace scree
