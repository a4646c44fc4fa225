// Runs that a stop condition ends: the state is that of a run without it, also after restarts.
#include <string>
#include <vector>

#include "output/checkpoint.hpp"
#include "output/status_file.hpp"
#include "support/catch.hpp"
#include "support/decks.hpp"
#include "unit/output/scratch.hpp"
#include "unit/run/restart_case.hpp"

namespace scree {
namespace {

// Discs in a box come to rest; a third of them begin in the left half.
const std::string kDeck = R"(
gravity = [0.0, -9.8]
[space]
dimension = 2
min = [0.0, 0.0]
max = [1.0, 1.0]
x_min = "wall"
x_max = "wall"
y_min = "wall"
[time]
end = 4.0
control = "fixed"
step = 2e-4
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = 1e4
damping = 20.0
[[particles]]
name = "discs"
kind = "lattice"
origin = [0.15, 0.15]
spacing = [0.22, 0.22]
size = [3, 2]
radius = 0.1
mass = 1.0
velocity = [1.0, 0.0]
[output]
history_interval = 0.01
[[output.history_regions]]
name = "right"
kind = "box"
min = [0.5, 0.0]
max = [1.0, 1.0]
)";
const std::string kRest =
    "[[stop]]\nname = \"rest\"\ncolumn = \"energy/kinetic\"\nwithin = 1e-2\nover = 0.2\n";
const std::string kMoved = "[[stop]]\nname = \"moved\"\ncolumn = \"regions/right/mass\"\nabove = 2.5\n";

// What a finished run has left.
struct Ended {
  Real time = 0;
  std::int64_t steps = 0, rows = 0, snapshots = 0;
  std::string hash, reason;
};

Ended ended(const std::string& folder) {
  const Checkpoint checkpoint = read_checkpoint(folder + "/checkpoint_end.h5", {});
  const RunStatus status = read_status(folder);
  CHECK(status.state == "done");
  return {checkpoint.real_array("clock/time")[0],
          checkpoint.integer_array("counts/steps")[0],
          status.history_rows,
          status.snapshots,
          checkpoint.text("state_hash"),
          status.stop_condition};
}

Ended run(const std::string& folder, const std::string& stops, const std::vector<std::string>& overrides = {},
          const std::string& restart = "") {
  CHECK(RestartCase(kDeck + stops, overrides).run(folder, restart) == "");
  return ended(folder);
}

}  // namespace

TEST_CASE("a stop condition ends a run with the state of a run without it") {
  const ScratchDirectory scratch;
  const std::string folder = scratch.path() + "/";
  for (const char* integrator : {"velocity-verlet", "hht"}) {
    CAPTURE(integrator);
    const std::string particles = std::string("integrator.particles=") + integrator;
    const Ended stopped = run(folder + "stopped", kRest + kMoved, {particles, "stop.moved.after=10"});
    CHECK((stopped.time > 0.2 && stopped.time < 4));
    CHECK(contains(stopped.reason, "\"rest\": energy/kinetic steady within 0.01 for 0.2 s; "));
    CHECK(stopped.snapshots == 2);
    const Ended whole = run(folder + "whole", "", {particles, "time.end=" + std::to_string(stopped.time)});
    CHECK((whole.hash == stopped.hash && whole.steps == stopped.steps && whole.rows == stopped.rows));
    CHECK(whole.reason.empty());
  }
}

TEST_CASE("a restarted run stops at the same step") {
  const ScratchDirectory scratch;
  const std::string folder = scratch.path() + "/";
  // The last checkpoint is inside the time over which the column is steady, on a row and between rows.
  for (const char* interval : {"0.04", "0.035"}) {
    CAPTURE(interval);
    const std::vector<std::string> checkpoints = {std::string("output.checkpoint_interval=") + interval};
    const Ended whole = run(folder + "whole", kRest, checkpoints);
    const std::string before = folder + "whole/checkpoint.h5";
    const Real time = read_checkpoint(before, {}).real_array("clock/time")[0];
    CAPTURE(time, whole.time);
    REQUIRE((time < whole.time && time > whole.time - 0.1));
    const Ended rest = run(folder + "rest", kRest, checkpoints, before);
    CHECK((rest.time == whole.time && rest.steps == whole.steps));
    CHECK((rest.hash == whole.hash && rest.reason == whole.reason));
  }
}

TEST_CASE(
    "a restart of a run that a stop condition ended has nothing left to do until the condition differs") {
  const ScratchDirectory scratch;
  const std::string folder = scratch.path() + "/", end = folder + "stopped/checkpoint_end.h5";
  const Ended stopped = run(folder + "stopped", kMoved);
  CHECK(contains(stopped.reason, "\"moved\": regions/right/mass above 2.5; 4 at t = "));
  const Ended again = run(folder + "again", kMoved, {"stop.moved.name=other"}, end);
  CHECK((again.hash == stopped.hash && again.steps == stopped.steps && again.rows == 1 &&
         again.snapshots == 1));
  CHECK(contains(again.reason, "\"other\": "));
  const Ended whole = run(folder + "whole", kRest);
  const auto check_continued = [&](const std::string& stops, const std::vector<std::string>& overrides) {
    const Ended on = run(folder + "on", stops, overrides, end);
    CHECK((on.hash == whole.hash && on.steps == whole.steps && on.time == whole.time));
    CHECK(contains(on.reason, "\"rest\": "));
  };
  check_continued(kRest, {});
  check_continued(kRest + kMoved, {"stop.moved.above=100"});
  // A run without the condition drops its watch.
  run(folder + "free", "", {"time.end=" + std::to_string(stopped.time + 0.05)}, end);
  const Ended late = run(folder + "late", kMoved, {}, folder + "free/checkpoint_end.h5");
  CHECK(late.time > stopped.time + 0.055);
}

TEST_CASE("a condition that is met at the end of the run is its reason, too") {
  const ScratchDirectory scratch;
  const std::string folder = scratch.path() + "/";
  const Ended last =
      run(folder + "last", kMoved, {"stop.moved.above=-1", "stop.moved.after=0.02", "time.end=0.02"});
  CHECK((last.steps == 100 && last.rows == 3));
  CHECK(contains(last.reason, "\"moved\": "));
  CHECK(run(folder + "first", kMoved, {"stop.moved.above=-1"}).steps == 50);  // not at t = 0
}

}  // namespace scree
