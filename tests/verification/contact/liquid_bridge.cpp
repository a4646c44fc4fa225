// Impacts and slow separation of wet grains against closed forms.
#include "physics/liquid_bridge.hpp"

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/near.hpp"
#include "support/reference_table.hpp"
#include "verification/contact/errors.hpp"
#include "verification/contact/leapfrog.hpp"

namespace scree {

namespace {

using WetLaw = ContactLaw<BridgeLaw<HertzLaw>>;
constexpr Real kDensity = 2500;

LiquidBridge liquid_of(const ReferenceTable::Row& row) {
  return {.volume = row["volume"],
          .surface_tension = row["gamma"],
          .contact_angle = row["theta"],
          .soulie = row.word("form") == "soulie"};
}
Grain grain_of(Real radius) { return {.radius = radius, .mass = sphere_mass(radius, kDensity)}; }

// Two grains that meet along x in the middle of the first step; a plane counts as a grain of infinite mass.
PairRun<WetLaw> meeting(const ReferenceTable::Row& row, Real speed, Real h) {
  PairRun<WetLaw> run{.law = {{HertzLaw(1e7, 0, false), liquid_of(row)}},
                      .i = grain_of(row["R1"]),
                      .j = grain_of(row["R2"]),
                      .h = h};
  run.i.position = {run.i.radius + run.j.radius + speed * h / 2, 0, 0};
  run.i.velocity = {-speed, 0, 0};
  return run;
}
Real reduced(const PairRun<WetLaw>& run) { return run.i.mass * run.j.mass / (run.i.mass + run.j.mass); }

struct Rebound {
  Real restitution, balance;  // balance error over the kinetic energy of the relative motion
};

// Rebound of an impact; 0 where the grains stick. steps: of the gap of the rupture distance at this speed.
Rebound rebound_of(const ReferenceTable::Row& row, Real speed, Real steps) {
  const Real h = row["S_c"] / speed / steps;
  auto run = meeting(row, speed, h);
  const Real energy = reduced(run) / 2 * speed * speed;
  bool met = false;
  for (int k = 0; k < 40 * steps && !(met && !run.closed); ++k) run.step(), met = met || run.closed;
  REQUIRE(met);
  const Vec3 velocity =
      run.i.velocity - run.j.velocity - (h / 2) * (run.rates_i.acceleration - run.rates_j.acceleration);
  const Real left = (run.closed ? run.law.energy_of(run.pair(), run.outcome.history).sum : 0) +
                    reduced(run) / 2 * dot(velocity, velocity);
  const Real parting = run.closed ? 0 : velocity.x;
  return {parting / speed, (energy - left - run.sums.normal) / energy};
}

}  // namespace

TEST_CASE("wet grains: impacts stick below the speed of the table, and rebound with its restitution above") {
  const ReferenceTable table("contact/liquid_bridge.csv");
  Errors coarse, fine, balance;
  for (const auto& row : table.rows()) {
    if (row.word("R2") == "inf") continue;
    const Grain i = grain_of(row["R1"]), j = grain_of(row["R2"]);
    const Real sticking = std::sqrt(2 * row["W"] * (i.mass + j.mass) / (i.mass * j.mass));
    for (const Real share : {0.5, 0.95, 1.1, 1.5, 3.0}) {
      CAPTURE(row.word("form"), row["volume"], share);
      const Real expected = share > 1 ? std::sqrt(1 - 1 / (share * share)) : 0;
      const Rebound one = rebound_of(row, share * sticking, 1000),
                    other = rebound_of(row, share * sticking, 4000);
      CHECK((other.restitution == 0) == (share < 1));
      coarse.add(one.restitution - expected), fine.add(other.restitution - expected);
      balance.add(other.balance);
    }
  }
  CHECK(measured("bridge/restitution", "", keeps(fine.worst(), {.promise = 1e-3, .measured = 1.6e-5})));
  CHECK(measured("bridge/balance", "", keeps(balance.worst(), {.promise = 1e-3, .measured = 2.8e-4})));
  CHECK(coarse.worst() > 2 * fine.worst());
}

// Of the table: two grains of 1 mm of 2500 kg/m^3.
TEST_CASE("wet grains: sticking speeds of two grains") {
  const ReferenceTable table("contact/liquid_bridge.csv");
  const Grain grain = grain_of(1e-3);
  const PairSize size{1e-3, 1e-3, grain.mass, grain.mass};
  for (const std::size_t k : {0u, 1u})
    CHECK(near(BridgeParameters(liquid_of(table.rows()[k])).sticking_speed(size, grain.mass / 2),
               k == 0 ? 0.062583 : 0.107430, {.absolute = 5e-7}));
}

TEST_CASE("wet grains: the work of a slow separation is that of the closed form") {
  const ReferenceTable table("contact/liquid_bridge.csv");
  Errors errors;
  for (const auto& row : table.rows()) {
    CAPTURE(row.word("form"), row["R2"]);
    const auto pair = BridgeLaw<HertzLaw>(HertzLaw(1e7, 0, false), liquid_of(row))
                          .of_pair({row["R1"], row["R2"], 1, kInfinity});
    const int steps = 20000;
    const Real displacement = row["S_c"] / steps;
    Real work = 0;
    for (int k = 0; k < steps; ++k) work -= pair.elastic(-(k + 0.5) * displacement) * displacement;
    errors.add(work / row["W"] - 1);
  }
  CHECK(measured("bridge/work", "", keeps(errors.worst(), {.promise = 1e-6, .measured = 2.3e-7})));
}

}  // namespace scree
