// Explicit steps of particles and bodies.
#include <fmt/format.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "coupling/coupled_step.hpp"

namespace scree {
namespace {

// Iterations of a step of loaded bodies that evaluate the contacts. If contacts open and close from one
// iteration to the next, the further iterations use the slope estimated so far.
constexpr int kMostEvaluations = 20;

// sum += weight * wrenches
void add_wrenches(std::vector<BodyWrench>& sum, const std::vector<BodyWrench>& wrenches, Real weight) {
  for (std::size_t b = 0; b < wrenches.size(); ++b) {
    sum[b].force += weight * wrenches[b].force;
    sum[b].torque += weight * wrenches[b].torque;
  }
}

// Whether the wrench follows the contacts at the position of this iteration.
bool follows(const BodyIterations& iterations) {
  return iterations.loaded && iterations.count <= kMostEvaluations;
}

}  // namespace

std::size_t CoupledStep::explicit_steps(MultibodyState& bodies, const std::vector<Real>& times, Real h,
                                        Real end) {
  const int substeps = model_.integrator.substeps;
  std::unique_ptr<ExplicitRun> run;
  {
    const auto scope = timers_.time(Stage::predict);
    run = backend_.start_run(h / substeps);
  }
  std::size_t taken = 0;
  if (!body_coupling_.has_bodies() && body_coupling_.has_driven_walls()) {
    taken = driven_steps(*run, bodies, instants_of(times, h, end));
  } else if (body_coupling_.has_bodies()) {
    for (bool open = true; open; ++taken) {
      const bool last = taken + 1 == times.size();
      open = explicit_step(*run, bodies, {times[taken], h, last ? end : times[taken + 1], !last});
    }
    body_coupling_.throw_deferred();
  } else {
    const Index most = as_index(times.size()) * substeps;
    taken = as_size(run->take_steps(most, false, timers_).closed / substeps);
  }
  counts_.steps += static_cast<std::int64_t>(taken);
  return taken;
}

// Returns whether the particles' next step is open. If the contacts are stiff for the bodies, the bodies take
// the particles' steps: their step ends with the substep that finds this, and every following substep is a
// step of the bodies. Until then the two cases do not differ.
bool CoupledStep::explicit_step(ExplicitRun& run, MultibodyState& bodies, const ExplicitStep& step) {
  const int all = model_.integrator.substeps;
  bool open = true;
  for (int done = 0; done < all;) {
    BodyStep part{step.t + step.h * done / all, step.h, step.end, done, done};
    open = explicit_substeps(run, bodies, step, part);
    if (part.last < all) part.h = step.h * (part.last - part.first) / all;
    solve_bodies(run, bodies, part);
    done = part.last;
  }
  return open;
}

// Takes the substeps of a part and sets its end. While the contacts of the last substep are evaluated, rank 0
// opens the bodies' step.
bool CoupledStep::explicit_substeps(ExplicitRun& run, MultibodyState& bodies, const ExplicitStep& step,
                                    BodyStep& part) {
  const int substeps = model_.integrator.substeps;
  const std::vector<BodyWrench> start = bodies.wrench;
  std::vector<BodyWrench>& sum = wrench_sum_;
  sum.assign(body_coupling_.end_wrench().size(), BodyWrench{});
  add_wrenches(sum, start, 0.5);
  bool open = true;
  for (bool last = false; !last;) {
    const int s = ++part.last;
    const Real tau = step.h * (s - part.first) / substeps, before = part.end_of_last;
    part.end = s < substeps ? step.t + step.h * s / substeps : step.end;
    {
      const auto scope = timers_.time(Stage::broadcast_motion);
      body_coupling_.broadcast_motion(backend_.list(), bodies, tau, part.end);
    }
    if (s == substeps) {
      if (part.first > 0) part.h = step.h * (substeps - part.first) / substeps;
      run.set_work([&] {
        body_coupling_.predict_ahead(bodies, part.t, part.h, part.end);
        part.predicted = true;
      });
    }
    open = run.take_steps(1, s < substeps || step.keep_open, timers_).open;
    const auto scope = timers_.time(Stage::reduce_wrench);
    body_coupling_.reduce_end_wrench(run);
    last = s == substeps || body_coupling_.is_loaded(step.h);
    add_wrenches(sum, body_coupling_.end_wrench(), last ? 0.5 : 1);
    body_coupling_.account_walls(bodies, before, part.end, body_coupling_.end_wrench());
    part.end_of_last = part.end;
  }
  body_coupling_.set_mean_wrench(start, sum, part.last - part.first);
  return open;
}

// The bodies' own Newton loop, with the impulse of the particles' substeps. The step ends, and the next one
// begins, with the contacts at the bodies' corrected position. For loaded bodies every iteration evaluates
// the contacts at the position that it has reached, and the wrench follows.
void CoupledStep::solve_bodies(ExplicitRun& run, MultibodyState& bodies, const BodyStep& step) {
  BodyIterations iterations;
  iterations.loaded = body_coupling_.is_loaded_on_root(step.h);
  {
    const auto scope = timers_.time(Stage::mbs_correct);
    run.do_work();
    body_coupling_.defer([&] {
      if (!step.predicted) body_coupling_.predict(bodies, step.t, step.h, step.end);
      if (iterations.loaded) body_coupling_.open_loaded(step.h);
    });
  }
  while (!iterations.last) {
    {
      const auto scope = timers_.time(Stage::mbs_correct);
      body_coupling_.defer([&] { correct_bodies(iterations); });
    }
    evaluate_contacts(run, bodies, iterations);
    if (follows(iterations)) body_coupling_.defer([&] { body_coupling_.follow_load(true); });
  }
  counts_.newton_iterations += iterations.count;
  const auto scope = timers_.time(Stage::accept);
  run.do_work();
  body_coupling_.accept(bodies, true);
  if (iterations.loaded) body_coupling_.defer([&] { body_coupling_.average_accelerations(bodies); });
}

// On rank 0: iterates until the contacts must be evaluated at the corrected position.
void CoupledStep::correct_bodies(BodyIterations& iterations) {
  const Integrator& limits = model_.integrator;
  do {
    if (iterations.count == limits.max_iterations)
      throw SimulationError(
          fmt::format("stage mbs_correct: the bodies' motion did not converge in {} iterations{}",
                      limits.max_iterations, body_coupling_.trouble_on_root()));
    ++iterations.count;
    const IterationNorms norms = body_coupling_.correct_on_root();
    iterations.last =
        norms.residual <= limits.residual_tolerance && norms.correction <= limits.correction_tolerance;
    if (follows(iterations)) return;
    if (iterations.loaded) body_coupling_.follow_load(false);
  } while (!iterations.last);
}

// Evaluates the contacts with the bodies at their last corrected position. Meanwhile rank 0 does what closes
// the bodies' step, if it is the last one.
void CoupledStep::evaluate_contacts(ExplicitRun& run, const MultibodyState& bodies,
                                    BodyIterations& iterations) {
  {
    const auto scope = timers_.time(Stage::broadcast_motion);
    body_coupling_.broadcast_motion(backend_.list(), iterations);
  }
  const auto scope = timers_.time(Stage::reduce_wrench);
  if (iterations.last) run.set_work([&] { body_coupling_.begin_accept(bodies); });
  run.shape_contacts();
  body_coupling_.reduce_end_wrench(run);
}

}  // namespace scree
