// Refusals of restarts: damaged checkpoints, datasets of wrong lengths, other decks; and restarts with
// --allow-changes.
#include "run/restart/restart.hpp"

#include <bit>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>

#include "base/error.hpp"
#include "run/restart/checkpoint_datasets.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/state_bits.hpp"
#include "unit/output/scratch.hpp"
#include "unit/run/restart_case.hpp"

namespace scree {

namespace {

// A pendulum that a disc hits, with a driver, and forces that follow tables.
const std::string kDeck = R"(
gravity = [0.0, -9.8]
[space]
dimension = 2
min = [-1.0, -1.0]
max = [1.0, 1.0]
[time]
end = 0.02
control = "fixed"
step = 1e-3
[[contact.pairs]]
stiffness = 1e4
damping = 1.0
[[bodies]]
name = "arm"
position = [0.2, 0.0]
mass = 1.0
inertia = 0.01
shapes = [{ radius = 0.1 }]
[[bodies]]
name = "crank"
position = [-0.5, 0.0]
mass = 1.0
inertia = 0.01
[[joints]]
name = "pin"
type = "revolute"
bodies = ["ground", "arm"]
point = [0.0, 0.0]
[[joints]]
name = "axle"
type = "revolute"
bodies = ["ground", "crank"]
[[drivers]]
name = "motor"
joint = "axle"
motion = 0.0
[[applied_forces]]
name = "push"
body = "arm"
fx = { kind = "table", times = [0.0, 0.01, 0.02], values = [0.0, 1.0, 1.0] }
[[particles]]
name = "discs"
kind = "list"
positions = [[0.2, 0.199], [0.5, 0.5], [0.5, -0.5]]
radius = 0.1
mass = 1.0
velocity = [0.1, -0.5]
[output]
history_interval = 5e-3
)";

struct Case : RestartCase {
  explicit Case(const std::vector<std::string>& overrides = {}) : RestartCase(kDeck, overrides) {}
};

const std::string kLongerTable =
    "applied_forces.push.fx={ kind = \"table\", times = [0.0, 0.01, 0.02, 0.04], values = [0.0, 1.0, 1.0, "
    "30.0] "
    "}";

// The last checkpoint of one run; every test makes its own files from it.
struct Written {
  Written() {
    Case whole;
    REQUIRE(whole.run(folder.path()) == "");
    path = folder / "checkpoint_end.h5";
  }
  ScratchDirectory folder;
  std::string path;
};

const Written& written() {
  static const Written once;
  return once;
}

// The checkpoint with a change in one of its parts, sealed as usual.
std::string changed(const ScratchDirectory& folder, const std::function<void(Checkpoint&)>& change) {
  Checkpoint checkpoint = read_checkpoint(written().path);
  change(checkpoint);
  const std::string path = folder / "changed.h5";
  write_checkpoint(path, checkpoint);
  return path;
}

template <class T>
void set_rows(CheckpointRows<T>& rows, std::vector<T> values) {
  rows.count = std::ssize(values) / rows.width;
  rows.copy = [values = std::move(values), width = rows.width](std::int64_t first, std::int64_t count,
                                                               T* to) {
    std::copy_n(values.begin() + first * width, count * width, to);
  };
}

template <class T>
std::vector<T> values_of(const CheckpointRows<T>& rows) {
  std::vector<T> values(static_cast<std::size_t>(rows.count * rows.width));
  rows.copy(0, rows.count, values.data());
  return values;
}

}  // namespace

TEST_CASE("a checkpoint with any dataset too short, too long, missing or unknown is refused by its name") {
  const Model model = Case().model;
  const Checkpoint whole = read_checkpoint(written().path);
  const auto message = [&](const std::function<void(Checkpoint&)>& change) -> std::string {
    Checkpoint checkpoint = whole;
    change(checkpoint);
    try {
      check_datasets(checkpoint, model, kRestartTexts);
    } catch (const IoError& error) {
      CHECK(contains(error.what(), written().path + ": not a valid checkpoint: "));
      return error.what();
    }
    return "";
  };
  REQUIRE(message([](Checkpoint&) {}) == "");
  const auto check_lengths = [&](auto Checkpoint::*group, const std::string& label, const std::string& name,
                                 std::size_t count) {
    CAPTURE(name);
    const std::string dataset = "dataset /" + label + "/" + name, right = " values; the deck's model has ";
    const auto expected = [&](std::size_t found) {
      return dataset + " has " + std::to_string(found) + right + std::to_string(count);
    };
    CHECK(contains(message([&](Checkpoint& c) { (c.*group)[name].push_back(1); }), expected(count + 1)));
    if (count > 0)
      CHECK(contains(message([&](Checkpoint& c) { (c.*group)[name].pop_back(); }), expected(count - 1)));
    CHECK(contains(message([&](Checkpoint& c) { (c.*group).erase(name); }), dataset + " is missing"));
  };
  for (const auto& [name, values] : whole.reals)
    check_lengths(&Checkpoint::reals, "reals", name, values.size());
  for (const auto& [name, values] : whole.integers)
    check_lengths(&Checkpoint::integers, "integers", name, values.size());
  CHECK(whole.reals.at("bodies/multipliers").size() == 5);
  CHECK(whole.reals.at("bodies/wrench").size() == 12);
  CHECK(contains(message([](Checkpoint& c) { c.reals["bodies/more"] = {1}; }),
                 "/reals/bodies/more is not known"));
  CHECK(contains(message([](Checkpoint& c) { c.texts["more"] = "x"; }), "/texts/more is not known"));
  CHECK(
      contains(message([](Checkpoint& c) { c.texts.erase("state_hash"); }), "/texts/state_hash is missing"));
  CHECK(contains(message([](Checkpoint& c) { c.real_rows["more"] = {1, 0, nullptr}; }), "/real_rows/more"));
}

TEST_CASE("a checkpoint with rows of particles too few, too many or too wide is refused") {
  Case same;
  const ScratchDirectory folder;
  const auto resize = [](auto& rows, std::int64_t count) {
    auto values = values_of(rows);
    values.resize(static_cast<std::size_t>(count * rows.width), values.back());
    set_rows(rows, values);
  };
  const auto message = [&](std::int64_t all, std::int64_t of_force) {
    return same.refusal(changed(folder, [&](Checkpoint& c) {
      for (auto& [name, rows] : c.real_rows) resize(rows, all);
      for (auto& [name, rows] : c.integer_rows) resize(rows, all);
      resize(c.real_rows.at("particles/force"), of_force);
      if (all == 4) {
        std::vector<std::int64_t> ids = {0, 1, 2, 3};
        set_rows(c.integer_rows.at("particles/global_id"), ids);
      }
    }));
  };
  CHECK(message(3, 3) == "");
  CHECK(contains(message(2, 2), "2 particles; the deck has 3"));
  CHECK(contains(message(4, 4), "4 particles; the deck has 3"));
  CHECK(contains(message(3, 2), "do not fit together"));
  CHECK(contains(message(2, 3), "do not fit together"));
  const std::string wide = same.refusal(changed(folder, [&](Checkpoint& c) {
    auto& rows = c.real_rows.at("particles/position");
    rows.width = 2, set_rows(rows, std::vector<Real>(6));
  }));
  CHECK(contains(wide, "dataset /real_rows/particles/position has 2 values per row; it should have 3"));
}

TEST_CASE("a checkpoint whose state has lost a bit is refused by its hash") {
  Case same;
  const ScratchDirectory folder;
  std::mt19937_64 random(11);
  const State before = same.read(written().path).state;
  int refused = 0;
  const auto check = [&](const std::function<void(Checkpoint&)>& change) {
    const std::string path = changed(folder, change);
    if (same.refusal(path) != "") return void(++refused);
    CHECK(state_hash(same.read(path).state, true) == state_hash(before, true));
  };
  const auto flip = [&](auto& value) {
    value = std::bit_cast<std::decay_t<decltype(value)>>(std::bit_cast<std::uint64_t>(value) ^
                                                         std::uint64_t{1} << random() % 64);
  };
  const Checkpoint whole = read_checkpoint(written().path);
  for (const auto& [name, values] : whole.reals)
    if (!values.empty())
      check([&, &name = name](Checkpoint& c) { flip(c.reals[name][random() % c.reals[name].size()]); });
  const int of_reals = refused;
  CHECK(of_reals == std::ssize(whole.reals));
  for (const auto& [name, values] : whole.integers)
    check([&, &name = name](Checkpoint& c) { flip(c.integers[name][0]); });
  const auto check_rows = [&](auto Checkpoint::*group) {
    for (const auto& [name, rows] : whole.*group)
      for (int trial = 0; trial < 4; ++trial)
        check([&, &name = name](Checkpoint& c) {
          auto values = values_of((c.*group).at(name));
          flip(values[random() % values.size()]);
          set_rows((c.*group).at(name), values);
        });
  };
  refused = 0;
  check_rows(&Checkpoint::real_rows), check_rows(&Checkpoint::integer_rows);
  CHECK(refused == 4 * std::ssize(whole.real_rows) + 4 * std::ssize(whole.integer_rows));
  // Lengths are checked before the state is.
  CHECK(contains(same.refusal(changed(folder, [](Checkpoint& c) { c.reals["bodies/velocity"].pop_back(); })),
                 "dataset /reals/bodies/velocity has 5 values; the deck's model has 6"));
  CHECK(contains(same.refusal(changed(folder, [](Checkpoint& c) { c.reals["bodies/velocity"][2] += 1e-9; })),
                 "the checkpoint is damaged: the hash of its state is "));
}

TEST_CASE("a checkpoint file with flipped bits never leads to another state") {
  Case same;
  const ScratchDirectory folder;
  std::ifstream file(written().path, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(file), {}};
  const std::string path = folder / "flipped.h5";
  std::mt19937_64 random(13);
  for (int trial = 0; trial < 60; ++trial) {
    std::string bytes = whole;
    for (int k = 0; k < (trial % 2 == 0 ? 1 : 64); ++k)
      bytes[random() % bytes.size()] ^= static_cast<char>(1 << random() % 8);
    std::ofstream(path, std::ios::binary) << bytes;
    CAPTURE(trial);
    CHECK(contains(same.refusal(path), path));
  }
}

TEST_CASE("a refused restart names the keys that differ, a corrected title is accepted") {
  const ScratchDirectory folder;
  Case other({"time.step=5e-4", "contact.pairs.0.damping=2.0", "bodies.arm.mass=1.5"});
  const std::string message = other.run(folder.path(), written().path);
  CHECK(contains(message, "input: --restart " + written().path + ": the checkpoint belongs to another deck"));
  for (const char* words : {"time.step: 0.001 -> 0.0005", "contact.pairs.0.damping: 1.0 -> 2.0",
                            "bodies.arm.mass: 1.0 -> 1.5", "--allow-changes"})
    CHECK(contains(message, words));
  Case corrected({"title=corrected", "time.end=0.03", "applied_forces.push.fx.times=[0.0, 0.01, 0.03]"});
  CHECK(contains(corrected.run(folder.path(), written().path), "applied_forces.push.fx.times"));
}

TEST_CASE("a table that differs only after the checkpoint's time continues bit for bit") {
  const ScratchDirectory whole, parts;
  const std::vector<std::string> later = {"time.end=0.04", "title=longer", "output.snapshot_interval=0.02",
                                          kLongerTable};
  Case longer(later);
  CHECK(longer.run(whole.path()) == "");
  CHECK(longer.run(parts.path(), written().path) == "");
  CHECK(longer.log.warnings().empty());
  CHECK(differing_arrays(read_checkpoint(whole / "checkpoint_end.h5"), [&] {
          Checkpoint c = read_checkpoint(parts / "checkpoint_end.h5");
          for (const char* name :
               {"clock/histories", "output/history_rows", "output/snapshots", "clock/snapshots"})
            c.integers[name] = read_checkpoint(whole / "checkpoint_end.h5").integers[name];
          return c;
        }()) == "");
}

TEST_CASE("--allow-changes continues with other steps, forces and integrators, and reports them") {
  const ScratchDirectory folder;
  const std::vector<std::vector<std::string>> changes = {
      {"time.step=5e-4"},
      {"time.control=adaptive"},
      {"integrator.hht_alpha=-0.2"},
      {"contact.pairs.0.stiffness=2e4"},
      {"bodies.arm.mass=2.0"},
      {"particles.discs.mass=2.0"},
      {"space.leaving=ballistic"},
      {"integrator.particles=velocity-verlet", "time.step=1e-4"}};
  for (std::vector<std::string> overrides : changes) {
    CAPTURE(overrides[0]);
    overrides.insert(overrides.end(), {"time.end=0.025", kLongerTable});
    Case other(overrides);
    CHECK(other.run(folder.path(), written().path, true) == "");
    REQUIRE(other.log.warnings().size() == 1);
    CHECK(contains(other.log.warnings()[0], "not bit for bit"));
    CHECK(contains(other.log.warnings()[0], overrides[0].substr(0, overrides[0].find('='))));
    const Checkpoint end = read_checkpoint(folder / "checkpoint_end.h5");
    CHECK(end.reals.at("clock/time")[0] == 0.025);
    CHECK(contains(end.text("changes"), "t = 0.02 s: "));
    // A change of the energies by the model is no error of its balance.
    CHECK(std::abs(end.reals.at("balance/start")[0]) < 100);
    CHECK(other.run(folder.path(), folder / "checkpoint_end.h5") ==
          "");  // the deck of the checkpoint is now this one
    CHECK(contains(read_checkpoint(folder / "checkpoint_end.h5").text("changes"), "t = 0.02 s: "));
  }
}

TEST_CASE("a restart continues with the checkpoint's radii and masses, with another deck with that deck's") {
  const std::vector<std::string> spread = {
      "particles.discs.radius={ kind = \"uniform\", min = 0.09, max = 0.11 }",
      "particles.discs.mass={ kind = \"uniform\", min = 1.0, max = 2.0 }"};
  const ScratchDirectory folder;
  Case first(spread);
  REQUIRE(first.run(folder / "first") == "");
  const auto rows_in = [](const std::string& path, const std::string& name) {
    return values_of(read_checkpoint(path).real_rows.at("particles/" + name));
  };
  const std::string start = folder / "first/checkpoint_end.h5", swapped = folder / "swapped.h5";
  Checkpoint checkpoint = read_checkpoint(start);
  for (const char* name : {"radius", "mass"}) {
    std::vector<Real> values = rows_in(start, name);
    CHECK((values ==
           (std::string(name) == "mass" ? first.model.particles.mass : first.model.particles.radius)));
    std::reverse(values.begin(), values.end());
    set_rows(checkpoint.real_rows.at(std::string("particles/") + name), values);
  }
  write_checkpoint(swapped, checkpoint);
  Case second(spread);
  REQUIRE(second.run(folder / "second", swapped) == "");
  for (const char* name : {"radius", "mass"})
    CHECK(same_bits(rows_in(folder / "second/checkpoint_end.h5", name), rows_in(swapped, name)));
  Case other({spread[0], spread[1], "contact.pairs.0.stiffness=2e4"});
  REQUIRE(other.run(folder / "other", swapped, true) == "");
  for (const char* name : {"radius", "mass"})
    CHECK(same_bits(rows_in(folder / "other/checkpoint_end.h5", name), rows_in(start, name)));
}

TEST_CASE("--allow-changes refuses decks for which the checkpoint's numbers have no meaning") {
  const ScratchDirectory folder;
  const auto message = [&](const std::vector<std::string>& overrides) {
    return Case(overrides).run(folder.path(), written().path, true);
  };
  CHECK(contains(message({"joints.axle.type=fixed", "drivers=[]"}), "have no meaning"));
  CHECK(contains(message({"particles.discs.positions=[[0.2, 0.199]]"}), "have no meaning"));
  CHECK(contains(message({"space.x_min=periodic", "space.x_max=periodic"}),
                 "space.x_min: \"open\" -> \"periodic\""));
  CHECK(contains(message({"drivers.motor.motion=0.1"}), "driver 'motor'"));
}

}  // namespace scree
