// Case 5.2 of Jung, Jun, Sohn (2013): five particles fall into a valley of pinned bodies.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/reference.hpp"
#include "support/simulation_run.hpp"

using namespace scree;

namespace {

using Rows = std::vector<std::vector<Real>>;

// Largest distance [m] of the particles from the reference at its row for time t; samples are 1 ms apart.
Real distance(const SimulationRun& run, const Rows& truth) {
  const auto sample = static_cast<std::size_t>(std::lround(run.time() / 1e-3));
  const std::vector<Real>& row = truth.at(sample);
  REQUIRE(std::abs(row[0] - run.time()) < 1e-9);
  const std::vector<Particle> particles = run.particles();
  Real largest = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Vec3 p = particles[i].position;
    largest = std::max(largest, std::hypot(p.x - row[1 + 4 * i], p.y - row[2 + 4 * i]));
  }
  return largest;
}

// Rise of the energy above its lowest value so far [J].
class EnergyRise {
 public:
  explicit EnergyRise(SimulationRun& run) : run_(run), lowest_(run.ledger().mechanical()) {}
  void operator()() {
    const Real now = run_.ledger().mechanical();
    lowest_ = std::min(lowest_, now);
    largest_ = std::max(largest_, now - lowest_);
  }
  Real largest() const { return largest_; }

 private:
  SimulationRun& run_;
  Real lowest_, largest_ = 0;
};

}  // namespace

TEST_CASE("5.2 at h = 1e-5 follows the truth, and its energy does not rise") {
  // Physical: perturbations have grown by 2e3 in the first second (tests/reference/README.md).
  constexpr Real kPhysical070 = 1e-5, kPhysical080 = 4e-4, kPhysical100 = 5e-3;  // [m]
  constexpr Real kIteration = 1e-8;  // the rise at the default tolerances [J], of 300 J exchanged
  constexpr Real kBalance = 1e-4;
  const Rows truth = reference_rows("coll52_tensile.csv"),
             energies = reference_rows("coll52_tensile_energy.csv");
  const Model model = input_model("paper/valley.toml", {"time.control=fixed", "time.step=1e-5"});
  SimulationRun run(model);
  EnergyRise rise(run);
  std::vector<Real> error;
  for (const Real t : {0.7, 0.8, 1.0}) {
    run.run_until(t - 5e-6, std::ref(rise));
    error.push_back(distance(run, truth));
  }
  std::cout << fmt::format(
      "5.2, h = 1e-5: off by {:.2e}, {:.2e}, {:.2e} m at 0.7, 0.8, 1 s; energy rises by {:.1e} J above its "
      "lowest; "
      "balance error {:.1e} J of {:.4g} J exchanged\n",
      error[0], error[1], error[2], rise.largest(), run.balance_error(), run.exchanged());
  CHECK(measured("valley/0.7 s", "m", at_most(error[0], kPhysical070)));
  CHECK(measured("valley/0.8 s", "m", keeps(error[1], {.promise = kPhysical080, .measured = 5e-5})));
  CHECK(measured("valley/1.0 s", "m", keeps(error[2], {.promise = kPhysical100, .measured = 3e-4})));
  CHECK(measured("valley/rise", "J", at_most(rise.largest(), kIteration)));
  CHECK(measured("valley/balance", "",
                 keeps(run.balance_error() / run.exchanged(), {.promise = kBalance, .measured = 1e-15})));
  const std::vector<Real>& end = energies.back();
  CHECK(keeps(run.ledger().dissipated_contacts / end[5] - 1, {.promise = 1e-3, .measured = 1.2e-4}));
}

TEST_CASE("in 5.2 what the iteration leaves over is what the energy rises by") {
  constexpr Real kIteration = 1e-9;  // [J], of 300 J exchanged
  const Model model = input_model(
      "paper/valley.toml", {"time.control=fixed", "time.step=1e-5", "integrator.residual_tolerance=1e-10"});
  SimulationRun run(model);
  EnergyRise rise(run);
  run.run(std::ref(rise));
  std::cout << fmt::format(
      "5.2, h = 1e-5, residual tolerance 1e-10: energy rises by {:.1e} J above its lowest\n", rise.largest());
  CHECK(measured("valley/tight rise", "J", at_most(rise.largest(), kIteration)));
}

TEST_CASE("5.2 with adaptive steps at the default tolerance") {
  constexpr Real kPhysical = 1e-2;  // [m]
  constexpr std::int64_t kMostSteps = 20000;
  const Model model = input_model("paper/valley.toml");
  SimulationRun run(model);
  run.run();
  const Real error = distance(run, reference_rows("coll52_tensile.csv"));
  std::cout << fmt::format("5.2, adaptive: off by {:.2e} m at 1 s after {} steps\n", error,
                           run.counts().steps);
  CHECK(measured("valley/adaptive", "m", keeps(error, {.promise = kPhysical, .measured = 1.3e-4})));
  CHECK(measured("valley/adaptive steps", "",
                 at_most(static_cast<Real>(run.counts().steps), static_cast<Real>(kMostSteps))));
}
