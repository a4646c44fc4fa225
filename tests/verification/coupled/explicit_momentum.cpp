// Explicit particles and a free body: their total momentum over an impact.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
#include <string>

#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/models.hpp"
#include "support/simulation_run.hpp"

using namespace scree;

namespace {

constexpr Real kStiffness = 1e6, kSpeed = 2, kMass = 1;  // [N/m], [m/s], [kg] of either
const Real kContactTime = std::numbers::pi * std::sqrt(kMass / 2 / kStiffness);  // [s]

std::string deck(Real gap, Real damping) {
  return fmt::format(R"(
[space]
dimension = 2
min = [-1.0, -1.0]
max = [1.0, 1.0]
[time]
end = 1.0
step = 1e-5
control = "fixed"
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = {}
damping = {}
[[bodies]]
name = "disc"
position = [0.0, 0.0]
mass = {}
inertia = 0.00125
shapes = [{{ radius = 0.05 }}]
[[particles]]
name = "falling"
kind = "list"
positions = [[{}, 0.03]]
radius = 0.05
mass = {}
velocity = [-{}, 0.0]
)",
                     kStiffness, damping, kMass, std::sqrt(0.1 * 0.1 - 0.03 * 0.03) + gap, kMass, kSpeed);
}

// The change of the momentum of particle and body, 2 kg m/s, after the impact: the largest of some phases of
// the touch within a step of h [s].
Real momentum_error(Real h, int substeps, Real damping) {
  constexpr int kPhases = 8;
  Real largest = 0;
  for (int phase = 0; phase < kPhases; ++phase) {
    const Real gap = kSpeed * h * (1.5 + (phase + 0.5) / kPhases);
    Model model = model_of(deck(gap, damping), {fmt::format("integrator.substeps={}", substeps)});
    model.time.step = model.time.max_step = h;
    model.time.end = h * std::ceil(2 * kContactTime / h + 4);
    SimulationRun run(model);
    const auto momentum = [&] {
      const std::vector<Real>& v = run.bodies().velocity;
      return run.particle_ledger().momentum + kMass * Vec3{v[0], v[1], 0};
    };
    const Vec3 start = momentum();
    run.run();
    REQUIRE(run.particle_ledger().contacts == 0);
    REQUIRE(run.bodies().velocity[0] < -0.5 * kSpeed);
    largest = std::max(largest, norm(momentum() - start));
  }
  return largest;
}

}  // namespace

// A step of the particles uses the predicted pose of the body, the next one begins at its corrected pose.
// Damping jumps at touch: the difference of the two poses then counts to first order.
TEST_CASE("explicit particles and a free body keep their momentum to the order of the method") {
  struct Claim {
    int substeps;
    Real damping, error, order;  // [N s/m]; at a twentieth of the contact time, at most [kg m/s]; at least
  };
  for (const Claim& claim : {Claim{1, 0, 5e-5, 1.75}, Claim{10, 0, 1.3e-4, 1.75}, Claim{10, 20, 2e-4, 0.9}}) {
    const auto error = [&](Real steps) {
      return momentum_error(kContactTime / steps, claim.substeps, claim.damping);
    };
    const Real coarse = error(20), fine = error(80), order = std::log2(coarse / fine) / 2;
    std::cout << fmt::format(
        "explicit particle on a free body, {} substeps, damping {}: of 2 kg m/s {:.1e} appear or are lost at "
        "T/20, {:.1e} at T/80, order {:.2f}\n",
        claim.substeps, claim.damping, coarse, fine, order);
    CAPTURE(claim.substeps, claim.damping, coarse, fine);
    const std::string key = fmt::format("{} substeps, damping {}", claim.substeps, claim.damping);
    CHECK(measured("free_body/" + key, "kg m/s", at_most(coarse, claim.error)));
    CHECK(measured("free_body/" + key + ", order", "", at_least(order, claim.order)));
  }
}
