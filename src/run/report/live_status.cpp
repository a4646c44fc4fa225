#include "run/report/live_status.hpp"

#include "base/error.hpp"
#include "base/utc.hpp"
#include "output/lock_owner.hpp"
#include "run/report/balance.hpp"

namespace scree {
namespace {

constexpr double kUpdateSeconds = 0.25;  // between progress lines on a terminal
// Between progress lines in a log, in addition to one per tenth of the run.
constexpr double kLogSeconds = 600;
// Between writes of history and status, in addition to those with checkpoints.
constexpr double kFlushSeconds = 5;

double seconds_between(std::chrono::steady_clock::time_point one, std::chrono::steady_clock::time_point two) {
  return std::chrono::duration<double>(two - one).count();
}

}  // namespace

LiveStatus::LiveStatus(const Model& model, const RunOptions& options, const std::string& backend, Log& log)
    : model_(model), options_(options), log_(log) {
  const LockOwner self = LockOwner::this_process();
  status_.host = self.host, status_.process = self.process, status_.started = self.since;
  status_.deck = options.deck_path, status_.backend = backend, status_.ranks = options.ranks.size();
  status_.progress.end = model.time.end;
}

double LiveStatus::wall_seconds() const { return seconds_between(start_, Clock::now()); }

void LiveStatus::begin(const State& state) {
  start_time_ = state.clock.time;
  last_poll_ = Clock::now();
  add_to_rate(state);
}

void LiveStatus::add_to_rate(const State& state) {
  rate_.add(seconds_between(start_, last_poll_), state.counts.steps, state.clock.time);
}

void LiveStatus::take(const State& state, std::int64_t contacts) {
  Progress& now = status_.progress;
  now.time = state.clock.time, now.steps = state.counts.steps;
  now.particles = particles_so_far(model_.particles, state.population) - state.carried_out.left -
                  state.outlets.removed_of_all();
  now.contacts = contacts;
  now.balance_error = balance_error(state.balance), now.exchanged = state.balance.exchanged;
  now.step_rate = rate_.steps_per_second();
  now.particle_step_rate = now.step_rate * model_.integrator.substeps * static_cast<double>(now.particles);
  now.seconds_left = (now.end - now.time) / rate_.time_per_second();
}

bool LiveStatus::poll(const State& state, Real h, std::int64_t contacts) {
  const Clock::time_point now = Clock::now();
  const Real share = (state.clock.time - start_time_) / (model_.time.end - start_time_);
  const int tenths = static_cast<int>(10 * share);
  if (seconds_between(last_poll_, now) < kUpdateSeconds && tenths == tenths_reported_) return false;
  last_poll_ = now;
  status_.progress.step = h;
  add_to_rate(state);
  take(state, contacts);
  const bool logged = tenths != tenths_reported_ || seconds_between(last_logged_, now) > kLogSeconds;
  log_.progress(progress_line(status_.progress), logged);
  if (logged) tenths_reported_ = tenths, last_logged_ = now;
  const bool flush = seconds_between(last_flush_, now) > kFlushSeconds;
  if (flush) last_flush_ = now;
  return flush;
}

void LiveStatus::checkpoint_written(const std::string& name, Real time) {
  status_.checkpoint = name, status_.checkpoint_time = time, status_.checkpoint_written = utc_now();
}

void LiveStatus::write(const std::string& word, const State& state, std::int64_t contacts,
                       std::int64_t snapshots) {
  if (!options_.ranks.is_root()) return;
  status_.state = word, status_.written = utc_now();
  status_.wall_seconds = wall_seconds();
  take(state, contacts);
  status_.snapshots = snapshots, status_.history_rows = state.history_rows;
  status_.warnings = log_.warnings();
  try {
    write_status(options_.output_directory, status_);
  } catch (const IoError&) {
  }
}

}  // namespace scree
