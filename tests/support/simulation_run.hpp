// A model that runs in memory: the step loop and its data, without files.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "coupling/ledger.hpp"
#include "dem/particles/particle_store.hpp"
#include "run/loop/step_loop.hpp"
#include "run/record/target_contacts.hpp"
#include "run/report/balance.hpp"
#include "support/backends.hpp"
#include "support/petsc_run.hpp"

namespace scree {

// Accounts for the energies and counts the outputs.
class MemoryRecords : public Records {
 public:
  // particles, ledger: of the instant.
  MemoryRecords(std::function<ParticleLedger()> particles, std::function<Ledger()> ledger)
      : particles_(std::move(particles)), ledger_(std::move(ledger)) {}
  void sample_energies(State& state) override { add_sample(state.balance, now(state)); }
  void history(State& state, Real) override {
    const Ledger ledger = inside_ledger(ledger_(), particles_(), state.carried_out);
    if (state.balance.open) exchanged_ += exchanged_energy(state.balance.last, ledger);
    add_row(state.balance, ledger, now(state), state.bodies);
    ++state.history_rows;
    at_history();
  }
  void snapshot(State& state) override { ++state.snapshots; }
  void write_pending() override {}

  std::function<void()> at_history = [] {};
  Real exchanged() const { return exchanged_; }

 private:
  EnergyExtremes now(const State& state) const {
    return extremes_at(particles_().inside.kinetic, ledger_().elastic_force_elements, state.bodies);
  }
  // Half the sum of the changes of all entries [J].
  static Real exchanged_energy(const Ledger& before, const Ledger& after) {
    const auto a = before.entries(), b = after.entries();
    Real sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += std::abs(b[k] - a[k]);
    return sum / 2;
  }

  std::function<ParticleLedger()> particles_;
  std::function<Ledger()> ledger_;
  Real exchanged_ = 0;
};

class SimulationRun {
 public:
  // Starts at t = 0.
  explicit SimulationRun(const Model& model) : SimulationRun(model, true) {
    state_.clock = StepClock(model_).state();
    backend_->particles().load(initial_records(model_.particles, Subdomain(model_.space)), {});
    step_.start(state_.bodies);
    records_.history(state_, 0), records_.snapshot(state_);
    make_loop();
  }
  // Continues from a state of this model that complete_state() returned.
  SimulationRun(const Model& model, const State& state) : SimulationRun(model, true) {
    state_ = state;
    backend_->particles().load(std::exchange(state_.particles, {}), state_.shapes);
    backend_->particles().load_contacts(state_.contacts);
    backend_->particles().load_shape_contacts(state_.shape_contacts);
    backend_->particles().load_works(state_.works);
    step_.counts() = state_.counts;
    step_.resume(state_.bodies, state_.clock.time);
    make_loop();
  }
  SimulationRun(const SimulationRun&) = delete;
  SimulationRun& operator=(const SimulationRun&) = delete;

  // Steps until time.end; calls at_history after each history sample. Throws SimulationError as the run
  // does.
  void run(const std::function<void()>& at_history = [] {}) { run_until(kInfinity, at_history); }
  // Runs as run() does, until the step that reaches time t [s].
  void run_until(
      Real t, const std::function<void()>& at_history = [] {}) {
    records_.at_history = at_history;
    loop_->run(t);
    records_.at_history = [] {};
  }
  // Takes one accepted step; returns its length [s].
  Real step() {
    loop_->run(std::nextafter(time(), kInfinity));
    return last_step_;
  }

  Real time() const { return state_.clock.time; }
  const StepCounts& counts() const { return step_.counts(); }
  const MultibodyState& bodies() const { return state_.bodies; }
  const Multibody& multibody() const { return *body_coupling_.multibody(); }
  std::vector<Particle> particles() const { return backend_->particles().records(); }  // ordered by global id
  ParticleLedger particle_ledger() { return backend_->reports().ledger(verlet_step(model_)); }
  Ledger ledger() {
    return make_ledger(particle_ledger(), state_.carried_out, body_coupling_.multibody(), state_.bodies,
                       time());
  }
  // The columns of a history row for the recorded contacts.
  std::vector<Real> contact_values() {
    std::vector<Real> values;
    for (const ContactSum& sum : target_contacts(model_, body_coupling_, state_, *backend_))
      values.insert(values.end(), {sum.force.x, sum.force.y, sum.force.z, sum.torque.x, sum.torque.y,
                                   sum.torque.z, static_cast<Real>(sum.contacts)});
    return values;
  }
  // At the last row: the energy that the ledger fails to account for, and the energy exchanged between its
  // entries from row to row [J]. The latter is the reference of errors in tests; it counts from where this
  // run began, and grows with the number of rows. A run uses balance().exchanged.
  Real balance_error() const { return scree::balance_error(state_.balance); }
  Real exchanged() const { return records_.exchanged(); }
  const BalanceState& balance() const { return state_.balance; }
  const State& complete_state() { return loop_->complete_state(); }

 private:
  // PETSc and MPI start before the bodies' solver is made.
  SimulationRun(const Model& model, bool)
      : model_((petsc(), model)),
        backend_(make_test_backend(model_)),
        body_coupling_(model_),
        step_(model_, *backend_, body_coupling_, timers_),
        records_([this] { return particle_ledger(); }, [this] { return ledger(); }) {}

  void make_loop() {
    // By this clock everything takes 10 ms: batches of explicit steps end at the same steps on any machine.
    const LoopParts parts{
        model_, *backend_, body_coupling_, step_, records_, timers_, [this] { return now_ += 0.01; }};
    loop_.emplace(
        parts, state_, [](State&) {}, [this](const State&, Real h) { last_step_ = h; });
  }

  const Model model_;
  State state_;
  StageTimers timers_;
  std::unique_ptr<Backend> backend_;
  BodyCoupling body_coupling_;
  CoupledStep step_;
  MemoryRecords records_;
  std::optional<StepLoop> loop_;
  Real last_step_ = 0;
  double now_ = 0;  // [s]
};

}  // namespace scree
