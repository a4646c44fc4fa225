// The choice of the skin, and the frame in which a list wears.
#include "dem/search/skin_choice.hpp"

#include <cmath>

#include "dem/search/list_frame.hpp"
#include "support/catch.hpp"

namespace scree {
namespace {

constexpr Real kRadius = 0.01;

Model moving_bed() {
  Model model;
  model.space.dimension = 3;
  model.space.min = {}, model.space.max = {1, 1, 1};
  model.particles.totals.count = 1000;
  model.particles.totals.smallest_radius = model.particles.totals.largest_radius = kRadius;
  model.integrator.particles = ParticleIntegrator::velocity_verlet;
  model.contact.skin = 0.2 * kRadius, model.contact.skin_is_default = true;
  return model;
}

constexpr Real kRoundOff = 1e-9;
bool equal(Real a, Real b) { return std::abs(a - b) <= kRoundOff * std::abs(b); }

constexpr ListCosts kCosts{.fixed = 20, .search = 10};

}  // namespace

TEST_CASE("the skin grows with the displacement in a step") {
  const Model model = moving_bed();
  SkinChoice choice(model, kCosts);
  CHECK(choice.next() == model.contact.skin);
  const auto [smallest, widest] = skins_to_choose_from(model);
  CHECK((smallest == 0.1 * kRadius && widest == kRadius));
  Real before = 0;
  for (const Real step : {0.0, 1e-5, 1e-4, 1e-3, 1e-2}) {
    CAPTURE(step);
    choice.note(100 * step * kRadius, 100);
    CHECK(choice.next() >= before);
    before = choice.next();
    if (step == 0) CHECK(choice.next() == smallest);
  }
  CHECK(before > model.contact.skin);
  SECTION("a list that ended at once, or after a value that is not finite, says nothing") {
    choice.note(0, 1), choice.note(std::nan(""), 100);
    CHECK(choice.next() == before);
  }
  SECTION("limits: memory, and what the deck or the precision fixes") {
    const Real limit = choice.limit_in_memory(1e6, 1e4, 100);  // twice the entries
    CHECK(equal(limit, std::cbrt(2.0) * (2 * kRadius + before) - 2 * kRadius));
    choice.limit_to(0.35 * kRadius), choice.note(kRadius, 100);
    CHECK(equal(choice.next(), 0.3 * kRadius));
    choice.limit_to(0), choice.note(kRadius, 100);
    CHECK(choice.next() == smallest);
  }
}

TEST_CASE("the skin stays where results depend on it or the deck names it") {
  Model given = moving_bed(), mixed = moving_bed(), implicit = moving_bed();
  given.contact.skin_is_default = false;
  mixed.integrator.precision = Precision::mixed;
  implicit.integrator.particles = ParticleIntegrator::hht;
  for (const Model* model : {&given, &mixed, &implicit}) {
    SkinChoice choice(*model, kCosts);
    choice.note(kRadius, 100);
    CHECK_FALSE(choice.is_open());
    CHECK(choice.next() == model->contact.skin);
  }
  CHECK(lists_leave_no_trace(given));
  CHECK_FALSE(lists_leave_no_trace(mixed));
}

TEST_CASE("a periodic domain bounds the skin") {
  Model model = moving_bed();
  model.space.max.x = 6 * kRadius;
  model.space.boundary[0] = model.space.boundary[1] = Boundary::periodic;
  CHECK(equal(widest_skin_of_domain(model), kRadius));
  model.space.max.x = 5 * kRadius;
  SkinChoice choice(model, kCosts);
  choice.note(kRadius, 100);
  CHECK(choice.next() <= 0.5 * kRadius + kRoundOff);
}

TEST_CASE("the frame of a list falls with the particles") {
  const Vec3 gravity{0, 0, -9.81};
  const auto near = [](Vec3 a, Vec3 b) { return norm(a - b) < 1e-12; };
  SECTION("all fall: the frame falls with them, until surfaces are no longer covered") {
    ListFrame frame(gravity, 1.9, 2.1, 2.1, 0.1, 0.01, 0.02);
    CHECK(near(frame.velocity(), {0, 0, -2}));
    CHECK(frame.reach() == 0.02);  // at most
    frame.move(1e-3, 9);
    CHECK(near(frame.displacement(), {0, 0, -0.018}));
    CHECK(frame.covers_surfaces());
    CHECK(equal(frame.steps_left(1e-3), 1));
    frame.move(1e-3, 2);
    CHECK_FALSE(frame.covers_surfaces());
  }
  SECTION("half of them rest: the frame lasts as long as half the skin") {
    ListFrame frame(gravity, 0, 2, 2, 1, 0.01, 0.02);
    CHECK(near(frame.velocity(), {0, 0, -1}));
    CHECK(equal(frame.reach(), 0.005));
  }
  SECTION("a frame at rest covers surfaces always") {
    for (ListFrame frame : {ListFrame(), ListFrame(gravity, -1, 1, 1, 1, 0.01, 0.02)}) {
      frame.move(1, 1000);
      CHECK(near(frame.displacement(), {}));
      CHECK(frame.reach() == 0);
      CHECK(frame.covers_surfaces());
      CHECK(frame.steps_left(1) == kInfinity);
    }
  }
}

}  // namespace scree
