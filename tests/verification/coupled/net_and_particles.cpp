// Case 5.3 of Jung, Jun, Sohn (2013): particles fall on the net.
#include <fmt/format.h>

#include <cmath>
#include <iostream>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/reference.hpp"
#include "support/simulation_run.hpp"

using namespace scree;

namespace {

std::vector<Vec3> positions(const SimulationRun& run) {
  std::vector<Vec3> out;
  for (const Particle& particle : run.particles()) out.push_back(particle.position);
  return out;
}

Real largest_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  REQUIRE(a.size() == b.size());
  Real largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, norm(a[i] - b[i]));
  return largest;
}

// The nine particles of a row of the reference.
std::vector<Vec3> nine_of(const std::vector<Real>& row) {
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < 9; ++i) out.push_back({row[1 + 4 * i], row[2 + 4 * i], 0});
  return out;
}

}  // namespace

TEST_CASE("5.3 with 9 particles at h = 1e-5 follows the truth to 0.45 s") {
  constexpr Real kPhysical =
      5e-5;  // [m]: perturbations have grown by 1e2 at that time (tests/reference/README.md)
  constexpr Real kBalance = 1e-4;
  const auto truth = reference_rows("mix53_tensile_noself_particles20_28.csv");
  const Model model = input_model("paper/net_9.toml", {"time.step=1e-5", "time.end=0.45"});
  SimulationRun run(model);
  Real largest = 0;
  std::size_t sample = 0;
  run.run([&] {
    const std::vector<Real>& row = truth.at(++sample);
    REQUIRE(std::abs(row[0] - run.time()) < 1e-9);
    largest = std::max(largest, largest_distance(positions(run), nine_of(row)));
  });
  CHECK(sample == 450);
  std::cout << fmt::format(
      "5.3, N = 9, h = 1e-5: off by {:.2e} m; balance error {:.1e} J of {:.4g} J exchanged\n", largest,
      run.balance_error(), run.exchanged());
  CHECK(measured("net_9/position", "m", keeps(largest, {.promise = kPhysical, .measured = 1.6e-6})));
  CHECK(keeps(run.balance_error() / run.exchanged(), {.promise = kBalance, .measured = 4e-7}));
}

TEST_CASE("5.3 with 9 particles converges with second order through the first impacts") {
  constexpr Real kTruncationOrder = 0.1;
  const auto truth = reference_rows("mix53_tensile_noself_particles20_28.csv");
  const auto error = [&](const std::string& h) {
    const Model model = input_model("paper/net_9.toml", {"time.step=" + h, "time.end=0.43"});
    SimulationRun run(model);
    run.run();
    return largest_distance(positions(run), nine_of(truth.at(430)));
  };
  const Real coarse = error("4e-5"), fine = error("2e-5"), order = std::log2(coarse / fine);
  std::cout << fmt::format("5.3, N = 9 at 0.43 s: off by {:.2e} m at h = 4e-5, order {:.3f}\n", coarse,
                           order);
  CAPTURE(coarse, fine);
  CHECK(measured("net_9/order", "", in_range(order, 2 - kTruncationOrder, 2 + kTruncationOrder)));
  CHECK(keeps(order - 2, {.promise = kTruncationOrder, .measured = 0.009}));
}

TEST_CASE("5.3 with 400 particles has the ensemble's energies at 0.4 s") {
  constexpr Real kPhysical = 1e-3;  // of each value; the standard deviation is far below
  const Model model = input_model("paper/net_400.toml", {"time.step=2e-5", "time.end=0.4"});
  SimulationRun run(model);
  run.run();
  const Ledger ledger = run.ledger();
  const Real dissipated = ledger.dissipated_contacts + ledger.dissipated_force_elements;
  std::cout << fmt::format(
      "5.3, N = 400 at 0.4 s: kinetic {:.2f}, gravitational {:.2f}, springs {:.4f}, dissipated "
      "{:.4f}, total {:.3f} J\n",
      ledger.kinetic, ledger.gravitational, ledger.elastic_force_elements, dissipated, ledger.mechanical());
  CHECK(keeps(ledger.kinetic / 2905.1 - 1, {.promise = kPhysical, .measured = 3.8e-5}));
  CHECK(keeps(ledger.gravitational / 1287.2 - 1, {.promise = kPhysical, .measured = 2.2e-6}));
  CHECK(keeps(ledger.elastic_force_elements / 75.845 - 1, {.promise = kPhysical, .measured = 4.8e-5}));
  CHECK(keeps(dissipated / 60.232 - 1, {.promise = kPhysical, .measured = 3e-5}));
  CHECK(keeps(ledger.mechanical() / 4293.9 - 1, {.promise = kPhysical, .measured = 2.4e-7}));
}
