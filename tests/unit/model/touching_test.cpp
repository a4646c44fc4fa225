// Pairs of particles and shapes with possible contacts, and their sizes.
#include "model/derived/touching.hpp"

#include "support/catch.hpp"

namespace scree {

namespace {

// Bodies 0 to 4 with a shape each except body 3; 0-1 by a joint, 1-2 by two springs, 4 connected to the
// ground.
Model five_bodies() {
  Model model;
  model.bodies.resize(5);
  for (const std::size_t b : {0u, 1u, 2u, 4u}) model.bodies[b].shapes = {{{}, 0.1 + 0.1 * Real(b), 0}};
  model.joints.resize(2);
  model.joints[0].body[0] = 1, model.joints[0].body[1] = 0;
  model.joints[1].body[1] = 4;
  model.spring_dampers.resize(1);
  model.spring_dampers[0].body[0] = 1, model.spring_dampers[0].body[1] = 2;
  model.torsional_spring_dampers.resize(1);
  model.torsional_spring_dampers[0].body[0] = 2, model.torsional_spring_dampers[0].body[1] = 1;
  return model;
}

}  // namespace

TEST_CASE("shapes of one body and of connected bodies have no contacts unless the deck asks for them") {
  Model model = five_bodies();
  const TouchRule rule(model);
  for (int a = 0; a < 5; ++a)
    for (int b = 0; b < 5; ++b) {
      CAPTURE(a, b);
      const bool connected =
          (std::min(a, b) == 0 && std::max(a, b) == 1) || (std::min(a, b) == 1 && std::max(a, b) == 2);
      CHECK(rule.may_touch(a, b) == (a != b && !connected));
    }
  CHECK(rule.excluded_bodies(1) == std::vector<int>{0, 2});
  CHECK(rule.excluded_bodies(2) == std::vector<int>{1});
  CHECK(rule.excluded_bodies(4).empty());
  for (int a = kGround; a < 5; ++a) CHECK((rule.may_touch(a, kGround) && rule.may_touch(kGround, a)));

  model.contact.connected_bodies_touch = true;
  const TouchRule touching(model);
  CHECK(touching.may_touch(0, 1));
  CHECK_FALSE(touching.may_touch(3, 3));
  CHECK(touching.excluded_bodies(1).empty());
}

TEST_CASE("bodies may touch where two that have shapes are not connected") {
  Model model = five_bodies();
  CHECK(TouchRule(model).bodies_may_touch());
  for (const std::size_t b : {2u, 4u})
    model.bodies[b].shapes.clear();  // 0 and 1 remain, which a joint connects
  CHECK_FALSE(TouchRule(model).bodies_may_touch());
  model.bodies[3].shapes = {{{}, 0.1, 0}};
  CHECK(TouchRule(model).bodies_may_touch());
  model.bodies[3].shapes.clear();
  model.contact.connected_bodies_touch = true;
  CHECK(TouchRule(model).bodies_may_touch());
  model.bodies[1].shapes.clear();
  CHECK_FALSE(TouchRule(model).bodies_may_touch());
  CHECK_FALSE(TouchRule(Model()).bodies_may_touch());
}

TEST_CASE("the range of radii is that of particles and shapes") {
  Model model;
  CHECK((radius_range(model).smallest == 0 && radius_range(model).largest == 0));
  model = five_bodies();
  CHECK((radius_range(model).smallest == 0.1 && radius_range(model).largest == 0.5));
  model.particles.totals.count = 2;
  model.particles.totals.smallest_radius = 0.2, model.particles.totals.largest_radius = 0.7;
  CHECK((radius_range(model).smallest == 0.1 && radius_range(model).largest == 0.7));
}

}  // namespace scree
