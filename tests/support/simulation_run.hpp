// A model that runs in memory: the parts and the order of src/run, without its files.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "base/error.hpp"
#include "coupling/ledger.hpp"
#include "run/state.hpp"
#include "run/target_contacts.hpp"
#include "support/backends.hpp"
#include "support/petsc_run.hpp"

namespace scree {

class SimulationRun {
 public:
  // Starts at t = 0.
  explicit SimulationRun(const Model& model) : SimulationRun(model, true) {
    state_.clock = clock_.state();
    backend_->load(initial_records(model_.particles, Subdomain(model_.space)), {});
    step_.start(state_.bodies);
    state_.balance = {true, ledger().accounted(), 0, ledger()};
  }
  // Continues from a state that complete_state() returned, of this model.
  SimulationRun(const Model& model, const State& state) : SimulationRun(model, true) {
    state_ = state;
    clock_ = StepClock(model_, state.clock);
    backend_->load(state_.particles, state_.shapes);
    step_.counts() = state_.counts;
    step_.resume(state_.bodies);
  }
  SimulationRun(const SimulationRun&) = delete;
  SimulationRun& operator=(const SimulationRun&) = delete;

  // One accepted step; its length [s]. Throws SimulationError as the run does.
  Real step() {
    for (;;) {
      const Real h = clock_.begin_step();
      StepOutcome outcome;
      if (model_.integrator.particles == ParticleIntegrator::hht) {
        outcome = step_.implicit_step(state_.bodies, clock_.time(), h);
      } else {
        step_.explicit_steps(state_.bodies, {clock_.time()}, h);
      }
      if (outcome.verdict == Verdict::accepted) {
        clock_.accepted(outcome.error);
        leave();
        return h;
      }
      if (outcome.verdict == Verdict::inaccurate) clock_.rejected_for_error(outcome.error);
      if (outcome.verdict == Verdict::not_converged) clock_.rejected_for_convergence(outcome.trouble);
    }
  }
  // Steps until time.end; each history sample books the balance and calls at_history.
  void run(const std::function<void()>& at_history = [] {}) {
    while (!clock_.done()) step_and_sample(at_history);
  }
  // As run(), until the step that reaches time t [s].
  void run_until(
      Real t, const std::function<void()>& at_history = [] {}) {
    while (clock_.time() < t) step_and_sample(at_history);
  }

  Real time() const { return clock_.time(); }
  const StepCounts& counts() const { return step_.counts(); }
  const MultibodyState& bodies() const { return state_.bodies; }
  const Multibody& multibody() const { return *link_.multibody(); }
  std::vector<Particle> particles() const { return backend_->records(); }  // ordered by global id
  ParticleLedger particle_ledger() { return backend_->ledger(verlet_step()); }
  Ledger ledger() {
    return make_ledger(particle_ledger(), state_.carried_out, link_.multibody(), state_.bodies,
                       clock_.time());
  }
  // What a history row holds of the contacts that the model records.
  std::vector<Real> contact_values() {
    std::vector<Real> values;
    for (const ContactSum& sum : target_contacts(model_, link_, state_, *backend_))
      values.insert(values.end(), {sum.force.x, sum.force.y, sum.force.z, sum.torque.x, sum.torque.y,
                                   sum.torque.z, static_cast<Real>(sum.contacts)});
    return values;
  }
  // Of the samples so far: what the ledger fails to account for, and what has changed its place [J].
  Real balance_error() const { return state_.balance.last.accounted() - state_.balance.start; }
  Real exchanged() const { return state_.balance.exchanged; }
  const State& complete_state() {
    state_.clock = clock_.state();
    state_.counts = step_.counts();
    state_.particles = backend_->records();
    state_.shapes = backend_->shape_losses();
    return state_;
  }

 private:
  // PETSc and MPI start before the bodies' solver is made.
  SimulationRun(const Model& model, bool)
      : model_((petsc(), model)),
        backend_(make_test_backend(model_)),
        link_(model_),
        step_(model_, *backend_, link_, timers_),
        clock_(model_) {}

  Real verlet_step() const {
    const bool verlet = model_.integrator.particles == ParticleIntegrator::velocity_verlet;
    return verlet ? model_.time.step / model_.integrator.substeps : 0;
  }
  void leave() {
    const std::vector<Leaver> leavers = step_.check_inside();
    if (leavers.empty()) return;
    book_leavers(leavers, model_.space.leaving, state_.carried_out);
    backend_->take_out(leavers);
    step_.rebuild_list(model_.contact.skin);
  }
  void step_and_sample(const std::function<void()>& at_history) {
    step();
    const bool history = clock_.take_history();
    clock_.take_snapshot(), clock_.take_checkpoint();
    if (!history) return;
    const Ledger now = ledger();
    state_.balance.exchanged += energy_exchanged(state_.balance.last, now);
    state_.balance.last = now;
    at_history();
  }

  const Model model_;
  State state_;
  StageTimers timers_;
  std::unique_ptr<Backend> backend_;
  BodyLink link_;
  CoupledStep step_;
  StepClock clock_;
};

}  // namespace scree
