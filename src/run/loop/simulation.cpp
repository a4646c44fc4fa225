#include "run/loop/simulation.hpp"

#include <fmt/format.h>

#include <span>

#include "base/utc.hpp"
#include "dem/backend/device.hpp"
#include "dem/particles/particle_store.hpp"
#include "dem/reports/triangle_works.hpp"
#include "dem/search/skin_choice.hpp"
#include "model/checks/memory.hpp"
#include "output/results_folder.hpp"
#include "output/run_record.hpp"
#include "partition/id_order.hpp"
#include "run/loop/choose_backend.hpp"
#include "run/loop/step_loop.hpp"
#include "run/record/recorder.hpp"
#include "run/record/timeline.hpp"
#include "run/report/balance.hpp"
#include "run/report/bodies_outside.hpp"
#include "run/report/live_status.hpp"
#include "run/report/summary.hpp"
#include "run/report/surfaces_outside.hpp"
#include "run/restart/finished_run.hpp"
#include "run/restart/restart.hpp"
#include "run/state/start_record.hpp"

namespace scree {
namespace {

class Simulation {
 public:
  Simulation(const Model& model, const RunOptions& options, Log& log)
      : model_(model),
        options_(options),
        ranks_(options.ranks),
        log_(log),
        folder_({options.output_directory, options.restart, options.overwrite}),
        restart_(options.restart.empty() ? Restart{} : read_restart(model, options, log)),
        state_(std::move(restart_.state)),
        backend_(choose_backend(model, ranks_, options.backend, log)),
        body_coupling_(model, ranks_),
        step_(model, *backend_, body_coupling_, timers_),
        births_(model),
        outlets_(model),
        live_(model, options, backend_->description(), log),
        book_(restart_.starts, state_, live_.started(), backend_->description(), ranks_.size()),
        surfaces_outside_(model) {
    ranks_.on_root([&] { folder_.claim(); });
    start_or_resume();
    ranks_.on_root([&] { folder_.clear(); });
    prepare_timeline();
    recorder_ =
        std::make_unique<Recorder>(model, *backend_, body_coupling_, options.output_directory, state_);
    if (restart_.changed) recorder_->rebase_balance(state_);
    recorder_->find_stop(state_);
    report_stop(recorder_->stop_reason(), options, log);
    // A restart of a finished run into a new folder records its state there.
    const bool is_done = StepClock(model, state_.clock).done() || recorder_->should_end();
    if (options.restart.empty() || (is_done && state_.history_rows == 0)) {
      const Reports::Instant now(backend_->reports());
      recorder_->history(state_, 0);
      recorder_->snapshot(state_);
      ranks_.on_root([&] { recorder_->flush_history(); });
    }
  }

  ExitCode run();

 private:
  ExitCode run_to_the_end();
  void start_or_resume();
  void load_state();
  void insert_at_start();
  void prepare_timeline();
  std::string start_change() const;
  bool continues_files() const;
  void bring_into_id_order(State& state, GlobalId bound) const;
  // Moves the state's particles out.
  void checkpoint(State& state, const std::string& name);
  void progress(const State& state, Real h);
  void show_status(const std::string& status);
  void watch_bodies(const State& state);
  void watch_escaped_particles(const std::vector<EscapedParticle>& escaped_particles);
  ExitCode fail(StepLoop& loop, const SimulationError& error);
  void save_last_good_state(StepLoop& loop);
  ExitCode finish(const std::string& status, ExitCode code);
  void write_record(const std::string& status, ExitCode code);
  void record_failure(const std::string& why, ExitCode code);
  void summarize() const;

  const Model& model_;
  const RunOptions& options_;
  Ranks ranks_;
  Log& log_;
  ResultsFolder folder_;
  Restart restart_;  // without its state
  State state_;
  std::unique_ptr<Timeline> timeline_;  // if the command line wants one
  StageTimers timers_;
  std::unique_ptr<Backend> backend_;
  BodyCoupling body_coupling_;
  CoupledStep step_;
  const Births births_;
  const Outlets outlets_;
  std::unique_ptr<Recorder> recorder_;
  LiveStatus live_;
  StartRecord book_;
  bool body_left_ = false, load_lost_ = false, overloaded_ = false;
  const SurfacesOutside surfaces_outside_;
  std::string state_hash_;
  std::int64_t list_entries_ = 0, migrated_ = 0, device_bytes_ = 0;  // sums over the ranks
};

void Simulation::start_or_resume() {
  if (options_.restart.empty()) {
    state_.clock = StepClock(model_).state();
    backend_->particles().load(initial_records(model_.particles, Subdomain(model_.space)), {});
    step_.start(state_.bodies);
    insert_at_start();
    for (const std::string& finding : body_coupling_.start_warnings()) log_.warning(finding);
    for (const std::string& line : start_lines(body_coupling_.multibody())) log_.info(line);
  } else {
    load_state();
    step_.counts() = state_.counts;
    check_end(StepClock(model_, state_.clock), model_.time, options_, log_);
    if (!continues_files()) state_.history_rows = state_.snapshots = 0;
    step_.resume(state_.bodies, state_.clock.time);
    if (restart_.forces_changed) step_.renew_forces(state_.bodies, state_.clock.time);
  }
}

// Births at t = 0.
void Simulation::insert_at_start() {
  state_.population = births_.start(), state_.outlets = outlets_.start();
  const std::vector<Particle> born =
      births_.births_at(state_.clock.time, body_coupling_.motion(), backend_->particles(), state_.population);
  if (born.empty()) return;
  backend_->particles().insert(born);
  step_.rebuild_list();
}

// The file is written once without steps, so that a path that is wrong ends the run here.
void Simulation::prepare_timeline() {
  const auto& [file, from, steps] = options_.trace;
  if (file.empty()) return;
  timeline_ = std::make_unique<Timeline>(step_.counts().steps + from, steps, backend_->device_trace());
  timeline_->write(file, ranks_);
}

// Takes over the checkpoint's particles, which are complete, and the constants of the deck if it has changed.
void Simulation::load_state() {
  bring_into_id_order(state_, model_.particles.totals.at_start);
  if (restart_.changed) take_constants(model_.particles, state_.particles);
  backend_->particles().load(state_.particles, state_.shapes);
  backend_->particles().load_contacts(state_.contacts);
  backend_->particles().load_shape_contacts(state_.shape_contacts);
  if (ranks_.is_root()) backend_->particles().load_works(state_.works);
  state_.particles = {}, state_.contacts = {}, state_.works = {};
}

// The largest change of the bodies' initial velocities, on rank 0.
std::string Simulation::start_change() const {
  return body_coupling_.multibody() && options_.restart.empty() ? body_coupling_.multibody()->start_change()
                                                                : "";
}

// A restart in the folder of the checkpoint continues its files; in another folder new files begin.
bool Simulation::continues_files() const {
  bool same = false;
  ranks_.on_root([&] { same = folder_.continues(); }, std::span(&same, 1));
  return same;
}

// Distributes the particles by ids: each rank gets its range of [0, bound), and the last one also those above
// it. With the number of particles at t = 0 the ranges are those of the model's parts.
void Simulation::bring_into_id_order(State& state, GlobalId bound) const {
  std::vector<GlobalId> ids;
  for (const Particle& p : state.particles) ids.push_back(p.global_id);
  const IdOrder order(ranks_, bound, ids);
  state.particles = order.apply(std::move(state.particles));
  state.contacts = in_order(order, std::move(state.contacts));
}

void Simulation::checkpoint(State& state, const std::string& name) {
  recorder_->flush();
  state.works = all_works(std::move(state.works), ranks_);
  state_hash_ = hash_of_all(state, ranks_);
  bring_into_id_order(state, id_bound(model_.particles, state.population));
  Checkpoint out = pack(state);
  add_restart_texts(out, options_, state_hash_, restart_.changes, book_.starts(state));
  write_checkpoint(options_.output_directory + "/" + name, out, ranks_, model_.output.compression);
  state.particles = {}, state.contacts = {}, state.works = {};
  live_.checkpoint_written(name, state.clock.time);
}

// Issues each warning once.
void Simulation::watch_bodies(const State& state) {
  const auto warn_once = [this](bool& warned, const std::string& warning) {
    if (!warning.empty()) log_.warning(warning), warned = true;
  };
  if (!body_left_) warn_once(body_left_, bodies_outside_warning(model_, state.bodies, state.clock.time));
  if (!overloaded_) warn_once(overloaded_, body_coupling_.load_warning());
}

// Warns once, on every rank.
void Simulation::watch_escaped_particles(const std::vector<EscapedParticle>& escaped_particles) {
  if (load_lost_) return;
  const std::string warning =
      surfaces_outside_.warning(escaped_particles, body_coupling_.motion(), state_.clock.time);
  load_lost_ = !warning.empty();
  if (load_lost_) log_.warning(warning);
}

void Simulation::progress(const State& state, Real h) {
  if (!live_.poll(state, h, recorder_->contacts())) return;
  ranks_.alone() ? recorder_->flush() : recorder_->flush_history();
  show_status("running");
}

void Simulation::show_status(const std::string& status) {
  live_.ended_by(recorder_ ? recorder_->stop_reason() : "");
  live_.write(status, state_, recorder_ ? recorder_->contacts() : -1,
              recorder_ ? recorder_->snapshots_written() : state_.snapshots);
}

ExitCode Simulation::run() {
  try {
    return run_to_the_end();
  } catch (const IoError& error) {
    record_failure(error.what(), ExitCode::io_failed);
    throw;
  } catch (const std::bad_alloc&) {
    record_failure("not enough memory", ExitCode::bad_input);
    throw;
  }
}

ExitCode Simulation::run_to_the_end() {
  ranks_.on_root([&] { write_record("running", ExitCode::done); });
  live_.begin(state_);
  show_status("running");
  log_.info(
      fmt::format("{}, {}, backend {}, multibody solver {}",
                  counted(particles_so_far(model_.particles, state_.population), "particle", "particles"),
                  counted(std::ssize(model_.bodies), "body", "bodies"), backend_->description(),
                  body_coupling_.multibody() ? body_coupling_.multibody()->solver_description() : "none"));
  const LoopParts parts{model_,
                        *backend_,
                        body_coupling_,
                        step_,
                        *recorder_,
                        timers_,
                        steady_seconds,
                        [this](const std::vector<EscapedParticle>& escaped_particles) {
                          watch_escaped_particles(escaped_particles);
                        },
                        timeline_.get(),
                        model_.inserters.empty() ? nullptr : &births_,
                        model_.outlets.empty() ? nullptr : &outlets_};
  StepLoop loop(
      parts, state_, [this](State& s) { checkpoint(s, "checkpoint.h5"); },
      [this](const State& s, Real h) {
        watch_bodies(s);
        progress(s, h);
      });
  try {
    timers_ = {};  // without the list before the first step
    // Timelines begin at the same instant on all ranks.
    if (timeline_) timers_.record_in(&timeline_->host()), ranks_.min(0), timeline_->set_origin();
    book_.begin_loop();
    const LoopEnd end = loop.run();
    book_.end_loop();
    if (end == LoopEnd::stop_condition) log_.info("ended by the stop condition " + recorder_->stop_reason());
    if (end == LoopEnd::done || end == LoopEnd::stop_condition) {
      checkpoint(loop.complete_state(), "checkpoint_end.h5");
      return finish("done", ExitCode::done);
    }
  } catch (const SimulationError& error) {
    return fail(loop, error);
  }
  checkpoint(loop.complete_state(), "checkpoint.h5");
  const std::string signal = strsignal(loop.signal());
  log_.info("stopped by signal (" + signal + "); continue with --restart " + options_.output_directory +
            "/checkpoint.h5");
  return finish("stopped by signal: " + signal, ExitCode::stopped_by_signal);
}

// Writing the record may fail for the same reason as the run; the first error is the one that is reported. On
// a full disk, removing the second copies of growing files, no longer needed, makes room for the record.
void Simulation::record_failure(const std::string& why, ExitCode code) {
  if (!ranks_.is_root()) return;
  try {
    state_.snapshots = recorder_->snapshots_written();
    recorder_.reset();
    write_record("failed: " + why, code);
  } catch (const IoError&) {
  }
  show_status("failed: " + why);
}

ExitCode Simulation::fail(StepLoop& loop, const SimulationError& error) {
  book_.end_loop();
  ranks_.error_barrier(error.what(), static_cast<int>(ExitCode::simulation_failed));
  log_.error(fmt::format("the simulation failed at t = {:.9g} s: {}", state_.clock.time, error.what()));
  save_last_good_state(loop);
  return finish(std::string("failed: ") + error.what(), ExitCode::simulation_failed);
}

// A failed GPU may hold a snapshot, and in implicit runs the state: both are then lost.
void Simulation::save_last_good_state(StepLoop& loop) {
  try {
    recorder_->write_pending();
  } catch (const DeviceError&) {
    state_.snapshots = recorder_->snapshots_written();
  }
  try {
    State* state = nullptr;
    ranks_.collectively([&] { state = &loop.last_saved_state(); });
    checkpoint(*state, "checkpoint_failed.h5");
    log_.info(fmt::format("last good state, t = {:.9g} s: {}/checkpoint_failed.h5", state->clock.time,
                          options_.output_directory));
  } catch (const DeviceError& error) {
    log_.error(std::string("the last good state is lost: ") + error.what());
  }
}

ExitCode Simulation::finish(const std::string& status, ExitCode code) {
  recorder_->finish();
  const std::string reactions =
      body_coupling_.multibody() ? body_coupling_.multibody()->reaction_warning() : "";
  if (!reactions.empty() && code != ExitCode::simulation_failed) log_.warning(reactions);
  if (overloaded_) log_.warning(body_coupling_.load_warning());
  if (timeline_) timeline_->write(options_.trace.file, ranks_);
  list_entries_ = ranks_.sum(backend_->list().entries());
  migrated_ = ranks_.sum(backend_->list().balance().migrated);
  device_bytes_ = ranks_.sum(static_cast<std::int64_t>(device_memory_in_use()));
  summarize();  // before the record, which includes the warnings
  log_.report_suppressed();
  ranks_.on_root([&] { write_record(status, code); });
  show_status(status);
  return code;
}

void Simulation::write_record(const std::string& status, ExitCode code) {
  RunRecord record;
  record.deck_path = options_.deck_path, record.resolved_deck = options_.resolved_deck;
  record.command_line = options_.command_line;
  record.stop_condition = recorder_ ? recorder_->stop_reason() : "";
  record.status = status, record.exit_code = static_cast<int>(code);
  record.started = live_.started(), record.ended = utc_now();
  record.backend = backend_->description();
  record.solver = body_coupling_.multibody() ? body_coupling_.multibody()->solver_description() : "none";
  record.start_change = start_change();
  record.redundancy = body_coupling_.multibody() ? body_coupling_.multibody()->redundancy() : "";
  record.restarted_from = options_.restart, record.changes = restart_.changes;
  record.state_hash = state_hash_, record.ranks = ranks_.size(), record.device_bytes = device_bytes_;
  record.starts = book_.starts(state_);
  record.timers = timers_;
  const RankSums sums{ranks_.alone() ? backend_->list().entries() : list_entries_, migrated_,
                      recorder_ ? recorder_->snapshots_written() : state_.snapshots};
  record.counts = record_counts(model_, state_, step_.counts(), backend_->list(), sums);
  record.measures = record_measures(state_, backend_->list());
  record.warnings = log_.warnings();
  write_run_record(options_.output_directory, record);
}

void Simulation::summarize() const {
  const StepCounts& n = step_.counts();
  const BalanceState& b = state_.balance;
  log_.info(steps_text(n, state_.clock.time) + lists_text(model_, backend_->list(), timers_));
  if (n.lagged_steps > 0) log_.info(lagged_text(n));
  log_.info(balance_text(b, state_.carried_out.left, bodies_outside(model_, state_.bodies).count));
  if (model_.particles.inserters > 0 || !model_.outlets.empty()) log_.info(population_text(state_));
  log_.info(took_text(book_.starts(state_)) + "; results in " + options_.output_directory);
  const Multibody* const bodies = body_coupling_.multibody();
  const BodyBalance of_bodies = bodies == nullptr ? BodyBalance{} : body_balance(model_, *bodies, state_);
  if (const std::string warning = balance_warning(b, of_bodies, model_); !warning.empty())
    log_.warning(warning);
}

}  // namespace

ExitCode run_simulation(const Model& model, const RunOptions& options, Log& log) {
  check_stop_columns(model);
  Simulation simulation(model, options, log);
  return simulation.run();
}

}  // namespace scree
