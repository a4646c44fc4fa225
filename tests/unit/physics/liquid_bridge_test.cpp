// Liquid bridges: force, energy and rupture distance against closed forms, life of a contact, friction.
#include "physics/liquid_bridge.hpp"

#include <vector>

#include "physics/contact_law.hpp"
#include "physics/tangential_laws.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/reference_table.hpp"

namespace scree {

namespace {

constexpr Real kTable = 1e-13;  // its digits, and the round-off of powers of V
constexpr Real kRoundOff = 16 * kUlp;

LiquidBridge liquid_of(const ReferenceTable::Row& row) {
  return {.volume = row["volume"],
          .surface_tension = row["gamma"],
          .contact_angle = row["theta"],
          .soulie = row.word("form") == "soulie"};
}

using WetSpring = BridgeLaw<LinearRestitutionLaw>;
const LinearRestitutionLaw kSpring(1e4, 0, 0, false);
const LiquidBridge kWater{.volume = 1e-3, .surface_tension = 0.0728};
constexpr PairSize kGrains{1e-3, 1e-3, 1e-5, 1e-5};

// A contact at rest at this overlap.
MovingPair at_rest(Real overlap, Real overlap0) {
  const Real distance = kGrains.radius_i + kGrains.radius_j - overlap;
  const ContactGeometry geometry{overlap, distance, {0, 0, 1}, 1};
  ContactMotion rest = sphere_motion(geometry, {}, {{}, kGrains.radius_i, 1}, {{}, kGrains.radius_j, 1}, 1);
  rest.overlap0 = overlap0;
  return {{geometry, {}, kGrains}, rest};
}

}  // namespace

TEST_CASE("liquid bridges: force, rupture distance and work of the closed forms") {
  const ReferenceTable table("contact/liquid_bridge.csv");
  for (const auto& row : table.rows()) {
    CAPTURE(row.word("form"), row["R1"], row["R2"], row["volume"]);
    for (const bool exchanged : {false, true}) {
      const PairSize size{row[exchanged ? "R2" : "R1"], row[exchanged ? "R1" : "R2"], 1, 1};
      const auto pair = WetSpring(kSpring, liquid_of(row)).of_pair(size);
      CHECK(near(pair.attraction, row["F0"], {.relative = kTable}));
      CHECK(near(pair.range, row["S_c"], {.relative = kTable}));
      CHECK(near(pair.formation_loss(), row["W"], {.relative = kTable}));
      CHECK(near(-pair.elastic(0), row["F0"], {.relative = kTable}));
      for (const int percent : {10, 25, 50, 75, 100}) {
        const Real d = -0.01 * percent * row["S_c"], force = row["F" + std::to_string(percent)];
        CHECK(near(-pair.elastic(d), force, {.relative = kTable}));
        CHECK(pair.friction_load(pair.elastic(d), d) == 0);
      }
      CHECK(pair.energy(0) == -pair.formation_loss());
      CHECK(near(pair.energy(-pair.range), 0, {.absolute = kRoundOff * row["W"]}));
    }
  }
}

TEST_CASE("the force of a bridge is the slope of its energy, and its slope that of the force") {
  const ReferenceTable table("contact/liquid_bridge.csv");
  for (const auto& row : table.rows()) {
    CAPTURE(row.word("form"), row["R2"]);
    const auto pair = BridgeLaw<HertzLaw>(HertzLaw(1e7, 0, false), liquid_of(row))
                          .of_pair({row["R1"], row["R2"], 1, kInfinity});
    for (const Real share : {-0.9, -0.5, -0.1, 0.05, 0.3}) {
      const Real d = share * pair.range, step = 1e-4 * pair.range;
      const Real force = (pair.energy(d + step) - pair.energy(d - step)) / (2 * step);
      const Real slope = (pair.elastic(d + step) - pair.elastic(d - step)) / (2 * step);
      CHECK(near(pair.elastic(d), force, {.relative = 1e-6, .absolute = 1e-6 * pair.attraction}));
      CHECK(near(pair.slope(d), slope, {.relative = 1e-5, .absolute = 1e-6 * pair.attraction / pair.length}));
    }
    CHECK(near(pair.cohesion(0.1 * pair.range), -row["W"] - 0.1 * pair.range * row["F0"],
               {.relative = kTable}));
  }
}

TEST_CASE("a bridge forms at touch, acts in the gap that opens, and breaks at its rupture distance") {
  const ContactLaw<WetSpring, LinearSlider> law{WetSpring(kSpring, kWater), {1e3, 0.5, 0}};
  static_assert(decltype(law)::kHistory == 4);
  const auto pair = law.normal.of_pair(kGrains);
  const Real reach = pair.range;
  const auto at = [&](Real share, const ContactHistory& old) {
    return law.respond(at_rest(share * reach, share * reach), old);
  };
  const ContactHistory touched{{}, {}, true};
  CHECK(at(-0.1, {}).load.force == Vec3{});
  CHECK_FALSE(at(-0.1, {}).history.touched);
  CHECK(at(0.1, {}).history.touched);
  CHECK(at(0.1, {}).load.loss == pair.formation_loss());  // in a step of 1 s
  CHECK(at(0.1, touched).load.loss == 0);
  CHECK(at(-0.1, touched).history.touched);
  CHECK(near(at(-0.1, touched).load.force.z, pair.elastic(-0.1 * reach), {.relative = kRoundOff}));
  CHECK(at(-1.001, touched).load.force == Vec3{});
  CHECK_FALSE(at(-1.001, touched).history.touched);
  CHECK(law.energy_of(at_rest(0.1 * reach, 0), {}).sum == pair.energy(0.1 * reach) + pair.formation_loss());
}

TEST_CASE("in a gap a bridge holds no friction: the spring's energy is dissipated as the contact opens") {
  const Vec3 spring{2e-5, -1e-5, 0};
  const auto check = [&](const auto& law) {
    const Real d0 = 1e-7, before = law.springs_at(d0, {0, 0, 1}, kGrains, {spring, {}, true}).friction;
    REQUIRE(before > 0);
    const ContactOutcome out = law.respond(at_rest(-1e-7, d0), {spring, {}, true});
    CHECK(out.history.spring == Vec3{});
    CHECK((out.history.touched && out.load.force.x == 0 && out.load.force.z < 0));
    CHECK(near(out.friction.sum(), before, {.relative = kRoundOff}));
    CHECK(near(out.load.loss, before, {.relative = kRoundOff}));
    CHECK(law.respond(at_rest(-2e-7, -1e-7), out.history).load.loss == 0);
    CHECK(law.respond(at_rest(-1, -1e-7), out.history).load.loss == 0);
  };
  check(ContactLaw<WetSpring, LinearSlider>{WetSpring(kSpring, kWater), {1e3, 0.5, 0.3}});
  check(ContactLaw<BridgeLaw<HertzLaw>, MindlinSlider>{{HertzLaw(1e8, 0, false), kWater}, {1e8, 0.5, 0.3}});
}

TEST_CASE("friction is limited by the load of the surfaces: the normal force plus the bridge's") {
  const auto pair = WetSpring(kSpring, kWater).of_pair(kGrains);
  const Real d = 1e-6;
  CHECK(near(pair.friction_load(pair.elastic(d), d), pair.repulsion.elastic(d), {.relative = kRoundOff}));
  CHECK(near(normal_contact(pair, kGrains, pair.elastic(d), d, d).friction_load, 1e4 * d,
             {.relative = kRoundOff}));
}

TEST_CASE("viscous liquid: damping of the gap, of which friction knows nothing") {
  LiquidBridge oil = kWater;
  oil.viscosity = 0.1, oil.least_gap = 0.01;
  const LinearRestitutionLaw spring(1e4, 0.02, 0, false);
  const auto pair = WetSpring(spring, oil).of_pair(kGrains);
  constexpr Real kRadius = 0.5e-3, kStokes = 6 * std::numbers::pi_v<Real> * 0.1 * kRadius;
  CHECK(near(pair.damping(-5e-5), kStokes / 0.1, {.relative = kRoundOff}));
  CHECK(near(pair.damping(-1e-9), kStokes / 0.01, {.relative = kRoundOff}));
  CHECK(near(pair.damping(1e-6), 0.02 + kStokes / 0.01, {.relative = kRoundOff}));
  const Real rate = 0.3;
  for (const Real d : {1e-6, -5e-5}) {
    const ContactForce f = contact_force(pair, d, rate);
    CHECK(near(f.loss, pair.damping(d) * rate * rate, {.relative = kRoundOff}));
    CHECK(near(pair.friction_load(f.force, d), d > 0 ? 1e4 * d + 0.02 * rate : 0, {.relative = 1e-12}));
  }
  const NormalLawParameters law{
      .normal_stiffness = 1e4, .normal_damping = 0.02, .own = BridgeParameters(oil)};
  CHECK(near(law_of_size(law, kGrains).normal_damping, 0.02 + kStokes / 0.01, {.relative = kRoundOff}));
}

TEST_CASE("pairs without liquid follow the law beside which bridges act") {
  const LinearRestitutionLaw spring(1e4, 0.5, 0, false);
  const ContactLaw<WetSpring, LinearSlider> none{WetSpring(spring, {}), {1e3, 0.5, 0}};
  const ContactLaw<LinearRestitutionLaw, LinearSlider> dry{spring, {1e3, 0.5, 0}};
  for (const Real rate : {-0.1, 0.1}) {
    MovingPair pair = at_rest(1e-6, 1e-6);
    pair.velocity = {0, 0, -rate};
    pair.motion.slip = {1e-7, 0, 0};
    const ContactOutcome a = none.respond(pair, {}), b = dry.respond(pair, {});
    CHECK((a.load.force == b.load.force && a.load.loss == b.load.loss));
    CHECK(a.history.spring == b.history.spring);
    CHECK(none.energy_of(pair, a.history).sum == dry.energy_of(pair, b.history).sum);
  }
  CHECK_FALSE(none.closed(at_rest(-1e-9, 1e-9), {{}, {}, true}));
  CHECK(none.normal.of_pair(kGrains).formation_loss() == 0);
}

}  // namespace scree
