// Policy of the HHT method's Newton iteration: scaled norms, reuse of the factored matrix, failures.
#pragma once

#include <string>

#include "mbs/hht_method.hpp"
#include "mbs/petsc_solver.hpp"

namespace scree {

// Full Newton. Within a step the factored matrix of the last iteration is used once more if that iteration
// already cut the residual to 1e-2 or less: the matrix then describes the step well. Nothing is kept from
// step to step, so that a restarted run repeats the bits of an uninterrupted one.
class NewtonSolver {
 public:
  // `system` and `method` must outlive the solver.
  NewtonSolver(const MechanicalSystem& system, HhtMethod& method);

  // Solves the acceleration-level system at time t and completes `state`. Throws SimulationError as iterate()
  // does.
  void solve_acceleration(MultibodyState& state, Real t);

  // Applied forces at the end of a closed step, as the system now has them, where they differ from the
  // step's. Throws SimulationError as iterate() does.
  void change_end_forces(MultibodyState& state);

  // A new step was opened.
  void begin_step();
  // One iteration. Throws SimulationError naming the joints or bodies on a singular matrix or a residual that
  // is not finite.
  IterationNorms iterate();

  std::string description() const { return solver_.description(); }

 private:
  Real scaled_residual() const;
  Real scaled_correction() const;
  void solve_linear(bool refactor);

  const MechanicalSystem& system_;
  HhtMethod& method_;
  PetscSolver solver_;
  Real last_residual_ = 0;
  bool first_ = true;  // iteration of its step
};

}  // namespace scree
