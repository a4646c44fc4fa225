// Oblique impact of two free spinning spheres of unequal sizes, through decks.
#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/restitution.hpp"
#include "verification/contact/errors.hpp"
#include "verification/contact/pair_impacts.hpp"
#include "verification/friction/particle_decks.hpp"

namespace scree {

namespace {

constexpr Real kPhases[] = {0, 0.2, 0.4, 0.6, 0.8};
// Round-off of sums over hundreds of steps, relative to momenta of some 1 kg m/s and their moments at arms
// of 1 cm.
constexpr Real kConserved = 1e-13;
// For implicit steps, whose residuals are 1e-8 of the forces.
constexpr Real kSolved = 1e-8;

struct PairErrors {
  Errors motion;  // relative to the surfaces' speed of approach, some 1 m/s
  Errors loss;    // accounted dissipation against the table's, over the kinetic energy
  // Changes of the momentum, some 1 kg m/s, and of the angular momentum, some 1e-2 kg m^2/s.
  Errors momentum, angular;
};

GrainDeck deck_of(const LinearPairImpact& impact, Real h) {
  return {.law = fmt::format("stiffness = {}\ndamping = {}\nfriction = {}\ntangential_stiffness = {}\n",
                             impact.law.normal.normal_stiffness, impact.law.normal.normal_damping,
                             impact.law.tangential.friction, impact.law.tangential.stiffness),
          .grains = {},
          .step = h,
          .end = 4 * impact.time};
}

// The moduli of both from E* = 3/4 of the law's and G*: with one Poisson's ratio
// G*/E* = (1 - nu) / (2 (2 - nu)).
GrainDeck deck_of(const MindlinPairImpact& impact, Real h) {
  const Real modulus = Real(0.75) * impact.law.normal.modulus, shear = impact.law.tangential.shear_modulus;
  const Real twice = 2 * shear / modulus, poisson = (1 - 2 * twice) / (1 - twice);
  const Real restitution = restitution_of(impact.law.normal.damping_factor / std::sqrt(Real(5)), false);
  return {
      .law = fmt::format("restitution = {}\nfriction = {}\n", restitution, impact.law.tangential.friction),
      .grains = {},
      .step = h,
      .end = 4 * impact.time,
      .materials = hertz_materials(2 * modulus * (1 - poisson * poisson), poisson)};
}

Real difference(const Particle& p, const Grain& expected) {
  return std::max(norm(p.velocity - expected.velocity),
                  expected.radius * norm(p.angular_velocity - expected.spin));
}

template <class Impact>
void add_impact(const Impact& impact, Real parts, Real phase, PairErrors& errors,
                const std::vector<std::string>& settings) {
  const Real h = impact.time / parts;
  GrainDeck deck = deck_of(impact, h);
  deck.plane = false, deck.settings = settings;
  deck.grains = {impact.i, impact.j};
  deck.grains[0].position = (impact.i.radius + impact.j.radius) * impact.normal;
  for (Grain& grain : deck.grains) grain.position -= phase * h * grain.velocity;
  SimulationRun run(deck.model());
  const ParticleLedger before = run.particle_ledger();
  run.run();
  const ParticleLedger after = run.particle_ledger();
  REQUIRE(after.contacts == 0);
  const std::vector<Particle> particles = run.particles();
  errors.motion.add(difference(particles[0], impact.i_after));
  errors.motion.add(difference(particles[1], impact.j_after));
  errors.loss.add((after.contact_loss - impact.loss) / before.kinetic);
  errors.momentum.add(norm(after.momentum - before.momentum));
  errors.angular.add(norm(after.angular_momentum - before.angular_momentum));
}

template <class Impact, class Which>
PairErrors pair_errors(Real parts, const Which& which, const std::vector<std::string>& settings = {}) {
  const ReferenceTable table("contact/pair_oblique_3d.csv");
  PairErrors errors;
  for (const auto& row : table.rows())
    if (row.word("arms") == "rolling" && which(row))
      for (const Real phase : kPhases) add_impact(Impact(row), parts, phase, errors, settings);
  if (settings.empty()) {
    CHECK(errors.momentum.worst() < kConserved);
    CHECK(errors.angular.worst() < 1e-2 * kConserved);
  } else {
    CHECK(errors.momentum.worst() < kSolved);
  }
  return errors;
}

}  // namespace

TEST_CASE("two free spheres with a linear spring and slider") {
  const auto at = [](Real parts, bool damped) {
    return pair_errors<LinearPairImpact>(
        parts, [&](const auto& row) { return row.word("law") == "linear" && (row["e"] < 1) == damped; });
  };
  // The return to the limit is along the force at the end of the step.
  SECTION("without damping, sliding in changing directions: of first order") {
    const PairErrors coarse = at(100, false), fine = at(200, false);
    CHECK(keeps(coarse.motion.worst(), {.promise = 1e-3, .measured = 2.7e-4}));
    CHECK(keeps(fine.motion.worst(), {.promise = 5e-4, .measured = 1.3e-4}));
    CHECK(keeps(fine.loss.worst(), {.promise = 3e-4, .measured = 1.1e-5}));
    CHECK(order_between(coarse.motion, fine.motion) > 0.9);
  }
  SECTION("with a normal dashpot, whose force jumps at touch and lags half a step: of first order") {
    const PairErrors coarse = at(100, true), fine = at(200, true);
    CHECK(keeps(coarse.motion.worst(), {.promise = 1e-2, .measured = 1.9e-3}));
    CHECK(keeps(fine.motion.worst(), {.promise = 5e-3, .measured = 1.0e-3}));
    CHECK(keeps(fine.loss.worst(), {.promise = 1e-2, .measured = 5.1e-4}));
    CHECK(order_between(coarse.motion, fine.motion) > 0.9);
  }
}

// Sliding in changing directions is of first order, as in explicit steps.
TEST_CASE("two free spheres in implicit steps, which keep angular momentum to second order") {
  for (const Real alpha : {0.0, -0.05}) {
    CAPTURE(alpha);
    const auto steps = implicit_steps(alpha);
    const auto linear = [&](Real parts, bool damped) {
      return pair_errors<LinearPairImpact>(
          parts, [&](const auto& row) { return row.word("law") == "linear" && (row["e"] < 1) == damped; },
          steps);
    };
    for (const bool damped : {false, true}) {
      CAPTURE(damped);
      const PairErrors coarse = linear(50, damped), fine = linear(100, damped);
      CHECK(keeps(coarse.motion.worst(), {.promise = 2e-3, .measured = damped ? 1.0e-3 : 5.6e-4}));
      CHECK(keeps(fine.motion.worst(), {.promise = 1e-3, .measured = 2.3e-4}));
      CHECK(keeps(fine.loss.worst(), {.promise = 1e-3, .measured = damped ? 3.9e-5 : 4.6e-6}));
      CHECK(keeps(fine.angular.worst(), {.promise = 1e-7, .measured = damped ? 1.3e-8 : 2e-9}));
      CHECK(order_between(coarse.motion, fine.motion) > 0.9);
      CHECK(order_between(coarse.angular, fine.angular) > 1.9);
    }
    const auto mindlin = [&](Real parts) {
      return pair_errors<MindlinPairImpact>(
          parts, [](const auto& row) { return row.word("law") == "mindlin"; }, steps);
    };
    const PairErrors coarse = mindlin(50), fine = mindlin(100);
    CHECK(keeps(coarse.motion.worst(), {.promise = 5e-3, .measured = 1.3e-3}));
    CHECK(keeps(fine.motion.worst(), {.promise = 2e-3, .measured = 5.7e-4}));
    CHECK(keeps(fine.loss.worst(), {.promise = 1e-3, .measured = 5.3e-5}));
    CHECK(order_between(coarse.motion, fine.motion) > 0.9);
  }
}

TEST_CASE("two free spheres after Hertz and Mindlin") {
  const auto at = [](Real parts) {
    return pair_errors<MindlinPairImpact>(parts,
                                          [](const auto& row) { return row.word("law") == "mindlin"; });
  };
  const PairErrors coarse = at(100), fine = at(200);
  CHECK(keeps(coarse.motion.worst(), {.promise = 2e-3, .measured = 1.8e-3}));
  CHECK(keeps(fine.motion.worst(), {.promise = 1e-3, .measured = 8.7e-4}));
  CHECK(keeps(fine.loss.worst(), {.promise = 1e-2, .measured = 4.6e-4}));
  CHECK(order_between(coarse.motion, fine.motion) > 0.9);
}

TEST_CASE("Chung and Ooi, test 7: spins that roll on each other stay, and nothing goes sideways") {
  const ReferenceTable table("contact/chung_ooi_7.csv");
  for (const auto& row : table.rows()) {
    const Real R = row["R1"], mass = sphere_mass(R, 2700);
    GrainDeck deck{.law = "restitution = 0.5\nfriction = 0.4\ntangential_damping_ratio = 0.2\n",
                   .grains = {{.position = {R, 0, 0},
                               .velocity = {-row["V"], 0, 0},
                               .spin = {0, 0, row["w1"]},
                               .radius = R,
                               .mass = mass},
                              {.position = {-R, 0, 0},
                               .velocity = {row["V"], 0, 0},
                               .spin = {0, 0, row["w2"]},
                               .radius = R,
                               .mass = mass}},
                   .step = 5e-6,
                   .end = 5e-3,
                   .materials = hertz_materials(7e10, 0.33),
                   .plane = false};
    SimulationRun run(deck.model());
    run.run();
    REQUIRE(run.particle_ledger().contacts == 0);
    const std::vector<Particle> p = run.particles();
    CHECK(p[0].velocity.x > 0.4 * row["V"]);
    CHECK((p[0].velocity.y == row["vt_after"] && p[1].velocity.y == row["vt_after"]));
    CHECK((p[0].angular_velocity == Vec3{0, 0, row["w1_after"]}));
    CHECK((p[1].angular_velocity == Vec3{0, 0, row["w2_after"]}));
  }
}

}  // namespace scree
