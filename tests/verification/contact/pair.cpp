// Oblique impact of two free spinning spheres of unequal sizes.
#include "physics/normal_laws.hpp"
#include "physics/rolling_laws.hpp"
#include "physics/tangential_laws.hpp"
#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "verification/contact/errors.hpp"
#include "verification/contact/pair_impacts.hpp"

namespace scree {

namespace {

constexpr Real kPhases[] = {0, 0.2, 0.4, 0.6, 0.8};
constexpr int kManyPhases = 20;     // phases of which a mean is taken
constexpr Real kConserved = 1e-13;  // of sums over hundreds of steps, relative

template <class Run>
Vec3 momentum(const Run& run) {
  return run.i.mass * run.i.velocity + run.j.mass * run.j.velocity;
}

template <class Run>
Vec3 total_angular_momentum(const Run& run) {
  const auto of = [](const Grain& g) {
    return angular_momentum(g.mass, g.position, g.velocity, g.inertia, g.spin);
  };
  return of(run.i) + of(run.j);
}

struct PairErrors {
  Errors motion;  // relative to the surfaces' speed of approach, some 1 m/s
  Errors loss;    // accounted dissipation against the motion's, over the kinetic energy
};

template <class Impact>
void add_impact(const Impact& impact, Real parts, Real phase, PairErrors& errors) {
  auto run = pair_run(impact, parts, phase);
  const Vec3 before = momentum(run), angular_before = total_angular_momentum(run);
  const Real energy = run.i.energy() + run.j.energy();
  REQUIRE(run_impact(run, static_cast<int>(100 * parts)));
  errors.motion.add(difference(run.i, impact.i_after));
  errors.motion.add(difference(run.j, impact.j_after));
  const Real lost = run.sums.normal + run.sums.friction.sum();
  errors.loss.add((energy - run.i.energy() - run.j.energy() - lost) / energy);
  CHECK(near(momentum(run), before, {.absolute = kConserved}));
  CHECK(near(total_angular_momentum(run), angular_before, {.absolute = kConserved}));
}

template <class Impact, class Which>
PairErrors pair_errors(Real parts, const Which& which) {
  const ReferenceTable table("contact/pair_oblique_3d.csv");
  PairErrors errors;
  for (const auto& row : table.rows())
    if (row.word("arms") == "rolling" && which(row))
      for (const Real phase : kPhases) add_impact(Impact(row), parts, phase, errors);
  return errors;
}

}  // namespace

TEST_CASE("two spheres in space with a linear spring and slider") {
  const auto at = [](Real parts, bool damped, bool planar) {
    return pair_errors<LinearPairImpact>(parts, [&](const auto& row) {
      return row.word("law") == "linear" && (row["e"] < 1) == damped && (row["nx"] == 1) == planar;
    });
  };
  SECTION("without damping, in a plane: of second order") {
    const PairErrors coarse = at(100, false, true), fine = at(200, false, true);
    CHECK(keeps(coarse.motion.worst(), {.promise = 1e-3, .measured = 6.2e-5}));
    CHECK(keeps(fine.motion.worst(), {.promise = 3e-4, .measured = 2.1e-5}));
    CHECK(keeps(fine.loss.worst(), {.promise = 3e-4, .measured = 1.1e-5}));
    CHECK(order_between(coarse.motion, fine.motion) > 1.6);  // 2, but for where in a step sliding begins
    CHECK(order_between(coarse.loss, fine.loss) > 1.8);
  }
  // The return to the limit is along the force at the end of the step.
  SECTION("without damping, sliding in changing directions: of first order") {
    const PairErrors coarse = at(100, false, false), fine = at(200, false, false);
    CHECK(keeps(coarse.motion.worst(), {.promise = 1e-3, .measured = 2.7e-4}));
    CHECK(keeps(fine.motion.worst(), {.promise = 5e-4, .measured = 1.3e-4}));
    CHECK(keeps(fine.loss.worst(), {.promise = 3e-4, .measured = 8.7e-6}));
    CHECK(order_between(coarse.motion, fine.motion) > 0.9);
  }
  SECTION("with a normal dashpot, whose force jumps at touch: of first order") {
    for (const bool planar : {true, false}) {
      const PairErrors coarse = at(100, true, planar), fine = at(200, true, planar);
      CHECK(keeps(coarse.motion.worst(), {.promise = 1e-2, .measured = 1.9e-3}));
      CHECK(keeps(fine.motion.worst(), {.promise = 5e-3, .measured = 1.1e-3}));
      CHECK(keeps(fine.loss.worst(), {.promise = 1e-3, .measured = 1.4e-4}));
      CHECK(order_between(coarse.motion, fine.motion) > 0.9);
    }
  }
}

// Laws count the dissipation of dampers for velocities of mid-step, which the program uses.
TEST_CASE("steps with mid-step velocities account for the dissipation to second order") {
  const ReferenceTable table("contact/pair_oblique_3d.csv");
  const auto at = [&]<class Impact>(Real parts, const std::string& law, bool tension) {
    Errors errors;
    for (const auto& row : table.rows()) {
      if (row.word("law") != law || row["e"] == 1) continue;
      Impact impact(row);
      impact.law.normal.tension = tension;
      Real mean = 0;  // over the phases
      for (int k = 0; k < kManyPhases; ++k) {
        auto run = pair_run(impact, parts, Real(k) / kManyPhases);
        run.predicts = false;
        const Real energy = run.i.energy() + run.j.energy();
        REQUIRE(run_impact(run, static_cast<int>(100 * parts)));
        const Real lost = run.sums.normal + run.sums.friction.sum();
        mean += (energy - run.i.energy() - run.j.energy() - lost) / energy / kManyPhases;
      }
      errors.add(mean);
    }
    return errors;
  };
  for (const bool tension : {false, true}) {
    CAPTURE(tension);
    for (const std::string law : {"linear", "mindlin"}) {
      CAPTURE(law);
      const auto errors = [&](Real parts) {
        return law == "linear" ? at.operator()<LinearPairImpact>(parts, law, tension)
                               : at.operator()<MindlinPairImpact>(parts, law, tension);
      };
      const Errors coarse = errors(40), fine = errors(160);
      CAPTURE(coarse.worst(), fine.worst());
      CHECK(keeps(coarse.worst(), {.promise = 1e-3, .measured = 3.2e-4}));
      CHECK(keeps(fine.worst(), {.promise = 1e-4, .measured = 1.9e-5}));
      CHECK(order_between(coarse, fine) / 2 > 1.7);
    }
  }
}

namespace {

// All laws together.
using Whole =
    ContactLaw<HertzLaw, MindlinSlider, RollingAndTwisting<ElasticPlasticRolling, MarshallTwisting>>;

struct WholeImpact : MindlinPairImpact {
  Whole law;

  explicit WholeImpact(const ReferenceTable::Row& row) : MindlinPairImpact(row) {
    const auto& known = MindlinPairImpact::law;
    law = {known.normal, known.tangential, {{0.3, 0.2, 2.25, 0}, {0.4}}};
    law.tangential.damping_ratio = 0.1;
  }
};

// The pair as seen from its other partner, with that one's history.
struct OtherSide {
  ContactHistory history;

  // Evaluated from the run's state before its step.
  ContactOutcome step(const PairRun<Whole>& run) const {
    PairRun<Whole> other{.law = run.law, .i = run.j, .j = run.i, .h = run.h};
    other.rates_i = run.rates_j, other.rates_j = run.rates_i;
    other.outcome.history = history;
    other.step();
    return other.outcome;
  }
};

}  // namespace

TEST_CASE("both sides of a pair keep mirrored springs to the last bit, and its energy balance closes") {
  const ReferenceTable table("contact/pair_oblique_3d.csv");
  const auto balance_at = [&](Real parts) {
    Errors balance;
    for (const auto& row : table.rows()) {
      if (row.word("law") != "mindlin") continue;
      auto run = pair_run(WholeImpact(row), parts, 0.5);
      const Vec3 turning = total_angular_momentum(run);
      const Real energy = run.i.energy() + run.j.energy();
      OtherSide other;
      do {
        const ContactOutcome seen = other.step(run);
        other.history = seen.history;
        run.step();
        REQUIRE(seen.load.force == -run.outcome.load.force);
        REQUIRE(seen.load.torque_i == run.outcome.load.torque_j);
        REQUIRE(seen.history.spring == -run.outcome.history.spring);
        REQUIRE(seen.history.moment == -run.outcome.history.moment);
      } while (run.closed);
      CHECK(near(total_angular_momentum(run), turning, {.absolute = kConserved}));
      const Real lost = run.sums.normal + run.sums.friction.sum() + run.sums.rolling.sum();
      CHECK(run.sums.rolling.sum() > 0);
      balance.add((energy - run.i.energy() - run.j.energy() - lost) / energy);
    }
    return balance;
  };
  const Errors coarse = balance_at(100), fine = balance_at(200);
  CHECK(keeps(coarse.worst(), {.promise = 2e-3, .measured = 5.5e-4}));
  CHECK(keeps(fine.worst(), {.promise = 1e-3, .measured = 2.6e-4}));
  CHECK(order_between(coarse, fine) > 0.9);
}

TEST_CASE("two spheres in space after Hertz and Mindlin") {
  const auto at = [](Real parts) {
    return pair_errors<MindlinPairImpact>(parts,
                                          [](const auto& row) { return row.word("law") == "mindlin"; });
  };
  const PairErrors coarse = at(100), fine = at(200);
  CHECK(keeps(coarse.motion.worst(), {.promise = 2e-3, .measured = 5.0e-4}));
  CHECK(keeps(fine.motion.worst(), {.promise = 1e-3, .measured = 2.3e-4}));
  CHECK(keeps(fine.loss.worst(), {.promise = 1e-3, .measured = 2.9e-4}));
  CHECK(order_between(coarse.motion, fine.motion) > 0.9);
}

}  // namespace scree
