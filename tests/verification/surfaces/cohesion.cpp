// Cohesion of particles with meshes, moving walls and shapes of bodies, through decks.
#include "physics/cohesion.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "dem/reports/triangle_works.hpp"
#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"
#include "support/state_bits.hpp"
#include "verification/surfaces/pulled_sphere.hpp"

namespace scree {

namespace {

constexpr Real kWork = 0.1, kPi = std::numbers::pi_v<Real>;
const std::string kSticky = fmt::format("work_of_adhesion = {}\n", kWork);

// Johnson, Kendall and Roberts' closed forms, for R*.
Real pull_off(Real radius) { return 1.5 * kPi * kWork * radius; }
Real pull_off_distance(Real radius) {
  return 3 * std::cbrt(kPi * kPi * kWork * kWork * radius / (64 * kYoung * kYoung));
}
Real formation_loss(Real radius) {
  return 7.09219597186396 * std::cbrt(std::pow(kWork, 5) * std::pow(radius, 4) / (kYoung * kYoung));
}

}  // namespace

TEST_CASE("JKR holds a sphere with up to 3/2 pi w R*, and breaks at the pull-off distance") {
  for (const PulledTarget& c : pulled_targets()) {
    CAPTURE(c.name);
    const Pull pull = pull_apart({.target = c.target, .law = kSticky});
    CHECK(measured("jkr/pull_off", "",
                   keeps(pull.largest / pull_off(c.radius) - 1, {.promise = 1e-5, .measured = 4.2e-8})));
    CHECK(near(pull.last, Real(5) / 9 * pull_off(c.radius), {.relative = 0.1}));
    const Real displacement = kSpeed * 1e-6;  // displacement in a step [m]
    CHECK(measured("jkr/length", "steps",
                   at_most((pull.broken - pull_off_distance(c.radius)) / displacement, 1.1)));
    CHECK(measured("jkr/balance", "",
                   keeps(pull.balance / formation_loss(c.radius), {.promise = 1e-2, .measured = 6e-4})));
  }
}

TEST_CASE("a JKR contact moves along a face and over its edge without a jump") {
  slide_over_an_edge(kSticky, JkrLaw(4 * kYoung / 3, 0, kWork).of_pair({kRadius, kInfinity, 1, kInfinity}),
                     5e-3);
}

namespace {

// A light sphere that hits the target, with a JKR contact that forms and breaks.
CohesiveDeck impact_on(const std::string& target, Real mass, Real speed, Real step) {
  return {.target = target,
          .law = kSticky,
          .step = step,
          .end = 40 * pull_off_distance(kRadius) / speed,
          .grain = fmt::format("positions = [[0, 0, {:.17g}]]\nvelocity = [0, 0, {}]\nmass = {}\n",
                               kRadius + speed * step / 2, -speed, mass)};
}

Real impact_work(const State& state) {
  Real sum = 0;
  for (const TriangleWorkValues& of : work_values(state.works)) sum += of.impact;
  return sum;
}

}  // namespace

TEST_CASE(
    "an impact loses the formation dissipation of JKR, on meshes and on free bodies, and the energy balance "
    "closes") {
  constexpr Real kMass = 1e-5, kBody = 3e-5, kSphere = 0.002;
  const auto free_body = [&](Real place, const std::string& surface) {
    return fmt::format(
               "[[bodies]]\nname = \"target\"\nkind = \"spatial\"\nposition = [0, 0, {}]\nmass = {}\n"
               "inertia_tensor = [1, 1, 1, 0, 0, 0]\n",
               place, kBody) +
           surface;
  };
  struct Case {
    std::string name, target;
    Real radius, mass;  // R* [m], m* [kg]
    bool mesh;
  };
  const Real both = kMass * kBody / (kMass + kBody);
  const std::vector<Case> cases = {
      {"wall",
       box("offset = [0, 0, -0.005]\n") +
           "[[walls]]\nname = \"target\"\nmesh = \"box\"\nmaterial = \"stiff\"\n",
       kRadius, kMass, true},
      {"mesh of a body", box("") + free_body(-0.005, "meshes = [{ mesh = \"box\", material = \"stiff\" }]\n"),
       kRadius, both, true},
      {"sphere of a body",
       free_body(-kSphere, fmt::format("shapes = [{{ radius = {}, material = \"stiff\" "
                                       "}}]\n",
                                       kSphere)),
       kRadius * kSphere / (kRadius + kSphere), both, false}};
  for (const Case& c : cases) {
    CAPTURE(c.name);
    const Real loss = formation_loss(c.radius), speed = 2 * std::sqrt(2 * loss / c.mass);
    Real balance[2];
    for (const int k : {0, 1}) {
      const Real step = pull_off_distance(c.radius) / speed / (50 * (1 + 3 * k));
      CohesiveDeck deck = impact_on(c.target, kMass, speed, step);
      deck.output = c.mesh ? "surface_fields = [\"impact_work\"]\n" : "";
      SimulationRun run(deck.model());
      while (run.particle_ledger().contacts == 0) run.step();
      CHECK(near(run.particle_ledger().contact_loss, loss, {.relative = 2e-2}));
      CHECK(near(run.particle_ledger().cohesion, -loss, {.relative = 0.2}));
      run.run();
      const ParticleLedger ledger = run.particle_ledger();
      CHECK((ledger.contacts == 0 && ledger.contact_elastic == 0 && ledger.cohesion == 0));
      CHECK(near(ledger.contact_loss, loss, {.relative = 2e-2}));
      if (c.mesh) CHECK(near(impact_work(run.complete_state()), ledger.contact_loss, {.relative = 1e-12}));
      const Real away = run.particles()[0].velocity.z -
                        (c.mass < kMass ? run.multibody().motion(run.bodies())[0].velocity.z : 0);
      CHECK(near(c.mass / 2 * (speed * speed - away * away), loss, {.relative = 3e-2}));
      balance[k] = std::abs(run.balance_error()) / loss;
    }
    CAPTURE(balance[0], balance[1]);
    CHECK(balance[1] < 1e-2);
    CHECK(balance[1] < 0.5 * balance[0]);
  }
}

TEST_CASE("a JKR contact under tension continues after a restart, whatever its list covers") {
  restart_under_tension(kSticky, pull_off_distance(kRadius) / 3);
}

}  // namespace scree
