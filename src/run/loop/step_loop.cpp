#include "run/loop/step_loop.hpp"

#include <algorithm>
#include <chrono>

#include "base/error.hpp"
#include "base/index.hpp"
#include "dem/particles/particle_store.hpp"
#include "run/report/balance.hpp"
#include "run/report/signals.hpp"

namespace scree {
namespace {

// Share of the run's time that copies of a good state of an explicit run may take.
constexpr double kSaveTimeShare = 0.02;
// Explicit steps are taken in batches of about this duration [s], and of at most so many substeps.
constexpr double kBatchSeconds = 0.2, kMostSubsteps = 1e6;
// Batches in mixed precision, given by numbers of the deck alone: substeps times particles in a batch, about
// 0.07 s on one H200; a number of particles added for the launch overhead of small models; and the least
// number of substeps, 0.6 s for particles that fill the GPU's memory.
constexpr double kMixedBatch = 1e9, kMixedIdle = 1e5, kFewestMixed = 32;

}  // namespace

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// In mixed precision a batch evaluates the forces of its last step in double. If a clock determined that
// step, a rerun would give other bits; therefore the deck alone does. With bodies the host's work may
// dominate, and the batch is short.
std::size_t batch_length(const Model& model, bool mixed, double step_seconds) {
  const double substeps = model.integrator.substeps;
  double steps = kBatchSeconds / step_seconds;
  if (mixed) {
    const auto particles = static_cast<double>(model.particles.totals.count);
    const double most = model.bodies.empty() ? kMixedBatch / (kMixedIdle + particles) : 0;
    steps = std::max(most, kFewestMixed) / substeps;
  }
  return static_cast<std::size_t>(std::clamp(steps, 1.0, kMostSubsteps / substeps));
}

StepLoop::StepLoop(const LoopParts& parts, State& state, std::function<void(State&)> write_checkpoint,
                   std::function<void(const State&, Real)> progress)
    : parts_(parts),
      state_(state),
      clock_(parts.model, state.clock),
      write_checkpoint_(std::move(write_checkpoint)),
      progress_(std::move(progress)),
      implicit_(parts.model.integrator.particles == ParticleIntegrator::hht) {
  save_good_state();
}

LoopEnd StepLoop::run(Real until) {
  checkpoint_age_ = parts_.seconds();
  while (!clock_.done()) {
    if (parts_.records.should_end()) return LoopEnd::stop_condition;
    if (clock_.time() >= until) return LoopEnd::paused;
    if (poll_requests() != 0) return LoopEnd::stopped_by_signal;
    take_recorded_step(until);
  }
  return parts_.records.should_end() ? LoopEnd::stop_condition : LoopEnd::done;
}

void StepLoop::take_recorded_step(Real until) {
  if (parts_.timeline != nullptr) parts_.timeline->before_steps(parts_.step.counts().steps);
  take_step(until);
  if (parts_.timeline != nullptr) parts_.timeline->after_steps(parts_.step.counts().steps);
}

// Handles requests between two steps, the same on all ranks: a signal on any rank, or a checkpoint that rank
// 0's clock requests. The state is complete here, so that a checkpoint does not change the steps.
int StepLoop::poll_requests() {
  const Real interval = parts_.model.output.checkpoint_wall_interval;
  const bool due = interval > 0 && ranks().is_root() && parts_.seconds() - checkpoint_age_ >= interval;
  Real wanted[] = {static_cast<Real>(signal_received()), due ? Real(1) : Real(0)};
  ranks().max(wanted);
  signal_ = static_cast<int>(wanted[0]);
  if (signal_ == 0 && wanted[1] != 0) {
    const auto scope = parts_.timers.time(Stage::output);
    write_checkpoint();
  }
  return signal_;
}

void StepLoop::write_checkpoint() {
  write_checkpoint_(complete_state());
  checkpoint_age_ = parts_.seconds();
}

void StepLoop::take_step(Real until) {
  const Real h = clock_.begin_step();
  next_sample_ = next_energy_sample(parts_.step.counts().steps, implicit_);
  if (!implicit_) return take_explicit_steps(h, until);
  const StepOutcome outcome = parts_.step.implicit_step(state_.bodies, clock_.time(), h);
  if (outcome.verdict != Verdict::accepted) return reject(outcome);
  clock_.accepted(outcome.error);
  close_step(h);
}

// If a step cannot be shortened further, the reason may be a dead point of a driver, which no step length
// resolves.
void StepLoop::reject(const StepOutcome& outcome) {
  try {
    if (outcome.verdict == Verdict::inaccurate) return clock_.rejected_for_error(outcome.error);
    clock_.rejected_for_convergence(outcome.trouble);
  } catch (const SimulationError&) {
    const std::string dead_point = parts_.step.dead_point();
    if (dead_point.empty()) throw;
    throw SimulationError("stage mbs_correct: " + dead_point);
  }
}

// Takes equal steps up to the next output, until signals and progress are due, and none that begins at
// `until` or later. A batch ends where the energies are sampled. Not so in mixed precision, where the ends of
// batches affect the bits: there the energies are sampled at the end of the batch. A step that reaches an
// instant of inserters or outlets is the last one of its batch.
void StepLoop::take_explicit_steps(Real h, Real until) {
  const bool mixed = parts_.backend.is_mixed();
  std::size_t most = batch_length(parts_.model, mixed, step_seconds_);
  const std::int64_t steps = parts_.step.counts().steps;
  if (!mixed) most = std::min(most, as_size(next_sample_ - steps));
  if (!mixed && parts_.timeline != nullptr)
    most = std::min(most, as_size(parts_.timeline->most_steps(steps)));
  std::vector<Real> times = clock_.equal_steps(most);
  const Real stop = std::min(until, next_change());
  times.erase(std::lower_bound(times.begin() + 1, times.end(), stop), times.end());
  const double start = parts_.seconds();
  const std::size_t taken = parts_.step.explicit_steps(state_.bodies, times, h, clock_.end_of(times.size()));
  step_seconds_ = (parts_.seconds() - start) / static_cast<double>(taken);
  ranks().broadcast(step_seconds_);  // the ranks' clocks differ
  for (std::size_t k = 0; k < taken; ++k) clock_.accepted(0);
  close_step(h);
}

void StepLoop::close_step(Real h) {
  state_.clock = clock_.state();
  const bool left = leave(), inserted = insert();
  if (left || inserted) parts_.step.rebuild_list();  // measures stages of its own
  output(h);
}

// Handles particles outside the domain: an error, or no contact detection from the next step on; and removes
// those in outlets. Returns whether there are any.
bool StepLoop::leave() {
  const auto scope = parts_.timers.time(Stage::migrate);
  Outlets::Open open;
  if (parts_.outlets != nullptr)
    open = parts_.outlets->open_at(clock_.time(), parts_.link.motion(), state_.outlets);
  const std::vector<EscapedParticle> escaped_particles = parts_.step.check_inside(open.regions);
  if (escaped_particles.empty()) return false;
  if (parts_.outlets != nullptr) parts_.outlets->account(escaped_particles, open, state_.outlets);
  parts_.leaving(escaped_particles);
  parts_.backend.particles().remove_escaped(escaped_particles);
  account_escaped(escaped_particles, parts_.model.space.leaving, state_.carried_out);
  return true;
}

// Adds the particles that are born at the end of the step. Returns whether there are any.
bool StepLoop::insert() {
  if (parts_.births == nullptr) return false;
  const auto scope = parts_.timers.time(Stage::migrate);
  RankParticles& particles = parts_.backend.particles();
  const std::vector<Particle> born =
      parts_.births->births_at(clock_.time(), parts_.link.motion(), particles, state_.population);
  if (!born.empty()) particles.insert(born);
  return !born.empty();
}

// The next instant at which inserters or outlets may change the particles [s].
Real StepLoop::next_change() const {
  const Real births = parts_.births != nullptr ? parts_.births->next(state_.population) : kInfinity;
  return parts_.outlets != nullptr ? std::min(births, parts_.outlets->next(state_.outlets)) : births;
}

void StepLoop::output(Real h) {
  const auto scope = parts_.timers.time(Stage::output);
  state_.counts = parts_.step.counts();
  const bool history = clock_.take_history(), snapshot = clock_.take_snapshot(),
             checkpoint = clock_.take_checkpoint();
  state_.clock = clock_.state();
  {
    const Reports::Instant now(parts_.backend.reports());
    if (state_.counts.steps >= next_sample_) parts_.records.sample_energies(state_);
    if (history) parts_.records.history(state_, h);
    if (snapshot || parts_.records.should_end()) parts_.records.snapshot(state_);
  }
  if (checkpoint) write_checkpoint();
  progress_(state_, h);
  bool stale = !implicit_ && parts_.seconds() - saved_at_ > save_seconds_ / kSaveTimeShare;
  if (!implicit_) ranks().broadcast(stale);
  if (stale) save_good_state();
}

void StepLoop::save_good_state() {
  if (implicit_) return;
  const double start = parts_.seconds();
  parts_.records.write_pending();  // so that the copy counts the snapshot even if the backend fails before it
                                   // is written
  good_.reset();                   // one copy at a time
  std::vector<Particle> particles = std::move(complete_state().particles);
  PackedHistory contacts = std::move(state_.contacts);
  std::vector<std::int64_t> works = std::move(state_.works);
  state_.particles = {}, state_.contacts = {}, state_.works = {};
  good_ = state_;
  good_->particles = std::move(particles), good_->contacts = std::move(contacts);
  good_->works = std::move(works);
  saved_at_ = parts_.seconds();
  save_seconds_ = saved_at_ - start;
}

State& StepLoop::complete_state() {
  state_.clock = clock_.state();
  state_.counts = parts_.step.counts();
  state_.particles = parts_.backend.particles().records();
  state_.there = fields_there(parts_.model);
  state_.contacts = parts_.backend.particles().contacts();
  state_.shapes = parts_.backend.particles().shape_losses();
  state_.shape_contacts = parts_.backend.particles().shape_contacts();
  state_.works = parts_.backend.particles().works();
  return state_;
}

State& StepLoop::last_saved_state() { return good_ ? *good_ : complete_state(); }

}  // namespace scree
