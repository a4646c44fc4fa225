#include "coupling/coupled_step.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "base/error.hpp"
#include "deck/choices.hpp"
#include "model/checks/limits.hpp"
#include "model/derived/mesh_corners.hpp"
#include "model/derived/touching.hpp"

namespace scree {
namespace {

// A step fails after so many builds of a neighbour list that does not cover its displacements.
constexpr int kMostListBuilds = 4;
// Skin of a list rebuilt for a fast step, over the largest displacement in that step.
constexpr Real kSkinPerMotion = 5;
// Largest skin of such a list, over the largest radius: a single fast particle must not make all particles
// neighbours. Steps that need more are shortened.
constexpr Real kMostSkin = 4;

// Newton iterations of a step in which the friction limits follow the normal forces. Steps that resolve their
// contacts need 4 to 7.
constexpr int kMostFollowing = 12;

// A residual that moves no particle by more than this share of its radius is round-off, even if it is large
// compared with the largest force, as at a first contact in weightlessness.
constexpr Real kRoundOffMove = 1e-12;

}  // namespace

// Data of the last iteration of a Newton loop.
struct CoupledStep::Iteration {
  Real residual = 0, correction = 1;  // of the particles
  // Minimum of the last correction and the correction that the residual can still cause.
  Real judged_correction = 1;
  IterationNorms bodies;
};

CoupledStep::CoupledStep(const Model& model, Backend& backend, BodyCoupling& link, StageTimers& timers)
    : model_(model),
      backend_(backend),
      body_coupling_(link),
      timers_(timers),
      has_contacts_(model.particles.totals.count > 0 || !pair_limits(model).empty()),
      largest_radius_(radius_range(model).largest > 0 ? radius_range(model).largest
                                                      : largest_corner_radius(model)) {}

void CoupledStep::rebuild_list() { backend_.list().build(backend_.list().choose_skin(), timers_); }

void CoupledStep::start(MultibodyState& bodies) {
  body_coupling_.set_initial_state(bodies, {model_.bodies.size(), BodyWrench{}});
  resume(bodies, 0);
  backend_.particles().initial_forces();
  // The contact wrenches at the start are known only now.
  body_coupling_.reduce_end_wrench(backend_.particles());
  body_coupling_.set_initial_state(bodies, body_coupling_.wrench_of_bodies());
  body_coupling_.take_wrench(bodies);
}

void CoupledStep::resume(const MultibodyState& bodies, Real t) {
  body_coupling_.broadcast_motion(backend_.list(), bodies, 0, t);
  rebuild_list();
}

void CoupledStep::renew_forces(MultibodyState& bodies, Real t) {
  backend_.particles().initial_forces();
  body_coupling_.reduce_end_wrench(backend_.particles());
  body_coupling_.solve_acceleration(bodies, t);
}

void CoupledStep::open_step(OpenStep& step, const MultibodyState& bodies, Real t, Real h) {
  {
    const auto scope = timers_.time(Stage::predict);
    // After the previous step the walls have the pose of its end, which round-off makes another instant than
    // t.
    if (body_coupling_.has_driven_walls()) body_coupling_.broadcast_motion(backend_.list(), bodies, 0, t);
    body_coupling_.predict(bodies, t, h, t + h);
    step = backend_.open_step(h);
    step->predict();
  }
  const auto scope = timers_.time(Stage::broadcast_motion);
  body_coupling_.broadcast_motion(backend_.list());
}

void CoupledStep::undo_step(OpenStep& step, const MultibodyState& bodies, Real t) {
  if (step) step->undo();
  step.reset();
  body_coupling_.broadcast_motion(backend_.list(), bodies, 0, t);
}

// Whether the neighbour list covers every pair that can touch in this iterate. If not, undoes the step and
// builds the list with a sufficient skin; the step is then repeated with the same h, so that the list does
// not affect the result.
bool CoupledStep::covered(OpenStep& step, const MultibodyState& bodies, Real t, int builds) {
  if (!has_contacts_ || backend_.list().displacement() <= 1) return true;
  const Real moved = step->step_displacement(), widest = kMostSkin * largest_radius_;
  if (builds == kMostListBuilds)
    throw SimulationError(fmt::format(
        "stage neighbors: the step displaces a particle or a shape of a body by {:.3g} m, more than the "
        "neighbour list covers: half of {:.3g} m",
        moved, std::max(model_.contact.skin, widest)));
  undo_step(step, bodies, t);
  backend_.list().build(std::max(model_.contact.skin, std::min(kSkinPerMotion * moved, widest)), timers_);
  return false;
}

// Opens the step of particles and bodies on a list that covers it, and iterates until the residuals are
// small.
void CoupledStep::solve_step(OpenStep& step, const MultibodyState& bodies, Real t, Real h) {
  const StepCounts before = counts_;
  bool done = false;
  for (int builds = 0; !done; ++builds) {
    // The counts leave out attempts that the list did not cover.
    counts_.newton_iterations = before.newton_iterations,
    counts_.linear_iterations = before.linear_iterations;
    open_step(step, bodies, t, h);
    if (!covered(step, bodies, t, builds)) continue;
    iterate(*step);
    done = covered(step, bodies, t, builds);
  }
}

StepOutcome CoupledStep::implicit_step(MultibodyState& bodies, Real t, Real h) {
  StepOutcome outcome;
  const StepCounts before = counts_;
  OpenStep step;
  try {
    solve_step(step, bodies, t, h);
    for (const EscapedParticle& l : backend_.particles().outside())
      if (l.lost) check_inside();  // a shorter step may avoid the penetration of the wall
  } catch (const DeviceError& error) {
    body_coupling_.ranks().error_barrier(error.what(), static_cast<int>(ExitCode::simulation_failed));
    counts_ = before;
    undo_step(step, bodies, t);
    throw;
  } catch (const SimulationError& error) {
    body_coupling_.ranks().error_barrier(error.what(), static_cast<int>(ExitCode::simulation_failed));
    undo_step(step, bodies, t);
    body_coupling_.check_reactions();
    ++counts_.rejected_newton;
    return {Verdict::not_converged, 0, error.what()};
  }
  const auto scope = timers_.time(Stage::accept);
  if (model_.time.control == StepControl::adaptive) {
    outcome.error = std::max(step->error(), body_coupling_.error());
    outcome.error /= model_.time.tolerance;
    if (!(outcome.error <= 1)) {
      undo_step(step, bodies, t);
      ++counts_.rejected_error;
      outcome.verdict = Verdict::inaccurate;
      return outcome;
    }
  }
  MultibodyState end = bodies;
  try {
    check_inside();
    body_coupling_.account_walls(end, t, t + h, body_coupling_.step_wrench());
    body_coupling_.accept(end);
  } catch (const SimulationError&) {
    undo_step(step, bodies, t);
    throw;
  }
  step->accept();
  bodies = std::move(end);
  ++counts_.steps, counts_.lagged_steps += lagged_;
  return outcome;
}

std::vector<EscapedParticle> CoupledStep::check_inside(std::span<const OutletRegion> outlets) const {
  const OutsidePolicy policy = model_.space.leaving;
  std::vector<EscapedParticle> escaped_particles = backend_.particles().outside(outlets);
  for (const EscapedParticle& l : escaped_particles) {
    if (l.outlet >= 0 || (!l.lost && policy != OutsidePolicy::error)) continue;
    throw SimulationError(fmt::format(
        "stage accept: particle {} is outside the domain at ({:g}, {:g}, {:g}) m, {}", l.global_id,
        l.position.x, l.position.y, l.position.z,
        l.lost ? "beyond a side that is a wall: its overlap with the wall exceeded its radius; increase the "
                 "stiffness of the contact or shorten the step"
               : fmt::format("and {} (allowed: {})", setting("space.leaving", policy),
                             fmt::join(words_of<OutsidePolicy>(), ", "))));
  }
  return escaped_particles;
}

void CoupledStep::iterate(ImplicitStep& step) {
  Iteration last;
  lagged_ = false;
  const int most = model_.integrator.max_iterations;
  for (int iteration = 1; iteration <= most; ++iteration) {
    ++counts_.newton_iterations;
    if (iterate_once(step, last, iteration == most)) return;
    if (model_.rotates() && iteration == kMostFollowing && iteration < most) lag_friction(step, last);
  }
  throw SimulationError(convergence_error(step, last, most));
}

// If Newton's method does not determine which contacts slide, adaptive steps are repeated with a smaller
// length, and fixed steps are solved with lagged friction limits, which no longer follow the normal forces.
void CoupledStep::lag_friction(ImplicitStep& step, const Iteration& last) {
  if (model_.time.control == StepControl::adaptive)
    throw SimulationError(convergence_error(step, last, kMostFollowing));
  step.lag_limits();
  lagged_ = model_.particles.totals.count > 0;
}

// Names the particles or bodies whose residual or correction is above the limit; the particles if both are.
std::string CoupledStep::convergence_error(ImplicitStep& step, const Iteration& last, int iterations) const {
  const Integrator& limits = model_.integrator;
  const auto trouble = [&](const char* stage, const std::string& what) {
    return fmt::format("stage {}: no convergence in {} iterations; {}", stage, iterations, what);
  };
  if (!(last.residual <= limits.residual_tolerance))
    return trouble("particle_correct",
                   fmt::format("the largest residual, {:.2e} of the largest force, occurs at particle {}",
                               last.residual, step.worst_particle()));
  if (!(last.bodies.residual <= limits.residual_tolerance))
    return trouble("mbs_correct", fmt::format("the bodies' scaled residual is {:.2e}{}", last.bodies.residual,
                                              body_coupling_.trouble()));
  if (!(last.bodies.correction <= limits.correction_tolerance))
    return trouble("mbs_correct", fmt::format("the bodies' last scaled correction is {:.2e}{}",
                                              last.bodies.correction, body_coupling_.trouble()));
  return trouble("particle_correct",
                 fmt::format("the last correction of the particles' positions is {:.2e} of a radius",
                             last.judged_correction));
}

// One Newton-like iteration of particles and bodies. The bodies are corrected first, and the particles use
// the correction: block Gauss-Seidel on the coupled Newton system.
bool CoupledStep::iterate_once(ImplicitStep& step, Iteration& last, bool final) {
  const Integrator& limits = model_.integrator;
  ParticleNorms particles;
  {
    const auto scope = timers_.time(Stage::contact_force);
    particles = step.contact_force();
    last.residual = particles.residual;
    last.judged_correction = std::min(last.correction, particles.correction_bound);
    if (particles.overshoot) {
      step.shorten_correction();
      return false;
    }
  }
  bool bodies_done = true;
  if (body_coupling_.has_parents()) {
    const auto scope = timers_.time(Stage::reduce_wrench);
    body_coupling_.reduce_wrench(step);
  }
  if (body_coupling_.has_bodies()) {
    {
      const auto scope = timers_.time(Stage::mbs_correct);
      last.bodies = body_coupling_.correct();
      bodies_done = last.bodies.residual <= limits.residual_tolerance &&
                    last.bodies.correction <= limits.correction_tolerance;
    }
  }
  // Also without a correction of bodies, because walls must not count as moved by one.
  if (body_coupling_.parents_move()) {
    const auto scope = timers_.time(Stage::broadcast_motion);
    body_coupling_.broadcast_motion(backend_.list());
  }
  const bool within = last.residual <= limits.residual_tolerance;
  const bool particles_done = (within && last.judged_correction <= limits.correction_tolerance) ||
                              (final && last.judged_correction <= kRoundOffMove);
  if (bodies_done && particles_done) return true;

  const auto scope = timers_.time(Stage::particle_correct);
  const ParticleCorrection correction = step.particle_correct();
  last.correction = correction.correction;
  counts_.linear_iterations += correction.iterations;
  return false;
}

}  // namespace scree
