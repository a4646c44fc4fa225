// Policy of the HHT method's Newton iteration: scaled norms, reuse of the factored matrix, failures.
#pragma once

#include <string>
#include <vector>

#include "mbs/hht_method.hpp"
#include "mbs/petsc_solver.hpp"

namespace scree {

// Full Newton. Within a step the factors of the last iteration are used once more if that iteration has cut
// the residual to 1e-2 or less, as the matrix then describes the step well. From step to step factors are
// reused only of a matrix that is bitwise the same, so that a restarted run repeats the bits of an
// uninterrupted one. Contacts between bodies come and go: their entries are not part of what is factored.
class NewtonSolver {
 public:
  // `system` and `method` must outlive the solver.
  NewtonSolver(const MechanicalSystem& system, HhtMethod& method);

  // Solves the acceleration-level system at time t and completes `state`. Throws SimulationError as iterate()
  // does.
  void solve_acceleration(MultibodyState& state, Real t);

  // Changes q' by the least amount that satisfies the constraints at time t, in the norm of M. Throws
  // SimulationError as iterate() does.
  void solve_velocity(MultibodyState& state, Real t);

  // Gives an accepted state the accelerations and multipliers of its instant t: those of the
  // acceleration-level system with the forces at the end of the state's step, and velocities as by
  // solve_velocity(). Forces that depend on the multipliers are updated, provided the system has the state's
  // forces as at instants. Throws SimulationError as iterate() does.
  void solve_instant(MultibodyState& state, Real t);

  // The part of a motion that the constraints at the state remove, the least in the norm of M: d of [M,
  // Phi_q^T; Phi_q, -C] (d, mu) = (0, Phi_q motion). At t = 0. Throws SimulationError as iterate() does.
  std::vector<Real> constrained_part(const MultibodyState& state, const std::vector<Real>& motion);

  // Replaces the applied forces of a state at time t by those of the system, where they differ. share: as in
  // HhtMethod::apply_change. Throws SimulationError as iterate() does.
  void change_forces(MultibodyState& state, Real t, Real share);
  // Does what the next change_forces() for this state and time needs and the forces of contacts do not
  // change, the factors included.
  void prepare_change(const MultibodyState& state, Real t);

  // Resets the reuse of factors for a new step.
  void begin_step();
  // Between begin_step() and the first iterate(): does what that iteration needs and the forces of contacts
  // do not change. This includes the factors and the misfit of redundant rows, unless contacts are in the
  // matrix. What fails here fails again in iterate().
  void prepare();
  // Does one iteration. Throws SimulationError with the names of the joints or bodies on a singular matrix
  // or a residual that is not finite.
  IterationNorms iterate();

  // Residual of redundant rows in the last solve_acceleration() [constraints]; of no size unless redundant
  // rows contradict each other.
  const std::vector<Real>& misfit() const { return misfit_; }

  std::string description() const { return solver_.description(); }

 private:
  // Solves the system of acceleration_matrix_ for the right-hand side in acceleration_solver_.
  void solve_acceleration_level();
  // Whether the factors of acceleration_solver_ are not those of acceleration_matrix_; if so, it takes over
  // the matrix.
  bool renew_acceleration_matrix();
  // With redundant rows: removes from the constraints' part g of the right-hand side what no motion can
  // satisfy, as round-off and the digits of a deck leave it there; the multipliers would grow by it over C.
  // It is -C mu with [A, Phi_q^T; Phi_q, -C] (x, mu) = (0, g); the system is solved twice, the second time
  // for the rest of the first. Returns whether the matrix has yet to be factored.
  bool drop_misfit(PetscSolver& solver, bool refactor);
  // Solves [A, Phi_q^T; Phi_q, -C]. With redundant rows the yielding of each row, C times its multiplier, is
  // fed back to the right-hand side, so that no row yields. Of the multipliers that give the same forces
  // those with the least C-norm remain. multipliers: the ones whose change is solved for; empty where the
  // solution is the whole of them.
  void solve_minimum_norm(PetscSolver& solver, bool refactor, const std::vector<Real>& multipliers);
  Real scaled_residual() const;
  Real scaled_correction(std::span<const Real> delta) const;
  Real scaled_change();
  void solve_linear(PetscSolver& solver, bool refactor);
  // Improves the solution of solver_, which does not contain O (HhtMethod::is_coupled), to that with O, by
  // generalized conjugate residuals (Eisenstat, Elman, Schultz, SIAM J. Numer. Anal. 20, 1983)
  // preconditioned with its factors. Sums are taken on one rank in a fixed order.
  std::span<const Real> solve_coupled();
  // Inner product of forces [J^2].
  Real product(const std::vector<Real>& a, const std::vector<Real>& b) const;

  const MechanicalSystem& system_;
  HhtMethod& method_;
  PetscSolver solver_;
  // Separate factors of [M, Phi_q^T; Phi_q, -C]: they stay valid where Phi_q is constant.
  PetscSolver acceleration_solver_;
  std::vector<Real> acceleration_matrix_;  // [entries of the pattern]
  bool has_acceleration_factors_ = false;  // whether acceleration_solver_ has factors of acceleration_matrix_
  std::vector<Real> misfit_, forces_, gaps_;
  std::vector<Real> coupled_, left_;  // a solution, and its residual force
  // Search directions and their products with the matrix, of norm 1.
  std::vector<std::vector<Real>> directions_, images_;
  Real last_residual_ = 0;
  bool first_ = true;            // the next iteration is the first of its step
  bool prepared_ = false;        // matrix and gaps are those of the next iteration
  bool factored_ahead_ = false;  // and the factors
};

}  // namespace scree
