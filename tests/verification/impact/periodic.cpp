// Impacts across periodic sides.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/reference.hpp"
#include "support/simulation_run.hpp"

using namespace scree;

namespace {

const std::string kPair = R"(
[space]
dimension = 2
min = [0.0, 0.0]
max = [1.0, 1.0]
x_min = "periodic"
x_max = "periodic"
y_min = "periodic"
y_max = "periodic"
[time]
end = 0.02
step = 1e-5
control = "fixed"
[[contact.pairs]]
stiffness = 1e5
damping = 20.0
[[particles]]
name = "pair"
kind = "list"
positions = [[0.25, 0.5], [0.36, 0.52]]
radius = 0.05
mass = 1.0
)";

// The left particle hits the right one; both have the velocity `drift` [m/s] in addition. Everything is
// shifted by `shift` [m] to the right.
std::vector<Particle> after_impact(Real shift, Vec3 drift, const std::string& integrator) {
  Model model = model_of(kPair, {"integrator.particles=" + integrator});
  for (Vec3& position : model.particles.position) position.x = std::fmod(position.x + shift, 1);
  model.particles.velocity = {drift + Vec3{2, 0, 0}, drift};
  SimulationRun run(model);
  bool touched = false;
  run.run([&] { touched = touched || run.particle_ledger().contacts > 0; });
  REQUIRE(touched);
  return run.particles();
}

}  // namespace

TEST_CASE("an impact is the same across a periodic side") {
  constexpr Real kRoundOff = 1e-10;  // of positions that differ by the shift, times K h / m over the contact
  for (const std::string integrator : {"hht", "velocity-verlet"}) {
    const auto inside = after_impact(0, {}, integrator);
    // A shift of 0.69 puts the side between the two; 0.745 puts it through the left one.
    for (const Real shift : {0.69, 0.745}) {
      const auto across = after_impact(shift, {}, integrator);
      for (const std::size_t i : {0u, 1u}) {
        CAPTURE(integrator, shift, i);
        CHECK(
            keeps(norm(across[i].velocity - inside[i].velocity), {.promise = kRoundOff, .measured = 7e-13}));
        const Real moved = across[i].position.x - inside[i].position.x - shift;
        CHECK(keeps(moved - std::round(moved), {.promise = kRoundOff, .measured = 1e-14}));
      }
    }
  }
}

TEST_CASE("a pair that crosses a periodic side in contact stays in contact") {
  constexpr Real kTruncation = 1e-9;  // no rotation of the drift: velocities differ by it alone
  for (const std::string integrator : {"hht", "velocity-verlet"}) {
    const auto resting = after_impact(0, {}, integrator);
    // While in contact, about 5 ms, the pair moves by 0.2 m, over the side.
    const auto crossing = after_impact(0.5, {40, 0, 0}, integrator);
    for (const std::size_t i : {0u, 1u}) {
      CAPTURE(integrator, i);
      CHECK(keeps(norm(crossing[i].velocity - Vec3{40, 0, 0} - resting[i].velocity),
                  {.promise = kTruncation, .measured = 2e-12}));
      CHECK(crossing[i].image.x >= 1);
    }
  }
}

TEST_CASE("a periodic gas keeps momentum and energy") {
  constexpr Real kRoundOff = 1e-12, kTruncation = 1e-3;
  // 0.05 s: every sphere has collided about once.
  const Model model = input_model("examples/gas_periodic.toml", {"time.end=0.05"});
  SimulationRun run(model);
  const ParticleLedger start = run.particle_ledger();
  std::int64_t most_contacts = 0;
  run.run([&] {
    const ParticleLedger now = run.particle_ledger();
    most_contacts = std::max(most_contacts, now.contacts);
    const Real energy = now.kinetic + now.contact_elastic;
    REQUIRE(keeps(energy / start.kinetic - 1, {.promise = kTruncation, .measured = 5.2e-6}));
  });
  CHECK(most_contacts > 20);
  const Real scale = std::sqrt(2 * start.kinetic * 2000 * model.particles.mass[0]);
  CHECK(keeps(norm(run.particle_ledger().momentum - start.momentum) / scale,
              {.promise = kRoundOff, .measured = 1e-15}));
  CHECK(keeps(run.balance_error() / run.exchanged(), {.promise = kTruncation, .measured = 2.5e-5}));
}
