// A sphere on a plane: from sliding to rolling, and down an incline.
#include "verification/contact/on_plane.hpp"

#include <algorithm>
#include <numbers>

#include "physics/normal_laws.hpp"
#include "physics/tangential_laws.hpp"
#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/reference_table.hpp"
#include "verification/contact/errors.hpp"

namespace scree {

namespace {

using Slider = ContactLaw<LinearLaw, LinearSlider>;

Slider slider(Real stiffness, Real friction, Real damping_ratio) {
  return {LinearLaw(kRestStiffness, 0, false), {stiffness, friction, damping_ratio}};
}

// Period of slip with m_t = 2/7 m, the reference of step lengths.
Real slip_period(Real mass, Real stiffness) { return swing_period(2 * mass / 7, stiffness); }

struct RollingErrors {
  Errors speed, place, loss;  // relative to v0, to x_roll, and to the slider's loss
};

// After the slip a sphere oscillates about v = 5/7 v0: five periods of it.
void add_slide_to_roll(const ReferenceTable::Row& row, Real parts, RollingErrors& errors) {
  const Real v0 = row["v0"], t_roll = row["t_roll"], period = row["period"];
  const auto steps = std::ceil(t_roll / period * parts);
  const Grain grain{.velocity = {v0, 0, 0}, .radius = row["R"], .mass = row["m"]};
  auto run = resting_run(slider(row["kt"], row["mu"], 0), grain, inclined_gravity(0), t_roll / steps);
  for (int k = 0; k < steps; ++k) run.step();
  errors.place.add(run.grain.position.x / row["x_roll"] - 1);
  for (int k = 0; k * run.h < 5 * period; ++k, run.step()) {
    const Real swing = row["v_ampl"] * std::sin(2 * std::numbers::pi_v<Real> * k * run.h / period);
    errors.speed.add((run.velocity().x - (row["v_roll"] - swing)) / v0);
    errors.speed.add(row["R"] * (run.spin().y - (row["w_roll"] + 2.5 * swing / row["R"])) / v0);
  }
  errors.loss.add(run.sums.friction.sliding / row["slip_loss"] - 1);
}

}  // namespace

TEST_CASE("a sliding sphere rolls in the end, at five sevenths of its speed") {
  const ReferenceTable table("contact/slide_to_roll.csv");
  RollingErrors coarse, fine;
  for (const auto& row : table.rows()) {
    add_slide_to_roll(row, 50, coarse);
    add_slide_to_roll(row, 100, fine);
  }
  CHECK(keeps(coarse.speed.worst(), {.promise = 1e-2, .measured = 1.4e-3}));
  CHECK(keeps(fine.speed.worst(), {.promise = 1e-3, .measured = 1.2e-4}));
  CHECK(keeps(fine.place.worst(), {.promise = 1e-3, .measured = 5.3e-5}));
  CHECK(keeps(fine.loss.worst(), {.promise = 1e-4, .measured = 3.4e-6}));
  CHECK(order_between(coarse.speed, fine.speed) > 1.8);
}

TEST_CASE("a sliding sphere with a dashpot beside the spring, which is off while it slides") {
  const ReferenceTable table("contact/slide_to_roll_damped.csv");
  constexpr Real m = 0.1, R = 0.02, mu = 0.3, kt = 1e5, v0 = 1;
  const auto errors_at = [&](Real parts) {
    Errors errors;
    for (const auto& rows : {std::pair<std::size_t, std::size_t>{0, 40}, {40, table.rows().size()}}) {
      auto run = resting_run(slider(kt, mu, 0.2), {.velocity = {v0, 0, 0}, .radius = R, .mass = m},
                             inclined_gravity(0), slip_period(m, kt) / parts);
      visit_rows(run, table, rows, [&](const OnPlane& at, const auto& row) {
        errors.add((at.x - row["x"]) / 0.1);
        errors.add((at.v - row["v"]) / v0);
        errors.add(R * (at.w - row["w"]) / v0);
        errors.add((at.spring - row["T"]) / 0.2943);
        errors.add((at.force - row["F"]) / 0.2943);
      });
    }
    return errors;
  };
  const Errors coarse = errors_at(200), fine = errors_at(400);
  CHECK(keeps(coarse.worst(), {.promise = 5e-2, .measured = 1.5e-2}));
  CHECK(keeps(fine.worst(), {.promise = 2.5e-2, .measured = 7.2e-3}));
  CHECK(order_between(coarse, fine) > 0.9);
}

TEST_CASE("a sphere on an incline rolls up to tan = 7/2 mu and slides beyond") {
  const ReferenceTable table("contact/incline.csv");
  const auto errors_at = [&](Real parts) {
    Errors errors;
    for (std::size_t first = 0; first < table.rows().size(); first += 4) {
      const auto& head = table.rows()[first];
      const Real m = head["m"], R = head["R"], kt = head["kt"];
      const Vec3 gravity = inclined_gravity(head["deg"] * std::numbers::pi_v<Real> / 180);
      auto run = resting_run(slider(kt, head["mu"], 0.3), {.radius = R, .mass = m}, gravity,
                             slip_period(m, kt) / parts);
      visit_rows(run, table, {first, first + 4}, [&](const OnPlane& at, const auto& row) {
        errors.add((at.x - row["x"]) / row["x"]);
        errors.add((at.v - row["v"]) / row["v"]);
        errors.add((at.w - row["w"]) / row["w"]);
        errors.add((at.spring - row["T"]) / row["T"]);
      });
    }
    return errors;
  };
  const Errors coarse = errors_at(200), fine = errors_at(400);
  CHECK(keeps(coarse.worst(), {.promise = 2e-2, .measured = 4.8e-3}));
  CHECK(keeps(fine.worst(), {.promise = 1e-2, .measured = 2.4e-3}));
  CHECK(order_between(coarse, fine) > 0.9);
}

}  // namespace scree
