// Liquid bridges of particles with moving walls, meshes and shapes of bodies, through decks.
#include "physics/liquid_bridge.hpp"

#include "support/bars.hpp"
#include "support/measured.hpp"
#include "verification/surfaces/pulled_sphere.hpp"

namespace scree {

namespace {

constexpr LiquidBridge kWater{.volume = 1e-4, .surface_tension = 0.0728, .contact_angle = 0.2};
const std::string kWet = "bridge_volume = 1e-4\nsurface_tension = 0.0728\ncontact_angle = 0.2\n";

// The bridge of the sphere with a plane, or with a sphere of this radius [m].
BridgePair<HertzPairOf<Real>> bridge_on(Real radius) {
  return BridgeLaw<HertzLaw>(HertzLaw(4 * kYoung / 3, 0, true), kWater)
      .of_pair({kRadius, radius, 1, kInfinity});
}

}  // namespace

TEST_CASE("a liquid bridge pulls with its force at touch, and breaks at its rupture distance") {
  for (const PulledTarget& c : pulled_targets()) {
    CAPTURE(c.name);
    const auto bridge = bridge_on(c.radius < kRadius ? 0.005 : kInfinity);
    const Pull pull = pull_apart({.target = c.target, .law = kWet, .end = 2e-3});
    const Real displacement = kSpeed * 1e-6;  // in a step [m]
    // Read after the first step beyond touch.
    CHECK(measured("bridge/pull", "",
                   keeps(pull.largest / bridge.attraction - 1, {.promise = 1e-4, .measured = 5.2e-6})));
    CHECK(near(pull.last, -bridge.elastic(-bridge.range), {.relative = 1e-2}));
    CHECK(measured("bridge/length", "steps", at_most((pull.broken - bridge.range) / displacement, 1.1)));
    CHECK(measured("bridge/pull_balance", "",
                   keeps(pull.balance / bridge.formation_loss(), {.promise = 1e-3, .measured = 9.5e-6})));
  }
}

TEST_CASE("a liquid bridge moves along a face and over its edge without a jump") {
  slide_over_an_edge(kWet, bridge_on(kInfinity), 0.055);
}

TEST_CASE("a stretched liquid bridge continues after a restart, whatever its list covers") {
  restart_under_tension(kWet, bridge_on(kInfinity).range / 3);
  restart_under_tension(kWet + "bridge_force = \"soulie\"\nbridge_viscosity = 1e-3\n",
                        bridge_on(kInfinity).range / 3);
}

TEST_CASE("an impact loses the work of the bridge, on meshes and on free bodies, and the balance closes") {
  constexpr Real kMass = 1e-5, kBody = 3e-5, kSphere = 0.002;
  struct Case {
    std::string name, target;
    Real radius, mass;  // of the target [m]; m* [kg]
  };
  const std::vector<Case> cases = {
      {"wall",
       box("offset = [0, 0, -0.005]\n") +
           "[[walls]]\nname = \"target\"\nmesh = \"box\"\nmaterial = \"stiff\"\n",
       kInfinity, kMass},
      {"sphere of a body",
       fmt::format(
           "[[bodies]]\nname = \"target\"\nkind = \"spatial\"\nposition = [0, 0, {}]\nmass = {}\n"
           "inertia_tensor = [1, 1, 1, 0, 0, 0]\nshapes = [{{ radius = {}, material = \"stiff\" }}]\n",
           -kSphere, kBody, kSphere),
       kSphere, kMass * kBody / (kMass + kBody)}};
  for (const Case& c : cases) {
    CAPTURE(c.name);
    const auto bridge = bridge_on(c.radius);
    const Real loss = bridge.formation_loss(), speed = 2 * std::sqrt(2 * loss / c.mass);
    const Real step = bridge.range / speed / 2000;
    SimulationRun run(
        CohesiveDeck{.target = c.target,
                     .law = kWet,
                     .step = step,
                     .end = 20 * bridge.range / speed,
                     .grain = fmt::format("positions = [[0, 0, {:.17g}]]\nvelocity = [0, 0, {}]\n"
                                          "mass = {}\n",
                                          kRadius + speed * step / 2, -speed, kMass)}
            .model());
    while (run.particle_ledger().contacts == 0) run.step();
    CHECK(near(run.particle_ledger().contact_loss, loss, {.relative = 1e-9}));
    run.run();
    const ParticleLedger ledger = run.particle_ledger();
    CHECK((ledger.contacts == 0 && ledger.contact_elastic == 0 && ledger.cohesion == 0));
    CHECK(near(ledger.contact_loss, loss, {.relative = 1e-9}));
    const Real away = run.particles()[0].velocity.z -
                      (c.mass < kMass ? run.multibody().motion(run.bodies())[0].velocity.z : 0);
    CHECK(near(away / speed, std::sqrt(0.75), {.absolute = 1e-3}));
    CHECK(measured("bridge/impact_balance", "",
                   keeps(run.balance_error() / loss, {.promise = 1e-3, .measured = 1.7e-5})));
  }
}

}  // namespace scree
