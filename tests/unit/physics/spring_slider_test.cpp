// A spring with a slider and a dashpot: history, force and energy.
#include "physics/spring_slider.hpp"

#include <algorithm>

#include "random_contact.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 32 * kUlp;
constexpr int kCases = 10000;

struct RandomStep {
  SpringSlider slider;
  Vec3 old, displacement;
  Real h = 0.1;
};

// Steps of all kinds: sticking and sliding, with rising and falling stiffness, with and without dashpot.
RandomStep random_step(RandomNumbers& random) {
  RandomStep out;
  const Real k = 2 + random(), limit = 1.5 + random();
  out.slider = {k, random() > 0 ? k : 2 + random(), random() > 0 ? 0 : 0.2 + 0.1 * random(), limit};
  out.old = (limit * random() / 1.8) * random.vector();
  out.displacement = (2 * random()) * random.vector();
  return out;
}

}  // namespace

TEST_CASE("shortened: no longer than the limit, in the same direction") {
  CHECK(shortened({3, 4, 0}, 5) == Vec3{3, 4, 0});
  CHECK(near(shortened({3, 4, 0}, 2.5), Vec3{1.5, 2, 0}, {.relative = kRoundOff}));
  CHECK(shortened({3, 4, 0}, 0) == Vec3{});
  CHECK(shortened({}, 0) == Vec3{});
  CHECK(shortened({1e-150, 0, 0}, 0) == Vec3{});
}

TEST_CASE("force and history stay within the limit") {
  RandomNumbers random;
  for (int k = 0; k < kCases; ++k) {
    const RandomStep s = random_step(random);
    const SpringStep out = spring_step(s.slider, s.old, s.displacement, s.h);
    CHECK(norm(out.spring) <= s.slider.limit * (1 + kRoundOff));
    CHECK(norm(out.acting) <= s.slider.limit * (1 + kRoundOff));
  }
}

TEST_CASE("work, elastic energy and losses add up, and no loss is negative but by a reversal") {
  RandomNumbers random;
  int slid = 0, damped = 0, unloaded = 0;
  for (int k = 0; k < kCases; ++k) {
    const RandomStep s = random_step(random);
    const SpringStep out = spring_step(s.slider, s.old, s.displacement, s.h);
    const Real shrink =
        s.slider.stiffness < s.slider.stiffness0 ? s.slider.stiffness / s.slider.stiffness0 : 1;
    const Real work = dot(Real(0.5) * (s.old + out.spring) + (out.acting - out.spring), s.displacement);
    // A spring that weakens may lose less than nothing where the displacement reverses by more than it.
    const Real reversed = (1 - shrink) / 2 * dot(s.old, s.displacement);
    const Real gain =
        spring_energy(out.spring, s.slider.stiffness) - spring_energy(s.old, s.slider.stiffness0);
    CHECK(near(work, gain + out.losses.sum(), {.absolute = kRoundOff}));
    CHECK(out.losses.dashpot >= -kUlp);
    CHECK(out.losses.unloading >= std::min<Real>(reversed, 0) - kUlp);
    CHECK((out.losses.sliding >= 0 || norm(s.old) > s.slider.limit));
    slid += out.losses.sliding > 0, damped += out.losses.dashpot > 0, unloaded += out.losses.unloading > 0;
  }
  CHECK((slid > kCases / 10 && damped > kCases / 10 && unloaded > kCases / 10));
}

TEST_CASE("a spring that sticks keeps its force while it stiffens, and loses with the stiffness") {
  const Vec3 old{0.3, 0.1, 0};
  CHECK(spring_step({5, 3, 0, 1}, old, {}, 1).spring == old);
  CHECK(near(spring_step({3, 5, 0, 1}, old, {}, 1).spring, Real(0.6) * old, {.relative = kRoundOff}));
  // From 0, as the root of the overlap: two thirds.
  CHECK(near(spring_step({3, 0, 0, 1}, {}, {0.1, 0, 0}, 1).spring, Vec3{0.2, 0, 0}, {.relative = kRoundOff}));
  // Exact where a radius grows with the root of the overlap, in one step or in parts.
  const auto grown = [](int parts) {
    Vec3 spring;
    for (int k = 0; k < parts; ++k) {
      const Real k0 = std::sqrt(Real(k) / parts), k1 = std::sqrt(Real(k + 1) / parts);
      spring = spring_step({k1, k0, 0, 1}, spring, {0.1 / parts, 0, 0}, 1).spring;
    }
    return spring;
  };
  CHECK(near(grown(7), grown(1), {.relative = kRoundOff}));
}

TEST_CASE("the dashpot acts while the spring sticks, and not while it slides") {
  const SpringStep sticks = spring_step({1, 1, 2, 10}, {1, 0, 0}, {0.5, 0, 0}, 0.25);
  CHECK(sticks.spring == Vec3{1.5, 0, 0});
  CHECK(sticks.acting == Vec3{5.5, 0, 0});
  CHECK(sticks.losses.dashpot == 2);
  const SpringStep slides = spring_step({1, 1, 2, 1}, {1, 0, 0}, {0.5, 0, 0}, 0.25);
  CHECK(slides.spring == Vec3{1, 0, 0});
  CHECK(slides.acting == slides.spring);
  CHECK(slides.losses.sliding == 0.5);
}

}  // namespace scree
