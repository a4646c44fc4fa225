// Oblique impact of two free discs: conservation by pair forces that are opposite and normal.
#include <fmt/format.h>

#include <cmath>
#include <iostream>
#include <string>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/impacts.hpp"
#include "support/measured.hpp"
#include "support/simulation_run.hpp"

using namespace scree;

namespace {

const std::string kTwoDiscs = R"(
[space]
dimension = 2
min = [-1.0, -1.0]
max = [1.0, 1.0]
[time]
end = 6e-3
step = 2e-5
control = "fixed"
[[contact.pairs]]
stiffness = 1e6
damping = 50.0
[[particles]]
name = "left"
kind = "list"
positions = [[-0.0507, 0.02]]
radius = 0.05
mass = 1.0
velocity = [3.0, 0.4]
[[particles]]
name = "right"
kind = "list"
positions = [[0.0401, -0.03]]
radius = 0.04
mass = 0.6
velocity = [-2.0, -0.7]
)";

struct Conserved {
  Real momentum, angular_momentum;  // largest change over the impact, relative
};

// Changes over the whole impact, relative to the sum of the particles' own momenta.
Conserved changes(const std::vector<std::string>& overrides) {
  const Model model = model_of(kTwoDiscs, overrides);
  SimulationRun run(model);
  const ParticleLedger start = run.particle_ledger();
  Conserved largest{0, 0};
  bool touched = false;
  run.run([&] {
    const ParticleLedger now = run.particle_ledger();
    touched = touched || now.contacts > 0;
    const Real scale = 1.0 * std::hypot(3.0, 0.4) + 0.6 * std::hypot(2.0, 0.7), arm = 0.05;
    largest.momentum = std::max(largest.momentum, norm(now.momentum - start.momentum) / scale);
    const Real turned = norm(now.angular_momentum - start.angular_momentum) / (scale * arm);
    largest.angular_momentum = std::max(largest.angular_momentum, turned);
  });
  REQUIRE(touched);
  CHECK(run.particle_ledger().contacts == 0);
  CHECK(run.particle_ledger().contact_loss > 0.1);
  return largest;
}

}  // namespace

TEST_CASE("an oblique impact keeps momentum and, in velocity-verlet, angular momentum to round-off") {
  constexpr Real kRoundOff = 1e-13;
  const Conserved verlet = changes({"integrator.particles=velocity-verlet"});
  CHECK(measured("oblique/momentum", "", keeps(verlet.momentum, {.promise = kRoundOff, .measured = 2e-15})));
  CHECK(measured("oblique/angular_momentum", "",
                 keeps(verlet.angular_momentum, {.promise = kRoundOff, .measured = 2e-14})));
  for (const std::string hht_alpha : {"0.0", "-0.3"}) {
    const Conserved hht =
        changes({"integrator.hht_alpha=" + hht_alpha, "integrator.residual_tolerance=1e-13"});
    CAPTURE(hht_alpha, hht.momentum);
    CHECK(measured("oblique/momentum", "", keeps(hht.momentum, {.promise = kRoundOff, .measured = 3e-15})));
  }
}

// HHT takes the mean of the forces at both ends of a step, but they act at the arms of their own instants:
// it conserves angular momentum only to its order.
TEST_CASE("an oblique impact keeps angular momentum to second order in hht") {
  constexpr Real kTruncationOrder = 0.1, kTruncation = 1e-5;
  for (const std::string hht_alpha : {"0.0", "-0.3"}) {
    const auto change = [&](const std::string& h) {
      return changes({"integrator.hht_alpha=" + hht_alpha, "integrator.residual_tolerance=1e-12",
                      "time.step=" + h})
          .angular_momentum;
    };
    const Real coarse = change("8e-6"), fine = change("2e-6"), order = std::log2(coarse / fine) / 2;
    std::cout << fmt::format(
        "oblique impact, alpha = {}: angular momentum errs by {:.2e} at h = 8e-6, order {:.3f}\n", hht_alpha,
        coarse, order);
    CAPTURE(hht_alpha, coarse, fine);
    CHECK(measured("oblique/hht", "", keeps(coarse, {.promise = kTruncation, .measured = 9.2e-7})));
    CHECK(measured("oblique/order", "", in_range(order, 2 - kTruncationOrder, 2 + kTruncationOrder)));
  }
}
