#include "mbs/newton_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "base/error.hpp"
#include "mbs/start_checks.hpp"

namespace scree {

namespace {

constexpr Real kReuseContraction = 1e-2;
// Each pass leaves the round-off of a misfit, over the rows' share.
constexpr int kMisfitPasses = 2;
// Each pass leaves a part of the rows' yielding, or of a false misfit, in the ratio of eps S to the rows'
// mobility in that direction: little, unless one of the bodies is far lighter than others.
constexpr int kYieldPasses = 2;
// Forces that depend on the reactions converge at a step's end in two or three passes.
constexpr int kLoadPasses = 10;
constexpr Real kLoadRoundOff = 1e-14;
// Relative residual that the forces between bodies in contact may leave in a Newton correction, and the
// largest number of solutions with the factors for it.
constexpr Real kCoupledResidual = 1e-3;
constexpr int kCoupledPasses = 30;

}  // namespace

NewtonSolver::NewtonSolver(const MechanicalSystem& system, HhtMethod& method)
    : system_(system),
      method_(method),
      solver_(method.pattern()),
      acceleration_solver_(method.pattern()),
      acceleration_matrix_(method.pattern().column.size()) {
  if (!method.shares()) return;
  solver_.set_units(method.units());
  acceleration_solver_.set_units(method.units());
}

void NewtonSolver::begin_step() { first_ = true, prepared_ = false; }

void NewtonSolver::prepare() {
  try {
    method_.begin_residual();
    if (system_.contacts_in_matrix()) return;
    method_.newton_matrix(solver_.values());
    const std::span<Real> gaps = solver_.rhs().subspan(system_.coordinate_scale().size());
    std::copy(method_.residual().end() - std::ssize(gaps), method_.residual().end(), gaps.begin());
    factored_ahead_ = !drop_misfit(solver_, true) || solver_.factor();
    prepared_ = true;
  } catch (const SimulationError&) {
  }
}

// e1 over the largest force that takes part, each force times the scale of its coordinate; Phi over the
// scale of its constraint. e2 itself holds the round-off of Phi over beta h^2, which grows without bound as
// h shrinks.
Real NewtonSolver::scaled_residual() const {
  const std::vector<Real>&residual = method_.residual(), &scale = system_.coordinate_scale();
  const std::vector<Real>&inertia = method_.inertia_force(), &reaction = method_.constraint_force();
  Real largest = method_.terms().force_scale, dynamic = 0, kinematic = 0;
  for (std::size_t i = 0; i < scale.size(); ++i) {
    const Real force =
        std::max({std::abs(inertia[i]), std::abs(reaction[i]), std::abs(method_.start_force()[i])});
    if (!std::isfinite(residual[i])) {
      throw SimulationError(fmt::format("mbs_correct, rank 0: the residual of {} is not finite at t = {} s",
                                        system_.coordinate_name(static_cast<int>(i)), method_.end_time()));
    }
    largest = std::max(largest, force * scale[i]);
    dynamic = std::max(dynamic, std::abs(residual[i]) * scale[i]);
  }
  for (std::size_t j = 0; j < method_.terms().constraint.size(); ++j) {
    const Real gap = method_.terms().constraint[j];
    if (!std::isfinite(gap)) {
      throw SimulationError(fmt::format("mbs_correct, rank 0: the residual of {} is not finite at t = {} s",
                                        system_.constraint_name(static_cast<int>(j)), method_.end_time()));
    }
    kinematic = std::max(kinematic, std::abs(gap) / system_.constraint_scale()[j]);
  }
  // Without any force the residual is zero as well.
  return std::max(dynamic / std::max(largest, std::numeric_limits<Real>::min()), kinematic);
}

Real NewtonSolver::scaled_correction(std::span<const Real> delta) const {
  Real largest = 0;
  for (std::size_t i = 0; i < system_.coordinate_scale().size(); ++i) {
    largest = std::max(largest, std::abs(delta[i]) / system_.coordinate_scale()[i]);
  }
  return method_.position_gain() * largest;
}

void NewtonSolver::solve_linear(PetscSolver& solver, bool refactor) {
  if (solver.solve(refactor)) return;
  throw SimulationError(fmt::format("mbs_correct, rank 0: at t = {} s the matrix of the multibody system {}",
                                    method_.end_time(),
                                    matrix_failure(system_, method_.pattern(), solver.values())));
}

bool NewtonSolver::renew_acceleration_matrix() {
  const std::span<Real> factored = acceleration_solver_.values();
  if (has_acceleration_factors_ &&
      std::memcmp(factored.data(), acceleration_matrix_.data(), factored.size_bytes()) == 0)
    return false;
  std::copy(acceleration_matrix_.begin(), acceleration_matrix_.end(), factored.begin());
  return true;
}

void NewtonSolver::solve_acceleration_level() {
  bool refactor = renew_acceleration_matrix();
  has_acceleration_factors_ = false;  // until the factorization succeeds
  refactor = drop_misfit(acceleration_solver_, refactor);
  solve_minimum_norm(acceleration_solver_, refactor, {});
  has_acceleration_factors_ = true;
}

bool NewtonSolver::drop_misfit(PetscSolver& solver, bool refactor) {
  if (!method_.shares()) return refactor;
  const std::vector<Real>& compliance = method_.compliance();
  const std::size_t n = system_.coordinate_scale().size();
  const std::span<Real> forces = solver.rhs().first(n), gaps = solver.rhs().subspan(n);
  misfit_.assign(gaps.size(), 0);
  if (std::all_of(gaps.begin(), gaps.end(), [](Real gap) { return gap == 0; })) return refactor;
  forces_.assign(forces.begin(), forces.end());
  std::fill(forces.begin(), forces.end(), 0);
  for (int pass = 0; pass < kMisfitPasses; ++pass) {
    gaps_.assign(gaps.begin(), gaps.end());
    for (int share = 0; share < kYieldPasses; ++share) {
      solve_linear(solver, refactor);
      refactor = false;
      for (std::size_t j = 0; j < gaps.size(); ++j) gaps[j] = -compliance[j] * solver.solution()[n + j];
    }
    for (std::size_t j = 0; j < gaps.size(); ++j) {
      misfit_[j] += gaps[j];
      gaps[j] = gaps_[j] - gaps[j];
    }
  }
  std::copy(forces_.begin(), forces_.end(), forces.begin());
  return refactor;
}

void NewtonSolver::solve_minimum_norm(PetscSolver& solver, bool refactor,
                                      const std::vector<Real>& multipliers) {
  if (!method_.shares()) return solve_linear(solver, refactor);
  const std::vector<Real>& compliance = method_.compliance();
  const std::size_t n = system_.coordinate_scale().size();
  const std::span<Real> gaps = solver.rhs().subspan(n);
  gaps_.assign(gaps.begin(), gaps.end());
  for (std::size_t j = 0; j < multipliers.size(); ++j) gaps[j] -= compliance[j] * multipliers[j];
  solve_linear(solver, refactor);
  for (int pass = 0; pass < kYieldPasses; ++pass) {
    for (std::size_t j = 0; j < gaps.size(); ++j)
      gaps[j] = gaps_[j] - compliance[j] * solver.solution()[n + j];
    solve_linear(solver, false);
  }
}

void NewtonSolver::solve_acceleration(MultibodyState& state, Real t) {
  method_.acceleration_system(state, t, acceleration_matrix_, acceleration_solver_.rhs());
  solve_acceleration_level();
  method_.set_acceleration(acceleration_solver_.solution(), method_.terms().applied_force, state);
}

void NewtonSolver::solve_velocity(MultibodyState& state, Real t) {
  method_.velocity_system(state, t, acceleration_matrix_, acceleration_solver_.rhs());
  solve_acceleration_level();
  const std::span<const Real> change = acceleration_solver_.solution();
  for (std::size_t i = 0; i < state.velocity.size(); ++i) state.velocity[i] += change[i];
}

// The velocities of steps violate the constraints by their local error. Beside a singular position this
// error matters: only large reactions give the accelerations that it asks for.
void NewtonSolver::solve_instant(MultibodyState& state, Real t) {
  MultibodyState projected = state;
  solve_velocity(projected, t);
  method_.acceleration_system(projected, t, acceleration_matrix_, acceleration_solver_.rhs());
  std::copy(state.applied.begin(), state.applied.end(), acceleration_solver_.rhs().begin());
  solve_acceleration_level();
  method_.set_acceleration(acceleration_solver_.solution(), state.applied, state);
  if (method_.is_loaded()) change_forces(state, t, 1);
}

std::vector<Real> NewtonSolver::constrained_part(const MultibodyState& state,
                                                 const std::vector<Real>& motion) {
  method_.constraint_system(state, 0, motion, acceleration_matrix_, acceleration_solver_.rhs());
  solve_acceleration_level();
  const auto solution = acceleration_solver_.solution().begin();
  return {solution, solution + static_cast<std::ptrdiff_t>(motion.size())};
}

// Forces that depend on the reactions must end the step as the next one begins with them; otherwise the work
// of the difference is missing in the energy ledger.
void NewtonSolver::change_forces(MultibodyState& state, Real t, Real share) {
  for (int pass = 0; pass < kLoadPasses; ++pass) {
    if (!method_.change_system(state, t, acceleration_matrix_, acceleration_solver_.rhs())) return;
    if (pass > 0 && scaled_change() <= kLoadRoundOff) return;
    solve_acceleration_level();
    method_.apply_change(acceleration_solver_.solution(), share, state);
    if (!method_.is_loaded()) return;
  }
}

void NewtonSolver::prepare_change(const MultibodyState& state, Real t) {
  method_.begin_change(state, t, acceleration_matrix_);
  if (renew_acceleration_matrix()) has_acceleration_factors_ = acceleration_solver_.factor();
}

// The change of the forces on the right-hand side, over the largest force that takes part.
Real NewtonSolver::scaled_change() {
  const std::vector<Real>& scale = system_.coordinate_scale();
  Real largest = 0;
  for (std::size_t i = 0; i < scale.size(); ++i)
    largest = std::max(largest, std::abs(acceleration_solver_.rhs()[i]) * scale[i]);
  return largest / std::max(method_.terms().force_scale, std::numeric_limits<Real>::min());
}

Real NewtonSolver::product(const std::vector<Real>& a, const std::vector<Real>& b) const {
  const std::vector<Real>& scale = system_.coordinate_scale();
  Real sum = 0;
  for (std::size_t i = 0; i < scale.size(); ++i) sum += (scale[i] * a[i]) * (scale[i] * b[i]);
  return sum;
}

// With the factors of A: x = A^-1 b leaves the residual -O x; z = A^-1 r has the image (A + O) z = r + O z.
std::span<const Real> NewtonSolver::solve_coupled() {
  const std::size_t n = system_.coordinate_scale().size();
  const auto add = [](std::vector<Real>& to, Real scale, const std::vector<Real>& what) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += scale * what[i];
  };
  coupled_.assign(solver_.solution().begin(), solver_.solution().end());
  left_.assign(n, 0);
  method_.add_coupled(-1, coupled_, left_);
  Real whole = product(left_, left_);
  // With a large O the residual itself has to be solved for, as x = A^-1 b is no approximation.
  if (method_.is_loaded_by_contacts())
    whole = std::min(whole, product(method_.residual(), method_.residual()));
  const Real enough = kCoupledResidual * kCoupledResidual * whole;
  directions_.clear(), images_.clear();
  for (int pass = 0; pass < kCoupledPasses && product(left_, left_) > enough; ++pass) {
    std::fill(solver_.rhs().begin(), solver_.rhs().end(), 0);
    std::copy(left_.begin(), left_.end(), solver_.rhs().begin());
    solve_minimum_norm(solver_, false, {});
    std::vector<Real> direction(solver_.solution().begin(), solver_.solution().end()), image = left_;
    method_.add_coupled(1, direction, image);
    for (std::size_t k = 0; k < images_.size(); ++k) {
      const Real share = product(image, images_[k]);
      add(image, -share, images_[k]), add(direction, -share, directions_[k]);
    }
    const Real size = std::sqrt(product(image, image));
    if (!(size > 0)) break;
    for (std::vector<Real>* vector : {&image, &direction})
      for (Real& value : *vector) value /= size;
    const Real step = product(left_, image);
    add(coupled_, step, direction), add(left_, -step, image);
    directions_.push_back(std::move(direction)), images_.push_back(std::move(image));
  }
  return coupled_;
}

IterationNorms NewtonSolver::iterate() {
  method_.evaluate_residual();
  IterationNorms norms;
  norms.residual = scaled_residual();
  const bool prepared = std::exchange(prepared_, false) && !system_.contacts_in_matrix();
  bool refactor = first_ || norms.residual > kReuseContraction * last_residual_;
  if (prepared) {
    std::copy_n(method_.residual().begin(), system_.coordinate_scale().size(), solver_.rhs().begin());
    refactor = !factored_ahead_;
  } else {
    if (refactor) method_.newton_matrix(solver_.values());
    std::copy(method_.residual().begin(), method_.residual().end(), solver_.rhs().begin());
    refactor = drop_misfit(solver_, refactor);
  }
  solve_minimum_norm(solver_, refactor, method_.multipliers());
  const std::span<const Real> delta = method_.is_coupled() ? solve_coupled() : solver_.solution();
  norms.correction = scaled_correction(delta);
  method_.apply_correction(delta);
  last_residual_ = norms.residual;
  first_ = false;
  return norms;
}

}  // namespace scree
