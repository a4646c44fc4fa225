// Spatial mechanisms against solutions of 15 to 17 digits: errors and orders in positions, rotations,
// velocities, angular velocities and joint forces.
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/near.hpp"
#include "support/spatial_run.hpp"

using namespace scree;

namespace {

constexpr Real kRoundOff = 1e-10;  // of the discrete solutions, which have 14 digits

struct Case {
  std::string name;
  std::function<Model(Real)> model;
  Real step;  // the coarser one [s]
  // Bounds at that step and alpha = -0.1, 1.2 times the measured errors: position [m], rotation [rad], force
  // [N].
  Real position, rotation, force;
  ForceError force_error = {};
};

// The mesh's reaction is a torque on the first gear, the rack's one on its pinion.
Real gear_force_error(const ReferenceTable::Row& row, const std::vector<Reaction>& reactions) {
  const Real mesh = reactions.at(3).torque.z / 0.1, rack = -reactions.at(4).torque.z / 0.08;
  return std::max(std::abs(mesh - row["gear_force [N]"]), std::abs(rack - row["rack_force [N]"]));
}

Real screw_force_error(const ReferenceTable::Row& row, const std::vector<Reaction>& reactions) {
  const Vec3 u{0.6, 0, 0.8}, a{0.8, 0, -0.6}, b{0, 1, 0};
  return norm(reactions.at(0).force -
              (row["screw_Fa [N]"] * a + row["screw_Fb [N]"] * b + row["screw_Fu [N]"] * u));
}

const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {"heavy_top", heavy_top, 1e-3, 2.3e-3, 2.4e-3, 2.45},
      {"double_spherical", double_spherical, 1e-3, 2.6e-5, 1.9e-4, 8e-3},
      {"chain20", chain20, 1e-3, 1.9e-5, 3.8e-4, 8.6e-3},
      {"slider_crank", slider_crank_in_space, 1e-3, 2.6e-5, 7.3e-4, 0},
      {"free_body", free_body, 2e-3, 0, 1.6e-4, 0},
      {"gears", gears_in_space, 1e-3, 1e-6, 1.9e-5, 1.8e-4, gear_force_error},
      {"screw", screw_in_space, 1e-3, 1.1e-4, 1.1e-3, 0.047, screw_force_error}};
  return all;
}

// Largest errors of the heavy top's pin [N]: by the steps' own multipliers, and by the reactions.
struct TopErrors {
  Real multipliers = 0, reactions = 0;
};
TopErrors top_errors(bool corrected_start, Real h) {
  Model model = heavy_top(-0.1);
  model.integrator.corrected_start = corrected_start;
  MultibodyRun run(model, 1e-13);
  const ReferenceTable reference("spatial/heavy_top.csv");
  TopErrors largest;
  for (const ReferenceTable::Row& row : reference.rows()) {
    const int steps = static_cast<int>(std::lround((row["t [s]"] - run.time) / h));
    if (steps > 0) run.steps(steps, h);
    const Vec3 exact{row["Fx1 [N]"], row["Fy1 [N]"], row["Fz1 [N]"]};
    const Real* lambda = run.state.multipliers.data();
    const Vec3 reaction = run.multibody.reactions(run.state, run.time)[0].force;
    largest.multipliers = std::max(largest.multipliers, norm(Vec3{lambda[0], lambda[1], lambda[2]} + exact));
    largest.reactions = std::max(largest.reactions, norm(reaction - exact));
  }
  return largest;
}

}  // namespace

TEST_CASE("spatial mechanisms converge to their references with second order") {
  for (const Case& c : cases())
    for (const Real alpha : {-0.02, -0.1, -0.3}) {
      const auto errors = [&](Real h) {
        return spatial_errors(c.model(alpha), c.name + ".csv", h, 0, 1e-13, c.force_error);
      };
      const SpatialErrors coarse = errors(c.step), fine = errors(c.step / 2);
      const auto check = [&](const char* what, Real SpatialErrors::*error, Real bound) {
        CAPTURE(c.name, alpha, what, coarse.*error, fine.*error);
        if (alpha == Real(-0.1)) CHECK(coarse.*error < bound);
        const Real order = std::log2(coarse.*error / fine.*error);
        CHECK(measured("spatial/order", "", in_range(order, 1.95, 2.05)));
      };
      if (c.position > 0) {
        check("position", &SpatialErrors::position, c.position);
        check("velocity", &SpatialErrors::velocity, kInfinity);
      }
      check("rotation", &SpatialErrors::rotation, c.rotation);
      check("spin", &SpatialErrors::spin, kInfinity);
      if (c.force > 0) check("force", &SpatialErrors::force, c.force);
    }
}

// A body without joints moves straight to round-off.
TEST_CASE("a free body's centre goes straight") {
  const SpatialErrors errors = spatial_errors(free_body(-0.1), "free_body.csv", 2e-3);
  CHECK(errors.position < 1e-11);
  CHECK(errors.velocity < 1e-13);
}

TEST_CASE("discrete solutions of the method are met") {
  const auto check = [](Model model, const std::string& table) {
    CAPTURE(table);
    model.integrator.corrected_start = false;
    const SpatialErrors errors = spatial_errors(model, table, 1e-3);
    for (const Real error : {errors.position, errors.rotation, errors.velocity, errors.spin})
      CHECK(measured("spatial/discrete", "", at_most(error, kRoundOff)));
  };
  check(heavy_top(-0.1), "hht_heavy_top.csv");
  check(double_spherical(-0.3), "hht_double_spherical.csv");
  check(slider_crank_in_space(-0.1), "hht_slider_crank.csv");
}

// Without the correction the multipliers begin with a disturbance of first order.
TEST_CASE("the corrected start takes the first-order disturbance from the multipliers of the steps") {
  CHECK(top_errors(false, 1e-3).multipliers > 20);
  CHECK(top_errors(true, 1e-3).multipliers < 2.8);
}

TEST_CASE("reactions are of second order from the first step on, without a corrected start, too") {
  const Real coarse = top_errors(false, 1e-3).reactions, fine = top_errors(false, 5e-4).reactions;
  CHECK(coarse < 2.5);
  CHECK(near(std::log2(coarse / fine), 2.0, {.absolute = 0.05}));
}

// Without w x w' the estimate has another sign and direction.
TEST_CASE("the local error estimate of a rotating body is that of its first step") {
  constexpr Real kStep = 1e-2;
  Model model = free_body(-0.1);
  MultibodyRun coarse(model, 1e-13), fine(model, 1e-13);
  coarse.multibody.predict(coarse.state, 0, kStep);
  const ContactWrenches none{std::vector<BodyWrench>(1), {}};
  for (int i = 0; i < 6; ++i) coarse.multibody.correct(none);
  const Real estimate = coarse.multibody.error();
  const Quaternion after = coarse.multibody.motion()[0].orientation;
  fine.steps(100, kStep / 100);
  const Quaternion exact = fine.multibody.motion(fine.state)[0].orientation;
  const Real error = norm(rotation_vector(conjugate(exact) * after));
  CAPTURE(estimate, error);
  CHECK(near(estimate, error, {.relative = 0.1}));
}

TEST_CASE("three Newton iterations solve a step of a top that rotates by 0.15 rad") {
  MultibodyRun run(heavy_top(-0.1), 1e-10);
  run.steps(100, 1e-3);
  CHECK(run.most_iterations <= 4);
}
