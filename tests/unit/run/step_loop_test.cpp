// Number of explicit steps that the loop takes at once.
#include "run/loop/step_loop.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "dem/cpu/cpu_backend.hpp"
#include "run/record/recorder.hpp"
#include "run/report/balance.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/petsc_run.hpp"
#include "support/state_bits.hpp"
#include "unit/output/scratch.hpp"

namespace scree {

namespace {

Model model_with(std::int64_t particles, int substeps, int bodies = 0) {
  Model model;
  model.particles.totals.count = particles;
  model.integrator.substeps = substeps;
  model.bodies.resize(static_cast<std::size_t>(bodies));
  return model;
}

// A moving disc, one output at the end.
const std::string kDeck = R"(
[space]
dimension = 2
min = [-1.0, -1.0]
max = [1.0, 1.0]
[time]
end = 1.0
step = 5e-5
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = 1e4
[[particles]]
name = "disc"
kind = "list"
positions = [[-0.5, 0.0]]
velocity = [1.0, 0.0]
radius = 0.1
mass = 1.0
[output]
history_interval = 1.0
)";

// Calls before_steps(most) whenever steps are taken.
class WatchedRun : public ExplicitRun {
 public:
  WatchedRun(std::unique_ptr<ExplicitRun> run, std::function<void(Index)> before_steps)
      : run_(std::move(run)), before_steps_(std::move(before_steps)) {}
  StepsTaken take_steps(Index most, bool keep_open, StageTimers& timers) override {
    before_steps_(most);
    return run_->take_steps(most, keep_open, timers);
  }
  StepsTaken take_driven_steps(std::span<const BodyMotion> motion, bool keep_open,
                               std::vector<BodyWrench>& wrenches, StageTimers& timers) override {
    return run_->take_driven_steps(motion, keep_open, wrenches, timers);
  }
  void shape_contacts() override { run_->shape_contacts(); }
  void reduce_wrench(std::vector<BodyWrench>& wrench, std::vector<std::int64_t>& contacts) override {
    run_->reduce_wrench(wrench, contacts);
  }

 private:
  std::unique_ptr<ExplicitRun> run_;
  std::function<void(Index)> before_steps_;
};

// Pretends to be mixed or not; takes some time by a clock of its own for any number of steps, and records
// the numbers of steps.
class SlowBackend : public CpuBackend {
 public:
  SlowBackend(const Model& model, bool mixed, double seconds)
      : CpuBackend(model), mixed_(mixed), seconds_(seconds) {}
  bool is_mixed() const override { return mixed_; }
  std::unique_ptr<ExplicitRun> start_run(Real h) override {
    return std::make_unique<WatchedRun>(CpuBackend::start_run(h), [this](Index most) {
      batches.push_back(most);
      now += seconds_;
    });
  }

  std::vector<Index> batches;
  double now = 0;  // [s]

 private:
  bool mixed_;
  double seconds_;
};

// A run of the deck.
struct SlowRun {
  SlowRun(bool mixed, double seconds) : backend(model, mixed, seconds) {
    state.clock = StepClock(model).state();
    backend.particles().load(initial_records(model.particles, Subdomain(model.space)), {});
    step.start(state.bodies);
    recorder.emplace(model, backend, link, folder.path(), state);
    const LoopParts parts{model, backend, link, step, *recorder, timers, [this] { return backend.now; }};
    loop.emplace(
        parts, state, [](State&) {}, [](const State&, Real) {});
  }

  const Model model = (petsc(), model_of(kDeck));
  const ScratchDirectory folder;
  SlowBackend backend;
  BodyCoupling link{model};
  StageTimers timers;
  CoupledStep step{model, backend, link, timers};
  State state;
  std::optional<Recorder> recorder;
  std::optional<StepLoop> loop;
};

// Steps after which the batches end.
std::set<Index> ends_of(const std::vector<Index>& batches) {
  std::set<Index> ends;
  Index steps = 0;
  for (const Index batch : batches) ends.insert(steps += batch);
  return ends;
}

// The batches of a whole run.
std::vector<Index> batches(bool mixed, double seconds) {
  SlowRun run(mixed, seconds);
  CHECK(run.loop->run() == LoopEnd::done);
  return run.backend.batches;
}

}  // namespace

TEST_CASE("in double a batch follows the clock: some 0.2 s of steps, one before the first is measured") {
  const Model model = model_with(1000000, 1);
  CHECK(batch_length(model, false, std::numeric_limits<double>::infinity()) == 1);
  CHECK(batch_length(model, false, 1) == 1);
  CHECK(batch_length(model, false, 1e-3) == 200);
  CHECK(batch_length(model_with(1, 1), false, 1e-9) == 1000000);
  CHECK(batch_length(model_with(1, 100), false, 1e-9) == 10000);
}

TEST_CASE("in mixed precision a batch follows from the deck, and a GPU takes well under a second for it") {
  struct Size {
    std::int64_t particles;
    double step;  // seconds on an H200
  };
  for (const Size& size :
       {Size{1, 7e-6}, {10000, 7.4e-6}, {1000000, 75.7e-6}, {16000000, 1.06e-3}, {250000000, 1.66e-2}})
    for (const int substeps : {1, 10}) {
      CAPTURE(size.particles, substeps);
      const Model model = model_with(size.particles, substeps);
      const std::size_t steps = batch_length(model, true, 1e-3);
      CHECK(steps == batch_length(model, true, 1));
      CHECK(steps == batch_length(model, true, std::numeric_limits<double>::infinity()));
      const double seconds = static_cast<double>(steps) * substeps * size.step;
      CHECK(seconds < 0.7);
      CHECK(seconds > 0.02);
    }
  // No step is split, and the equations of 10,000 bodies, 19 ms, are not solved for minutes.
  CHECK(batch_length(model_with(100, 1000000), true, 1) == 1);
  CHECK(batch_length(model_with(100, 1, 10000), true, 1) == 32);
}

TEST_CASE("in mixed precision no clock decides where the loop's batches end") {
  const std::vector<Index> quick = batches(true, 1e-6);
  CHECK(quick.size() > 2);
  CHECK(quick == batches(true, 0.02));
}

TEST_CASE(
    "in double the loop's batches take up to 0.2 s, and each is as long as the last one's steps let it be") {
  std::vector<Index> quick{1};  // to the next sample of the energies, or the end
  for (std::int64_t steps = 1; steps < 20000; steps += quick.back())
    quick.push_back(
        static_cast<Index>(std::min(next_energy_sample(steps, false), std::int64_t{20000}) - steps));
  CHECK(batches(false, 1e-6) == quick);
  std::vector<Index> slow = batches(false, 0.08);
  REQUIRE(slow.size() > 4);
  slow.resize(4);
  CHECK(slow == std::vector<Index>{1, 2, 5, 12});
  CHECK(batches(false, 0.24).size() == 20000);
}

TEST_CASE("the loop pauses after the step that reaches a time, and continues from there") {
  SlowRun whole(false, 1e-6), parts(false, 1e-6);
  CHECK(whole.loop->run() == LoopEnd::done);
  for (const Real until : {5e-5, 0.1, 0.1 + 1e-9, 0.5}) {
    CHECK(parts.loop->run(until) == LoopEnd::paused);
    CHECK(parts.state.clock.time >= until);
    CHECK(parts.state.clock.time < until + 5.1e-5);
  }
  CHECK(parts.loop->run(parts.state.clock.time) == LoopEnd::paused);  // already reached: no step
  CHECK(parts.loop->run() == LoopEnd::done);
  std::set<Index> ends = ends_of(whole.backend.batches);
  ends.insert({1, 2000, 2001, 10000});
  CHECK(ends_of(parts.backend.batches) == ends);
  CHECK(differing_arrays(pack(parts.loop->complete_state()), pack(whole.loop->complete_state())) == "");
}

}  // namespace scree
