// A run continued from a checkpoint, and one with another neighbour list, have the uninterrupted run's bits.
#include <fmt/format.h>

#include <map>
#include <string>
#include <vector>

#include "output/checkpoint.hpp"
#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/simulation_run.hpp"
#include "support/state_bits.hpp"
#include "unit/output/scratch.hpp"
#include "verification/restart/cases.hpp"

using namespace scree;

namespace {

struct Result {
  Checkpoint state;
  std::vector<std::vector<Real>> rows;
  std::int64_t left = 0;
  Real contact_loss = 0;
};

// One history sample: time, counts, ledger, momentum.
std::vector<Real> history_row(SimulationRun& run) {
  const StepCounts& n = run.counts();
  std::vector<Real> row{run.time(), run.balance_error(), run.balance().exchanged};
  for (const std::int64_t count :
       {n.steps, n.newton_iterations, n.linear_iterations, n.rejected_error, n.rejected_newton})
    row.push_back(static_cast<Real>(count));
  for (const Real entry : run.ledger().entries()) row.push_back(entry);
  const ParticleLedger particles = run.particle_ledger();
  for (const Vec3& v : {particles.momentum, particles.angular_momentum})
    row.insert(row.end(), {v.x, v.y, v.z});
  return row;
}

Result result_of(SimulationRun& run, std::vector<std::vector<Real>> rows) {
  const State& state = run.complete_state();
  return {with_rows_as_arrays(pack(state)), std::move(rows), state.carried_out.left,
          run.particle_ledger().contact_loss};
}

Result whole_run(const Model& model) {
  SimulationRun run(model);
  std::vector<std::vector<Real>> rows;
  run.run([&] { rows.push_back(history_row(run)); });
  return result_of(run, std::move(rows));
}

// Of each case once, for all that is compared with it.
const Result& whole_run(const RestartCase& restart_case) {
  static std::map<std::string, Result> results;
  const auto found = results.find(restart_case.name);
  return found != results.end()
             ? found->second
             : results.emplace(restart_case.name, whole_run(restart_case.model)).first->second;
}

// Stops at the first step beyond the fraction `share` of the time, writes a checkpoint, and continues from
// the file.
Result interrupted_run(const Model& model, Real share) {
  const ScratchDirectory directory;
  std::vector<std::vector<Real>> rows;
  {
    SimulationRun first(model);
    first.run_until(share * model.time.end, [&] { rows.push_back(history_row(first)); });
    REQUIRE(first.time() < model.time.end);
    write_checkpoint(directory / "checkpoint.h5", pack(first.complete_state()));
  }
  SimulationRun second(model, unpack(read_checkpoint(directory / "checkpoint.h5")));
  second.run([&] { rows.push_back(history_row(second)); });
  return result_of(second, std::move(rows));
}

void check_same(const Result& a, const Result& b) {
  CHECK(measured("restart/state", "bits", BitForBit{differing_arrays(a.state, b.state)}));
  REQUIRE(a.rows.size() == b.rows.size());
  std::string differing;
  for (std::size_t row = 0; row < a.rows.size(); ++row)
    if (!same_bits(a.rows[row], b.rows[row])) differing += fmt::format("row {} ", row);
  CHECK(measured("restart/history", "bits", BitForBit{differing}));
}

}  // namespace

TEST_CASE("a restarted run continues bit for bit") {
  for (const RestartCase& restart_case : restart_cases()) {
    CAPTURE(restart_case.name);
    const Result& whole = whole_run(restart_case);
    // There are events that a wrong restart would change.
    CHECK(whole.rows.size() > 5);
    CHECK((whole.contact_loss > 0 || restart_case.model.contact.law(0, 0).normal_damping == 0));
    CHECK((whole.left > 0) == restart_case.leaves);
    check_same(whole, interrupted_run(restart_case.model, 0.5));
    check_same(whole, interrupted_run(restart_case.model, 0.93));
  }
}

TEST_CASE("a run continues bit for bit from its start, where contacts rotate spatial bodies") {
  for (const std::vector<std::string>& way : kWays) {
    CAPTURE(way);
    std::vector<std::string> overrides = way;
    overrides.insert(overrides.end(), {"time.end=0.01", "output.history_interval=0.002",
                                       "bodies.block.body_angular_velocity=[3.0, 1.0, -2.0]",
                                       "bodies.block.center_of_mass=[0.01, 0.0, 0.005]"});
    const Model model = model_of(kFrictionalShapes, overrides);
    check_same(whole_run(model), interrupted_run(model, 0));
  }
}
TEST_CASE("the neighbour list's skin does not change a bit") {
  for (const RestartCase& restart_case : restart_cases()) {
    CAPTURE(restart_case.name);
    const Result& whole = whole_run(restart_case);
    for (const Real factor : {0.2, 2.3}) {
      Model other = restart_case.model;
      other.contact.skin *= factor;
      CAPTURE(factor);
      check_same(whole, whole_run(other));
    }
  }
}
