// One step of both sides: the paper's Fig. 5, and its explicit sibling.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/timer.hpp"
#include "coupling/body_link.hpp"
#include "dem/backend/backend.hpp"
#include "mbs/multibody.hpp"
#include "model/data/model.hpp"

namespace scree {

enum class Verdict { accepted, not_converged, inaccurate };

struct StepOutcome {
  Verdict verdict = Verdict::accepted;
  Real error = 0;       // local error over the tolerance, both sides
  std::string trouble;  // why the step did not converge: stage, id
};

// Counted over the run; part of the state.
struct StepCounts {
  std::int64_t steps = 0, newton_iterations = 0, linear_iterations = 0;
  std::int64_t rejected_error = 0, rejected_newton = 0;
  std::int64_t frozen_steps = 0;  // accepted with frozen limits of friction: ImplicitStep::freeze_limits
};

class CoupledStep {
 public:
  CoupledStep(const Model& model, Backend& backend, BodyLink& link, StageTimers& timers);

  // Forces, accelerations and multipliers at the start.
  void start(MultibodyState& bodies);
  // After a restart: the same without recomputing what the state holds.
  void resume(const MultibodyState& bodies, Real t);
  // After resume(): forces, accelerations and multipliers of this model, where the state is of another one.
  void renew_forces(MultibodyState& bodies, Real t);
  // Advances both sides from t by h, or leaves both as they were. Throws SimulationError, with both as they
  // were, where a particle would be outside the space and must not (see check_inside).
  StepOutcome implicit_step(MultibodyState& bodies, Real t, Real h);
  // Why no step goes on from this state, where a driver is why; else empty. Collective.
  std::string dead_point() { return link_.dead_point(); }
  // Advances both sides by up to times.size() steps of length h, the particles in substeps. times: where each
  // step starts; end: of the last one [s]. Returns the number of steps taken: fewer where a particle is
  // outside the space after one.
  std::size_t explicit_steps(MultibodyState& bodies, const std::vector<Real>& times, Real h, Real end);
  // The particles outside the space now. Throws SimulationError naming the first that is beyond a wall, or
  // outside at all where the deck calls that an error.
  std::vector<Leaver> check_inside() const;
  // Brings the neighbour list up to date with the particles and bodies as they are.
  void rebuild_list(Real skin);

  StepCounts& counts() { return counts_; }
  const StepCounts& counts() const { return counts_; }

 private:
  struct Iteration;
  struct ExplicitStep {
    Real t, h, end;  // end: t + h but for round-off [s]
    bool keep_open;  // whether another one follows
  };
  using OpenStep = std::unique_ptr<ImplicitStep>;  // of the particles; null while none is open
  void open_step(OpenStep& step, const MultibodyState& bodies, Real t, Real h);
  void undo_step(OpenStep& step, const MultibodyState& bodies, Real t);
  bool covered(OpenStep& step, const MultibodyState& bodies, Real t, int builds);
  void solve_step(OpenStep& step, const MultibodyState& bodies, Real t, Real h);
  void iterate(ImplicitStep& step);
  void freeze(ImplicitStep& step, const Iteration& last);
  bool iterate_once(ImplicitStep& step, Iteration& last, bool final);
  std::string trouble_of(ImplicitStep& step, const Iteration& last, int iterations) const;
  bool explicit_step(ExplicitRun& run, MultibodyState& bodies, const ExplicitStep& step);
  // A step of the bodies within one of these, or all of it: from `first` substeps after its start to `last`.
  struct BodyStep {
    Real t, h, end;  // [s]
    int first, last;
    Real end_of_last = t;  // substep
  };
  bool explicit_substeps(ExplicitRun& run, MultibodyState& bodies, const ExplicitStep& step, BodyStep& part);
  void solve_bodies(ExplicitRun& run, MultibodyState& bodies, const BodyStep& step);
  void evaluate_contacts(ExplicitRun& run);

  const Model& model_;
  Backend& backend_;
  BodyLink& link_;
  StageTimers& timers_;
  const bool something_touches_;  // without, nothing is looked for
  const Real largest_radius_;     // of particles and shapes, else of meshes on planes [m]
  StepCounts counts_;
  bool frozen_ = false;                 // in the step that is open
  std::vector<BodyWrench> wrench_sum_;  // over the substeps of an explicit step
};

}  // namespace scree
