// Undamped oscillations of reactions are distinguished from reactions that alternate for a reason.
#include "mbs/reaction_watch.hpp"

#include <array>
#include <string>

#include "base/error.hpp"
#include "support/catch.hpp"
#include "support/multibody_run.hpp"

using namespace scree;

namespace {

Body rod(const std::string& name, Vec3 from, Vec3 to, Real mass) {
  Body body;
  body.name = name;
  body.mass = mass;
  body.inertia = mass * dot(to - from, to - from) / 12;
  body.position = Real(0.5) * (from + to);
  return body;
}

void pin(Model& model, const std::string& name, int first, int second, Vec3 at) {
  Joint joint;
  joint.name = name;
  const int bodies[2] = {first, second};
  for (std::size_t side = 0; side < 2; ++side) {
    joint.body[side] = bodies[side];
    const int body = bodies[side];
    joint.point[side] = body == kGround ? at : at - model.bodies[static_cast<std::size_t>(body)].position;
  }
  model.joints.push_back(joint);
}

// A four-bar that swings under gravity.
Model four_bar(Real hht_alpha) {
  const std::array<Vec3, 4> corner{Vec3{0, 0, 0}, Vec3{0, 0.2, 0}, Vec3{0.4, 0.4, 0}, Vec3{0.5, 0, 0}};
  Model model = empty_model();
  model.integrator.hht_alpha = hht_alpha;
  model.bodies = {rod("crank", corner[0], corner[1], 0.5), rod("coupler", corner[1], corner[2], 1.2),
                  rod("rocker", corner[3], corner[2], 1)};
  pin(model, "a", kGround, 0, corner[0]);
  pin(model, "b", 0, 1, corner[1]);
  pin(model, "c", 1, 2, corner[2]);
  pin(model, "d", kGround, 2, corner[3]);
  return model;
}

// Takes steps and returns the message where the reactions oscillate.
std::string outcome(const Model& model, int steps, Real h) {
  MultibodyRun run(model);
  try {
    run.steps(steps, h);
    run.multibody.check_reactions();
  } catch (const SimulationError& error) {
    return error.what();
  }
  return "done";
}

}  // namespace

TEST_CASE("reactions of a four-bar at alpha = 0: the run ends and names the remedy") {
  const std::string text = outcome(four_bar(0), 30000, 1e-3);
  CAPTURE(text);
  CHECK(text.find("the reactions of joints and drivers, not those recorded, change sign") !=
        std::string::npos);
  CHECK(text.find("integrator.hht_alpha = 0 does not damp; set it below zero, e.g. -0.05") !=
        std::string::npos);
  CHECK(outcome(four_bar(-0.02), 30000, 1e-3) == "done");
}

TEST_CASE("reactions that a stiff spring makes alternate are its own") {
  // omega h is about 30, so that the spring's force changes its sign at nearly every step, and the pin's with
  // it.
  Model model = empty_model();
  model.bodies.push_back(paper_disc("bob", 0.5, 0));
  model.joints.push_back(ground_pin("pivot", 0, {0, 0, 0}, {-0.5, 0, 0}));
  model.spring_dampers.push_back({"stiff", {kGround, 0}, {{0.5, -0.3, 0}, {0, 0, 0}}, 1e9, 0, 0.3001, {}});
  CHECK(outcome(model, 3000, 1e-3) == "done");
}

TEST_CASE("the watch: fifty alternating steps and a tenfold growth, of reactions and of velocity gaps") {
  const std::vector<Real> scale{1}, constraint_scale{1};
  const auto watched = [&](Real growth, Real applied, bool gap_turns, int steps) {
    ReactionWatch watch(scale, constraint_scale);
    MultibodyState start, end;
    start.applied = {0}, start.force = {0}, end.velocity = {2};
    Real size = 1;
    for (int i = 0; i < steps; ++i, size *= growth) {
      const Real sign = i % 2 == 0 ? 1 : -1;
      end.applied = {sign * applied * size};
      end.force = {end.applied[0] - (1 + sign * size)};  // reaction 1 + sign * size
      watch.observe(start, end, {gap_turns ? sign : 1});
      start = end;
    }
    CHECK(watch.relative_gap() == 0.5);
    CHECK((watch.worst_ratio() > 0) == watch.oscillates());
    return watch.oscillates();
  };
  CHECK(watched(1.1, 0, true, 100));
  CHECK(!watched(1.1, 0, true, 40));
  CHECK(!watched(1, 0, true, 100));
  CHECK(!watched(1.1, 0, false, 100));
  CHECK(!watched(1.1, 5, true, 100));
}
