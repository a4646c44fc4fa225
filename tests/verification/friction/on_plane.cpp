// A sphere on a wall, through decks: from sliding to rolling, and down an incline.
#include <algorithm>
#include <numbers>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/reference_table.hpp"
#include "verification/contact/errors.hpp"
#include "verification/friction/plane_run.hpp"

namespace scree {

namespace {

// Period of slip with m_t = 2/7 m, the reference of step lengths.
Real slip_period(Real mass, Real stiffness) { return swing_period(2 * mass / 7, stiffness); }

// The longest step that divides a time without remainder, so that tables' times are ends of steps [s].
Real step_in(Real time, Real longest) { return time / std::ceil(time / longest); }

struct RollingErrors {
  Errors speed, position, loss;  // relative to v0, to x_roll, and to the slider's loss
};

// After the slip a sphere oscillates about v = 5/7 v0: five periods of it.
void add_slide_to_roll(const ReferenceTable::Row& row, Real parts, RollingErrors& errors,
                       const std::vector<std::string>& settings = {}) {
  const Real v0 = row["v0"], t_roll = row["t_roll"], period = row["period"];
  const Real h = t_roll / std::ceil(t_roll / period * parts);
  const Grain grain{.velocity = {v0, 0, 0}, .radius = row["R"], .mass = row["m"]};
  SimulationRun run(
      resting_model(grain, row["mu"], row["kt"], 0, inclined_gravity(0), h, t_roll + 6 * period, settings));
  errors.position.add(PlaneState(run, t_roll, h).x / row["x_roll"] - 1);
  for (int k = 0; k <= 50; ++k) {
    const Real t = t_roll + k * period / 10;
    const PlaneState at(run, t, h);
    const Real swing = row["v_ampl"] * std::sin(2 * std::numbers::pi_v<Real> * (t - t_roll) / period);
    errors.speed.add((at.v - (row["v_roll"] - swing)) / v0);
    errors.speed.add(row["R"] * (at.w - (row["w_roll"] + 2.5 * swing / row["R"])) / v0);
  }
  errors.loss.add(run.particle_ledger().contact_loss / row["slip_loss"] - 1);
}

// Errors of positions, speeds, spins and springs down inclines, each relative to its own value.
Errors incline_errors(Real parts, const std::vector<std::string>& settings = {}) {
  const ReferenceTable table("contact/incline.csv");
  Errors errors;
  for (std::size_t first = 0; first < table.rows().size(); first += 4) {
    const auto& head = table.rows()[first];
    const Real m = head["m"], R = head["R"], kt = head["kt"];
    const Vec3 gravity = inclined_gravity(head["deg"] * std::numbers::pi_v<Real> / 180);
    const Real h = step_in(1e-3, slip_period(m, kt) / parts);
    SimulationRun run(
        resting_model({.radius = R, .mass = m}, head["mu"], kt, 0.3, gravity, h, 0.11, settings));
    for (std::size_t k = first; k < first + 4; ++k) {
      const auto& row = table.rows()[k];
      const PlaneState at(run, row["t"], h);
      errors.add((at.x - row["x"]) / row["x"]);
      errors.add((at.v - row["v"]) / row["v"]);
      errors.add((at.w - row["w"]) / row["w"]);
      errors.add((at.spring - row["T"]) / row["T"]);
    }
  }
  return errors;
}

}  // namespace

TEST_CASE("a sphere that slides on a wall rolls in the end, at five sevenths of its speed") {
  const ReferenceTable table("contact/slide_to_roll.csv");
  RollingErrors coarse, fine;
  for (const auto& row : table.rows()) {
    add_slide_to_roll(row, 50, coarse);
    add_slide_to_roll(row, 100, fine);
  }
  CHECK(keeps(coarse.speed.worst(), {.promise = 1e-2, .measured = 1.4e-3}));
  CHECK(keeps(fine.speed.worst(), {.promise = 1e-3, .measured = 1.2e-4}));
  CHECK(keeps(fine.position.worst(), {.promise = 1e-3, .measured = 5.3e-5}));
  CHECK(keeps(fine.loss.worst(), {.promise = 1e-4, .measured = 3.4e-6}));
  CHECK(order_between(coarse.speed, fine.speed) > 1.8);
}

TEST_CASE("a sphere that slides on a wall with a dashpot, which is off while it slides") {
  const ReferenceTable table("contact/slide_to_roll_damped.csv");
  constexpr Real m = 0.1, R = 0.02, mu = 0.3, kt = 1e5, v0 = 1, kLimit = 0.2943;
  const auto errors_at = [&](Real parts) {
    Errors errors;
    for (const auto& [first, last] :
         {std::pair<std::size_t, std::size_t>{0, 40}, {40, table.rows().size()}}) {
      const Real h = step_in(1e-3, slip_period(m, kt) / parts);
      SimulationRun run(resting_model({.velocity = {v0, 0, 0}, .radius = R, .mass = m}, mu, kt, 0.2,
                                      inclined_gravity(0), h, 0.3));
      for (std::size_t k = first; k < last; ++k) {
        const auto& row = table.rows()[k];
        const PlaneState at(run, row["t"], h);
        errors.add((at.x - row["x"]) / 0.1);
        errors.add((at.v - row["v"]) / v0);
        errors.add(R * (at.w - row["w"]) / v0);
        errors.add((at.spring - row["T"]) / kLimit);
        errors.add((-at.force - row["F"]) / kLimit);
      }
    }
    return errors;
  };
  const Errors coarse = errors_at(200), fine = errors_at(400);
  CHECK(keeps(coarse.worst(), {.promise = 5e-2, .measured = 1.4e-2}));
  CHECK(keeps(fine.worst(), {.promise = 2.5e-2, .measured = 6.9e-3}));
  CHECK(order_between(coarse, fine) > 0.7);  // 1, but for where in a step the slip ends
}

TEST_CASE("a sphere on an inclined wall rolls up to tan = 7/2 mu and slides beyond") {
  const auto errors_at = [](Real parts) { return incline_errors(parts); };
  const Errors coarse = errors_at(200), fine = errors_at(400);
  CHECK(keeps(coarse.worst(), {.promise = 2e-2, .measured = 4.8e-3}));
  CHECK(keeps(fine.worst(), {.promise = 1e-2, .measured = 2.4e-3}));
  CHECK(order_between(coarse, fine) > 0.9);
}

TEST_CASE("sliding, rolling and inclines in implicit steps") {
  const ReferenceTable table("contact/slide_to_roll.csv");
  for (const Real alpha : {0.0, -0.3}) {
    CAPTURE(alpha);
    RollingErrors coarse, fine;
    for (const auto& row : table.rows()) {
      add_slide_to_roll(row, 25, coarse, implicit_steps(alpha));
      add_slide_to_roll(row, 50, fine, implicit_steps(alpha));
    }
    CHECK(keeps(coarse.speed.worst(), {.promise = 2e-2, .measured = 8e-3}));
    CHECK(keeps(fine.speed.worst(), {.promise = 5e-3, .measured = 1.5e-3}));
    CHECK(keeps(fine.position.worst(), {.promise = 2e-3, .measured = 7.1e-4}));
    CHECK(keeps(fine.loss.worst(), {.promise = 2e-3, .measured = 8.8e-4}));
    CHECK(order_between(coarse.speed, fine.speed) > 1.9);
    const Errors coarse_incline = incline_errors(100, implicit_steps(alpha)),
                 fine_incline = incline_errors(200, implicit_steps(alpha));
    CHECK(keeps(coarse_incline.worst(), {.promise = 2e-3, .measured = 4.4e-4}));
    CHECK(keeps(fine_incline.worst(), {.promise = 5e-4, .measured = 1.0e-4}));
    CHECK(order_between(coarse_incline, fine_incline) > 1.8);
  }
}

// I = m R^2 / 2. Sliding and rolling both keep the angular momentum about the line of contact: v + R w / 2 =
// v0, so that the disc rolls at 2/3 v0 after v0 / (3 mu g), and a third of its energy is lost.
TEST_CASE("a disc that slides on a wall rolls in the end, at two thirds of its speed") {
  constexpr Real v0 = 2, R = 0.1, m = 1, mu = 0.25, g = 9.81;
  Model model = model_of(fmt::format(R"(
gravity = [0.0, -{g}]
[space]
dimension = 2
min = [-1.0, 0.0]
max = [3.0, 1.0]
y_min = "wall"
[time]
end = 1.0
step = 2e-5
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = 1e5
friction = {mu}
tangential_stiffness = 1e5
tangential_damping_ratio = 0.3
[[particles]]
name = "disc"
kind = "list"
positions = [[0.0, {y}]]
velocity = [{v0}, 0.0]
radius = {R}
mass = {m}
)",
                                     fmt::arg("g", g), fmt::arg("mu", mu), fmt::arg("y", R - m * g / 1e5),
                                     fmt::arg("v0", v0), fmt::arg("R", R), fmt::arg("m", m)));
  SimulationRun run(model);
  const Real t_roll = v0 / (3 * mu * g);
  constexpr Real kConserved = 1e-11;  // over 50000 steps, relative to v0
  run.run_until(t_roll / 2);
  Particle p = run.particles().at(0);
  CHECK(near(p.velocity.x, v0 - mu * g * run.time(), {.absolute = 1e-4}));  // the spring loads first
  CHECK(near(p.velocity.x - R * p.angular_velocity.z / 2, v0, {.absolute = kConserved}));
  run.run();
  p = run.particles().at(0);
  CHECK(keeps(p.velocity.x / (2 * v0 / 3) - 1, {.promise = 1e-10, .measured = 2e-12}));
  CHECK(keeps(-R * p.angular_velocity.z / p.velocity.x - 1, {.promise = 1e-10, .measured = 2e-12}));
  CHECK(near(p.velocity.x - R * p.angular_velocity.z / 2, v0, {.absolute = kConserved}));
  CHECK(keeps(run.particle_ledger().contact_loss / (m * v0 * v0 / 6) - 1,
              {.promise = 1e-3, .measured = 7.4e-5}));
  CHECK(p.angular_velocity.x == 0);
  CHECK(p.angular_velocity.y == 0);
}

}  // namespace scree
