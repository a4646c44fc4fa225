// Stop conditions at rows of the history: against their definition, and their watches in a checkpoint.
#include "run/record/stop_conditions.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.hpp"
#include "model/derived/random.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"

namespace scree {
namespace {

StopCondition condition_of(StopKind kind, Real bound, Real over, Real after = 0) {
  StopCondition condition;
  condition.name = "quiet", condition.column = "step/value", condition.kind = kind;
  condition.bound = bound, condition.over = over, condition.after = after;
  return condition;
}

std::vector<RecordedColumn> two_columns() {
  return {{{"step", "other", "1", ""}, {}}, {{"step", "value", "1", ""}, {}}};
}

// Rows of one condition, with values of a column that it does not read.
class Watched {
 public:
  explicit Watched(const StopCondition& condition) : conditions_({condition}, two_columns()) {
    conditions_.adopt(watches);
  }
  // Whether the condition is met at this row.
  bool row(Real time, Real value) {
    const std::vector<Real> values{-value, value};
    conditions_.add_row(time, values, watches);
    return !conditions_.reason(watches).empty();
  }
  std::string reason() const { return conditions_.reason(watches); }

  std::vector<StopWatch> watches;

 private:
  StopConditions conditions_;
};

// The definition: whether rows back to one of the time `over` ago hold together.
bool defined(const StopCondition& condition, const std::vector<StopSample>& rows) {
  Real least = kInfinity, most = -kInfinity;
  for (std::size_t k = rows.size(); k-- > 0;) {
    const Real value = rows[k].value;
    if (rows[k].time < condition.after) return false;
    least = std::min(least, value), most = std::max(most, value);
    if (condition.kind == StopKind::above && !(value > condition.bound)) return false;
    if (condition.kind == StopKind::below && !(value < condition.bound)) return false;
    if (condition.kind == StopKind::steady && most - least > condition.bound) return false;
    if (rows.back().time - rows[k].time >= condition.over) return rows.back().time > 0;
  }
  return false;
}

const std::string kDeck = R"(
[space]
dimension = 2
min = [0.0, 0.0]
max = [1.0, 1.0]
[time]
end = 1.0
step = 1e-3
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = 1e4
[[particles]]
name = "disc"
kind = "list"
positions = [[0.5, 0.5]]
radius = 0.1
mass = 1.0
[[output.history_regions]]
name = "left"
kind = "box"
min = [0.0, 0.0]
max = [0.5, 1.0]
[[stop]]
name = "full"
above = 1.0
)";

std::string column_error(const std::string& column) {
  const Model model = model_of(kDeck + "column = \"" + column + "\"\n");
  return input_error([&] { check_stop_columns(model); });
}

}  // namespace

TEST_CASE("stop conditions are met where their definition says so") {
  RandomNumbers random(11);
  int met = 0;
  for (int run = 0; run < 300; ++run) {
    // Times and values in binary fractions, so that the definition needs no tolerance.
    const auto kind = static_cast<StopKind>(run % 3);
    const Real over = std::floor(random.uniform(kind == StopKind::steady ? 1 : 0, 9)) / 8;
    const StopCondition condition =
        condition_of(kind, std::floor(random.uniform(2, 7)) / 4, over, std::floor(random.uniform(0, 2)) / 2);
    Watched watched(condition);
    std::vector<StopSample> rows;
    for (Real time = 0, value = 1; time < 6; time += std::floor(random.uniform(1, 4)) / 16) {
      value += std::floor(random.uniform(-2, 3)) / 4;
      rows.push_back({time, value});
      const bool found = watched.row(time, value);
      REQUIRE(found == defined(condition, rows));
      met += found;
    }
  }
  CHECK(met > 1000);
}

TEST_CASE("times of rows that are multiples of an interval complete a duration despite round-off") {
  for (const StopKind kind : {StopKind::below, StopKind::steady}) {
    int shortest = 100, longest = 0;
    for (int first = 0; first < 40; ++first) {
      Watched watched(condition_of(kind, 0.5, 0.3));
      for (int row = first; row <= first + 4; ++row)
        if (watched.row(row * 0.1, 0.25)) {
          shortest = std::min(shortest, row - first), longest = std::max(longest, row - first);
          break;
        }
    }
    CHECK((shortest == 3 && longest == 3));
  }
}

TEST_CASE("a watch keeps few rows") {
  Watched bound(condition_of(StopKind::above, 0, 1e9)), band(condition_of(StopKind::steady, 2, 1));
  for (int row = 0; row < 1000; ++row) bound.row(0.125 * row, 1), band.row(0.125 * row, row % 2);
  CHECK(bound.watches[0].held == std::vector<StopSample>{{0, 1}, {0.125 * 999, 1}});
  CHECK(band.watches[0].held.size() == 9);
}

TEST_CASE("values that are not finite hold no condition, and the row at t = 0 ends no run") {
  for (const StopKind kind : {StopKind::above, StopKind::below, StopKind::steady}) {
    const Real bound = kind == StopKind::above ? 0 : 10;
    Watched watched(condition_of(kind, bound, kind == StopKind::steady ? 1 : 0));
    CHECK(!watched.row(0, 5));
    CHECK(!watched.row(1, std::nan("")));
    CHECK(watched.watches[0].held.empty());
    CHECK(watched.row(2, 5) == (kind != StopKind::steady));
    CHECK(watched.row(3, 5));
    CHECK(watched.reason() ==
          "\"quiet\": " + described(condition_of(kind, bound, kind == StopKind::steady)) + "; 5 at t = 3 s");
  }
}

TEST_CASE("a row that is repeated changes nothing") {
  Watched watched(condition_of(StopKind::steady, 1, 2));
  watched.row(1, 0), watched.row(2, 0.5);
  const std::vector<StopWatch> before = watched.watches;
  CHECK(!watched.row(2, 0.5));
  CHECK(watched.watches == before);
}

TEST_CASE("watches belong to their conditions, whatever the name and the order") {
  StopCondition one = condition_of(StopKind::above, 1, 0.5), other = condition_of(StopKind::below, 1, 0.5);
  std::vector<StopWatch> watches{{key_of(other), {{1, 2}}}, {7, {{3, 4}}}, {key_of(one), {{5, 6}}}};
  one.name = "renamed";
  StopConditions({one, other, condition_of(StopKind::above, 1, 0.25)}, two_columns()).adopt(watches);
  REQUIRE(watches.size() == 3);
  CHECK((watches[0].held == std::vector<StopSample>{{5, 6}} &&
         watches[1].held == std::vector<StopSample>{{1, 2}}));
  CHECK(watches[2].held.empty());
}

TEST_CASE("watches in a checkpoint are those packed; what does not fit is refused") {
  const std::vector<StopWatch> watches{{3, {{0.5, 1}, {1, -2}}}, {-4, {}}, {5, {{7, 8}}}};
  Checkpoint checkpoint;
  add_watches(watches, checkpoint);
  CHECK(watches_in(checkpoint) == watches);
  Checkpoint none;
  add_watches({}, none);
  CHECK((none.integers.empty() && none.reals.empty() && watches_in(none).empty()));
  const auto refused = [&](auto damage) {
    Checkpoint damaged = checkpoint;
    damage(damaged);
    CHECK_THROWS_AS(watches_in(damaged), IoError);
  };
  refused([](Checkpoint& c) { c.integers["stop/rows"][0] = 3; });
  refused([](Checkpoint& c) { c.integers["stop/rows"][0] = -1; });
  refused([](Checkpoint& c) { c.integers["stop/rows"].pop_back(); });
  refused([](Checkpoint& c) { c.reals["stop/samples"].push_back(1); });
  refused([](Checkpoint& c) { c.reals["stop/samples"][3] = kInfinity; });
  refused([](Checkpoint& c) { c.reals.erase("stop/samples"); });
}

TEST_CASE("an unknown column is refused with its place and the nearest names") {
  CHECK(column_error("regions/left/mass").empty());
  CHECK(
      column_error("energy/kinetik") ==
      "deck.toml:27:10: stop.full.column = \"energy/kinetik\": the history has no such column; did you mean "
      "\"energy/kinetic\"?");
  CHECK(contains(column_error("regions/left/volume"), "known: regions/left/number, regions/left/mass"));
  CHECK(contains(column_error("region/left/mass"), "did you mean \"regions/left/mass\"?"));
  CHECK(contains(column_error("contacts/drum/fx"), "known groups: energy, momentum, regions/left, step; "));
  CHECK(contains(column_error(""), "known groups: "));
}

}  // namespace scree
