// Policy of the HHT method's Newton iteration: scaled norms, reuse of the factored matrix, failures.
#pragma once

#include <string>
#include <vector>

#include "mbs/hht_method.hpp"
#include "mbs/petsc_solver.hpp"

namespace scree {

// Full Newton. Within a step the factored matrix of the last iteration is used once more if that iteration
// already cut the residual to 1e-2 or less: the matrix then describes the step well. What is kept from step
// to step are factors of a matrix that is the same bit for bit, so that a restarted run repeats the bits of
// an uninterrupted one. Bodies that touch each other come and go: what the matrix has between them is not in
// what is factored.
class NewtonSolver {
 public:
  // `system` and `method` must outlive the solver.
  NewtonSolver(const MechanicalSystem& system, HhtMethod& method);

  // Solves the acceleration-level system at time t and completes `state`. Throws SimulationError as iterate()
  // does.
  void solve_acceleration(MultibodyState& state, Real t);

  // Changes q' by as little as the constraints at time t demand, in the norm of M. Throws SimulationError as
  // iterate() does.
  void solve_velocity(MultibodyState& state, Real t);

  // Gives an accepted state the accelerations and multipliers of its instant t: those of the
  // acceleration-level system, with the forces that the state ends its step with, and velocities as by
  // solve_velocity(). Forces that the multipliers load follow them, where the system has the state's forces
  // as they are at instants. Throws SimulationError as iterate() does.
  void solve_instant(MultibodyState& state, Real t);

  // The part of a motion that the constraints at the state take away, the least in the norm of M: d of
  // [M, Phi_q^T; Phi_q, -C] (d, mu) = (0, Phi_q motion). At t = 0. Throws SimulationError as
  // iterate() does.
  std::vector<Real> constrained_part(const MultibodyState& state, const std::vector<Real>& motion);

  // Applied forces of a state at time t, as the system now has them, where they differ from the state's.
  // share: of HhtMethod::change_system. Throws SimulationError as iterate() does.
  void change_forces(MultibodyState& state, Real t, Real share);

  // A new step was opened.
  void begin_step();
  // One iteration. Throws SimulationError naming the joints or bodies on a singular matrix or a residual that
  // is not finite.
  IterationNorms iterate();

  // Of rows that share: what the last solve_acceleration() left unsolved in their right-hand sides
  // [constraints]; of no size unless rows that repeat each other contradict each other.
  const std::vector<Real>& misfit() const { return misfit_; }

  std::string description() const { return solver_.description(); }

 private:
  // Solves the system of acceleration_matrix_ for the right-hand side in acceleration_solver_.
  void solve_acceleration_level();
  // Where rows share the load: takes from the constraints' part g of the right-hand side what no motion can
  // satisfy, as round-off and the digits of a deck leave it in rows that repeat each other. Their multipliers
  // would grow by it over C. It is -C mu with [A, Phi_q^T; Phi_q, -C] (x, mu) = (0, g), and of that the same
  // again. Returns whether the matrix has yet to be factored.
  bool drop_misfit(PetscSolver& solver, bool refactor);
  // Solves [A, Phi_q^T; Phi_q, -C]; where rows share the load, so that none yields: what one has yielded by,
  // C times its multiplier, goes back to the right-hand side. Of the multipliers those with the same forces
  // and the least C-norm remain. multipliers: those that the solution is the change of; none where it has all
  // of them.
  void solve_sharing(PetscSolver& solver, bool refactor, const std::vector<Real>& multipliers);
  Real scaled_residual() const;
  Real scaled_correction(std::span<const Real> delta) const;
  Real scaled_change();
  void solve_linear(PetscSolver& solver, bool refactor);
  // From the solution of solver_, which knows nothing of O (HhtMethod::is_coupled), to that with it: by
  // generalized conjugate residuals (Eisenstat, Elman, Schultz, SIAM J. Numer. Anal. 20, 1983) over its
  // factors. Sums are of one rank, in one order.
  std::span<const Real> solve_coupled();
  Real product(const std::vector<Real>& a, const std::vector<Real>& b) const;  // of forces [J^2]

  const MechanicalSystem& system_;
  HhtMethod& method_;
  PetscSolver solver_;
  // [M, Phi_q^T; Phi_q, -C] has factors of its own: where Phi_q is constant they stay.
  PetscSolver acceleration_solver_;
  std::vector<Real> acceleration_matrix_;  // [entries of the pattern]
  bool has_acceleration_factors_ = false;  // of acceleration_solver_.values()
  std::vector<Real> misfit_, forces_, gaps_;
  std::vector<Real> coupled_, left_;                    // a solution, and what of the forces it leaves
  std::vector<std::vector<Real>> directions_, images_;  // and their products with the matrix, of norm 1
  Real last_residual_ = 0;
  bool first_ = true;  // iteration of its step
};

}  // namespace scree
