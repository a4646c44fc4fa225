// Rolling and twisting resistance of a sphere on a wall, through decks.
#include <algorithm>
#include <numbers>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/reference_table.hpp"
#include "verification/contact/errors.hpp"
#include "verification/friction/oblique_pair.hpp"
#include "verification/friction/plane_run.hpp"

namespace scree {

namespace {

constexpr Real kMass = 0.1, kRadius = 0.02, kGravity = 9.81;
constexpr Real kSpeed = 0.3, kRollingFriction = 0.1;  // of epsd_a and epsd_b
constexpr Real kLargestMoment = kRollingFriction * kRadius * kMass * kGravity;

// A sphere that rolls on the wall z = 0 with its static overlap. more: keys of the pair beside a stiffness.
Model rolling_model(Vec3 velocity, const std::string& more, Vec3 gravity, Real step, Real end,
                    const std::vector<std::string>& settings = {}) {
  Grain grain{.velocity = velocity, .spin = {0, velocity.x / kRadius, 0}, .radius = kRadius, .mass = kMass};
  grain.position = {0, 0, kRadius + kMass * gravity.z / kRestStiffness};
  GrainDeck deck{.law = fmt::format("stiffness = {}\n", kRestStiffness) + more,
                 .grains = {grain},
                 .step = step,
                 .end = end};
  deck.gravity = gravity, deck.settings = settings;
  return deck.model();
}

// The moment of the rolling spring about y [N m].
Real held_moment(SimulationRun& run) { return run.complete_state().contacts.values.at(4); }

Errors epsd_errors(const std::string& table_name, Real damping_ratio, Real parts,
                   const std::vector<std::string>& settings = {}) {
  const ReferenceTable table(table_name);
  const Real h = swing_period(2 * kMass / 7, 8e4) / parts;
  Errors errors;
  for (const auto& [first, last] : {std::pair<std::size_t, std::size_t>{0, 60}, {60, table.rows().size()}}) {
    SimulationRun run(rolling_model(
        {kSpeed, 0, 0},
        fmt::format("friction = 0.5\ntangential_stiffness = 8e4\ntangential_damping_ratio = 0.3\n"
                    "rolling_friction = {}\nrolling_damping_ratio = {}\n",
                    kRollingFriction, damping_ratio),
        inclined_gravity(0), h, table.rows()[last - 1]["t"] + h, settings));
    for (std::size_t k = first; k < last; ++k) {
      const auto& row = table.rows()[k];
      const PlaneState at(run, row["t"], h);
      errors.add((at.x - row["x"]) / 0.064);  // displacement until it stops
      errors.add((at.v - row["v"]) / kSpeed);
      errors.add(kRadius * (at.w - row["w"]) / kSpeed);
      errors.add((held_moment(run) - row["Mk"]) / kLargestMoment / 10);  // at the nearest step
    }
  }
  return errors;
}

}  // namespace

TEST_CASE("rolling on a wall stops, then rocks about its spring") {
  SECTION("with a dashpot") {
    const Errors coarse = epsd_errors("contact/epsd_a.csv", 0.3, 50),
                 fine = epsd_errors("contact/epsd_a.csv", 0.3, 100);
    CHECK(keeps(coarse.worst(), {.promise = 1e-2, .measured = 3.6e-4}));
    CHECK(keeps(fine.worst(), {.promise = 5e-3, .measured = 1.9e-4}));
    CHECK(order_between(coarse, fine) > 0.7);
  }
  SECTION("without") {
    const Errors coarse = epsd_errors("contact/epsd_b.csv", 0, 50),
                 fine = epsd_errors("contact/epsd_b.csv", 0, 100);
    CHECK(keeps(coarse.worst(), {.promise = 1e-2, .measured = 4.0e-4}));
    CHECK(keeps(fine.worst(), {.promise = 5e-3, .measured = 2.1e-4}));
    CHECK(order_between(coarse, fine) > 0.7);
  }
}

// First order, as in explicit steps: the slide ends within a step.
TEST_CASE("in implicit steps rolling on a wall stops, then rocks about its spring") {
  SECTION("with a dashpot") {
    const Errors coarse = epsd_errors("contact/epsd_a.csv", 0.3, 50, implicit_steps(0)),
                 fine = epsd_errors("contact/epsd_a.csv", 0.3, 100, implicit_steps(0));
    CHECK(keeps(coarse.worst(), {.promise = 1e-2, .measured = 2.7e-4}));
    CHECK(keeps(fine.worst(), {.promise = 5e-3, .measured = 1.6e-4}));
    CHECK(order_between(coarse, fine) > 0.7);
  }
  SECTION("without") {
    const Errors coarse = epsd_errors("contact/epsd_b.csv", 0, 50, implicit_steps(0)),
                 fine = epsd_errors("contact/epsd_b.csv", 0, 100, implicit_steps(0));
    CHECK(keeps(coarse.worst(), {.promise = 1e-2, .measured = 4.1e-4}));
    CHECK(keeps(fine.worst(), {.promise = 5e-3, .measured = 2.2e-4}));
    CHECK(order_between(coarse, fine) > 0.7);
  }
}

// Rolling without slip, with a constant moment: a = 5/7 mu_r g, the distance v^2 / (2 a), up to the spring's
// elongation M / k_r, of which the ball rolls back.
TEST_CASE("in implicit steps a ball with rolling resistance stops after the distance v^2 / (2 a)") {
  const Real a = 5 * kRollingFriction * kGravity / 7, distance = kSpeed * kSpeed / (2 * a),
             stops = kSpeed / a;
  const auto error_at = [&](Real step) {
    SimulationRun run(rolling_model(
        {kSpeed, 0, 0},
        fmt::format("friction = 0.5\ntangential_stiffness = 8e4\ntangential_damping_ratio = 0.3\n"
                    "rolling_friction = {}\nrolling_stiffness = 100.0\nrolling_damping_ratio = 1.0\n",
                    kRollingFriction),
        inclined_gravity(0), step, 1.5 * stops, implicit_steps(-0.05)));
    run.run();
    CHECK(keeps(run.balance_error() / run.exchanged(), {.promise = 1e-9, .measured = 1e-14}));
    CHECK(near(run.particle_ledger().rotation.losses.of[kRollingLoss], 0.7 * kMass * kSpeed * kSpeed,
               {.relative = 1e-3}));
    return run.particles()[0].position.x / distance - 1;
  };
  CHECK(keeps(error_at(1e-3), {.promise = 1e-3, .measured = 1.7e-5}));
  CHECK(keeps(error_at(1e-4), {.promise = 1e-3, .measured = 1.6e-5}));
}

TEST_CASE("a sphere held on an inclined wall by rolling resistance does not creep, and rolls beyond") {
  const ReferenceTable table("contact/incline_rest.csv");
  for (const auto& row : table.rows()) {
    const std::string law = fmt::format(
        "friction = {}\ntangential_stiffness = {}\ntangential_damping_ratio = 0.5\nrolling_friction = {}\n"
        "rolling_damping_ratio = 1.0\n",
        row["mu"], row["kt"], row["mur"]);
    const Real h = swing_period(2 * kMass / 7, row["kt"]) / 50;
    SimulationRun run(
        rolling_model({}, law, inclined_gravity(row["deg"] * std::numbers::pi_v<Real> / 180), h, 120000 * h));
    run.run_until(20000 * h);
    const Real x = run.particles()[0].position.x;
    CHECK(near(x, row["x"], {.relative = 1e-12}));
    CHECK(near(held_moment(run), row["M"], {.relative = 1e-12}));
    run.run();
    CHECK(near(run.particles()[0].position.x, x, {.absolute = 1e-9 * 2 * kRadius}));
    // tan(20 deg) = 0.364 is more than mu_r = 0.3: a = 5/7 g (sin - mu_r cos).
    const Real angle = 20 * std::numbers::pi_v<Real> / 180, end = 0.2;
    SimulationRun steep(rolling_model({}, law, inclined_gravity(angle), h, end));
    steep.run_until(end / 2 - h / 2);
    const Real first = steep.time(), speed = steep.particles()[0].velocity.x;
    steep.run();
    const Real gained =
        kGravity * 5 / 7 * (std::sin(angle) - row["mur"] * std::cos(angle)) * (steep.time() - first);
    CHECK(near(steep.particles()[0].velocity.x - speed, gained, {.relative = 1e-3}));
  }
}

namespace {

// Displacement over `steps` implicit steps of a sphere at rest on an incline, in diameters, and its error
// against the closed form.
struct Creep {
  Real move, moment, position;

  explicit Creep(int steps) {
    const ReferenceTable table("contact/incline_rest.csv");
    const auto& row = table.rows().at(0);
    const std::string law = fmt::format(
        "friction = {}\ntangential_stiffness = {}\ntangential_damping_ratio = 0.5\nrolling_friction = {}\n"
        "rolling_damping_ratio = 1.0\n",
        row["mu"], row["kt"], row["mur"]);
    const Real h = swing_period(2 * kMass / 7, row["kt"]) / 2;
    SimulationRun run(rolling_model({}, law, inclined_gravity(row["deg"] * std::numbers::pi_v<Real> / 180), h,
                                    (5000 + steps) * h, implicit_steps(-0.05)));
    run.run_until(5000 * h);
    const Real x = run.particles()[0].position.x;
    position = x / row["x"] - 1, moment = held_moment(run) / row["M"] - 1;
    run.run();
    move = (run.particles()[0].position.x - x) / (2 * kRadius);
  }
};

}  // namespace

TEST_CASE("in implicit steps a sphere held on an inclined wall by rolling resistance does not creep") {
  const Creep creep(5000);
  CHECK(keeps(creep.position, {.promise = 1e-9, .measured = 1e-13}));
  CHECK(keeps(creep.moment, {.promise = 1e-9, .measured = 1e-13}));
  CHECK(keeps(creep.move, {.promise = 5e-11, .measured = 1e-15}));  // 1e-9 diameters in 1e5 steps
}

TEST_CASE("in 1e5 implicit steps a sphere held by rolling resistance does not creep", "[.][long]") {
  CHECK(keeps(Creep(100000).move, {.promise = 1e-9, .measured = 1e-15}));
}

TEST_CASE("a moment against the rate of rolling stops a sphere in exp(-C t / (7/5 m R^2))") {
  const Real damping = 2e-4, h = 2e-5, end = 0.2;
  std::vector<std::string> settings;
  SECTION("in explicit steps") {}
  SECTION("in implicit steps") { settings = implicit_steps(-0.05); }
  SimulationRun run(rolling_model({kSpeed, 0, 0},
                                  fmt::format("friction = 0.5\nrolling_damping = {}\n", damping),
                                  inclined_gravity(0), h, end, settings));
  run.run_until(end / 2 - h / 2);
  const Real first = run.time(), speed = run.particles()[0].velocity.x;
  run.run();
  const Real decay = damping / (1.4 * kMass * kRadius * kRadius);
  CHECK(near(run.particles()[0].velocity.x, speed * std::exp(-decay * (run.time() - first)),
             {.relative = 1e-3}));
  CHECK(std::abs(run.balance_error()) < 2e-3 * run.exchanged());
}

TEST_CASE("a sphere that spins about the vertical on a wall slows down evenly, then swings") {
  const ReferenceTable table("contact/twisting.csv");
  std::vector<std::string> settings;
  SECTION("in explicit steps") {}
  SECTION("in implicit steps") { settings = implicit_steps(0); }
  const auto errors_at = [&](Real parts) {
    Errors errors;
    for (const auto& row : table.rows()) {
      const Real R = row["R"], period = row["period"], w0 = row["w0"], t2 = row["t2"];
      const Real h = t2 / std::ceil(t2 / period * parts);
      const std::string materials = hertz_materials(row["E"], row["nu"]);
      GrainDeck deck{
          .law = fmt::format("friction = {0}\ntwisting_friction = {0}\n", row["mu"]),
          .grains = {{.position = {0, 0, R - row["d"]}, .spin = {0, 0, w0}, .radius = R, .mass = row["m"]}},
          .step = h,
          .end = t2 + 3 * period};
      deck.materials = materials, deck.gravity = inclined_gravity(0), deck.settings = settings;
      SimulationRun run(deck.model());
      for (int k = 1; k < 50; ++k) {
        const Real t = row["t1"] + k * (t2 - row["t1"]) / 50;
        run.run_until(t - h / 2);
        const Real even = row["w1"] * (t2 - run.time()) / (t2 - row["t1"]);
        errors.add((run.particles()[0].angular_velocity.z - even) / w0);
      }
      for (int k = 0; k < 30; ++k) {
        run.run_until(t2 + k * period / 10 - h / 2);
        const Real t = run.time() - t2;
        const Real swing = -row["w_ampl"] * std::sin(2 * std::numbers::pi_v<Real> * t / period);
        errors.add((run.particles()[0].angular_velocity.z - swing) / w0);
      }
    }
    return errors;
  };
  const Errors coarse = errors_at(100), fine = errors_at(200);
  CHECK(keeps(coarse.worst(), {.promise = 1e-3, .measured = 3.3e-4}));
  CHECK(keeps(fine.worst(), {.promise = 1e-3, .measured = 1.2e-4}));
}

// Two spheres with spins about all axes.
TEST_CASE("an oblique impact with rolling and twisting resistance is the same in both kinds of small steps") {
  const auto difference_at = [](Real steps) {
    constexpr Real R = 0.05;
    Meeting meeting{3,
                    {.position = {1.601 * R, 1.201 * R, 0},
                     .velocity = {-1.5, 0.4, 0.2},
                     .spin = {10, -15, 20},
                     .radius = R,
                     .mass = 1},
                    {{}, {0.5, 0.1, 0}, 12, R, 1, 0.4 * R * R},
                    kUndamped + "rolling_friction = 0.2\ntwisting_friction = 0.3\n",
                    kContactTime / steps,
                    2 * kContactTime};
    SimulationRun explicit_steps(meeting.with_particle());
    meeting.settings = implicit_steps(0);
    SimulationRun implicit(meeting.with_particle());
    explicit_steps.run(), implicit.run();
    REQUIRE(implicit.particle_ledger().contacts == 0);
    const TangentialLosses losses = implicit.particle_ledger().rotation.losses;
    CHECK((losses.of[kRollingLoss] > 1e-4 && losses.of[kTwistingLoss] > 1e-6));
    Real largest = 0;
    for (std::size_t k = 0; k < 2; ++k)
      largest = std::max(largest, difference(explicit_steps.particles()[k], implicit.particles()[k], R));
    return largest / norm(meeting.grain.velocity);
  };
  const Real coarse = difference_at(100), fine = difference_at(400);
  CHECK(keeps(coarse, {.promise = 1e-3, .measured = 8e-5}));
  CHECK(keeps(fine, {.promise = 1e-4, .measured = 4e-6}));
  CHECK(fine < 0.4 * coarse);
}

}  // namespace scree
