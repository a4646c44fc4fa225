// A spring with slider over an implicit step: energy, derivatives, order.
#include "physics/step_slider.hpp"

#include <cmath>

#include "random_contact.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 64 * kUlp;
constexpr int kCases = 100000;

struct RandomStep {
  SpringSlider slider;
  Vec3 old, displacement;
  Real h = 0.1;
  Real end_limit = 0;
};

// Steps of all kinds, also with old forces beyond the limit, and many times longer than the displacement to
// it.
RandomStep random_step(RandomNumbers& random) {
  RandomStep out;
  const Real k = 2 + random();
  out.slider = {k, random() > 0 ? k : 2 + random(), random() > 0 ? 0 : 0.2 + 0.1 * random(),
                1.001 + random()};
  out.end_limit = random() > 0 ? out.slider.limit : out.slider.limit * (1 + random());
  out.old = (2 * random()) * random.vector();
  out.displacement = (4 * random()) * random.vector();
  return out;
}

StepSpring step_of(const RandomStep& s) {
  return step_spring(s.slider, s.old, s.displacement, s.h, s.end_limit);
}

}  // namespace

TEST_CASE("over an implicit step no spring with slider gives energy, and the energy balance closes") {
  RandomNumbers random;
  int slid = 0;
  for (int k = 0; k < kCases; ++k) {
    const RandomStep s = random_step(random);
    const StepSpring out = step_of(s);
    const Real work = dot(out.mean, s.displacement);
    const Real gain =
        spring_energy(out.spring, s.slider.stiffness) - spring_energy(s.old, s.slider.stiffness0);
    REQUIRE(work - gain >= -kRoundOff);
    REQUIRE(near(work, gain + out.losses.sum(), {.absolute = kRoundOff}));
    REQUIRE(out.losses.sliding >= -kRoundOff);
    REQUIRE(out.losses.unloading >= -kRoundOff);
    REQUIRE(norm(out.mean) <= s.slider.limit * (1 + kRoundOff));
    slid += out.limit_slope > 0;
  }
  CHECK((slid > kCases / 10 && slid < 9 * kCases / 10));
}

TEST_CASE("while a spring with slider sticks, the dashpot alone dissipates") {
  const StepSpring out = step_spring({2, 2, 0.3, 100}, {1, 0, 0}, {0.1, 0.2, 0}, 0.5, 100);
  CHECK(near(out.losses.sum(), 0.3 * 0.05 / 0.5, {.relative = kRoundOff}));
  CHECK(near(out.mean, Vec3{1 + 0.1 + 0.06, 0.2 + 0.12, 0}, {.relative = kRoundOff}));
  CHECK(near(out.spring, Vec3{1.2, 0.4, 0}, {.relative = kRoundOff}));
}

TEST_CASE("the derivatives of the mean force are those of differences") {
  constexpr Real kDifference = 1e-6, kTruncation = 1e-7;
  RandomNumbers random;
  for (int k = 0; k < 1000; ++k) {
    const RandomStep s = random_step(random);
    const StepSpring at = step_of(s);
    const Vec3 direction = random.vector();
    RandomStep plus = s, minus = s;
    plus.displacement = s.displacement + kDifference * direction,
    minus.displacement = s.displacement - kDifference * direction;
    if (step_of(plus).limit_slope != step_of(minus).limit_slope) continue;  // a kink between the two
    const Vec3 by_displacement = (1 / (2 * kDifference)) * (step_of(plus).mean - step_of(minus).mean);
    const Vec3 derivative = at.stiffness * (direction - dot(at.direction, direction) * at.direction);
    CHECK(near(by_displacement, derivative, {.absolute = kTruncation}));
    plus = s, minus = s;
    plus.slider.limit += kDifference, minus.slider.limit -= kDifference;
    const Vec3 by_limit = (1 / (2 * kDifference)) * (step_of(plus).mean - step_of(minus).mean);
    if (norm(s.old) < 2 * minus.slider.limit - s.end_limit)
      CHECK(near(by_limit, at.limit_slope * at.direction, {.absolute = kTruncation}));
  }
}

TEST_CASE("in an implicit step a dashpot acts beside a spring within its limit, not beside one that slides") {
  const SpringSlider slider{1, 1, 2, 10};
  CHECK(dashpot_part(slider, {}) == 1);
  CHECK(dashpot_part(slider, {0, -9.9, 0}) == 1);
  CHECK(near(dashpot_part(slider, {0, -9.995, 0}), 0.5, {.absolute = 1e-9}));
  CHECK(dashpot_part(slider, {10, 0, 0}) == 0);
  CHECK(dashpot_part(slider, {8, 8, 0}) == 0);
  CHECK(acting_at(slider, {9, 0, 0}, {-1, 0, 0}) == Vec3{7, 0, 0});
  CHECK(acting_at(slider, {9, 0, 0}, {1, 0, 0}) == Vec3{10, 0, 0});
  CHECK(acting_at(slider, {10, 0, 0}, {-1, 0, 0}) == Vec3{10, 0, 0});
  CHECK(acting_at({1, 1, 0, 10}, {10, 0, 0}, {-1, 0, 0}) == Vec3{10, 0, 0});
}

// A slip that reverses while the limit falls: the spring sticks, slides, releases, and slides again as the
// limit reaches it.
TEST_CASE("implicit steps of a spring, slider and dashpot tend to explicit ones as steps shrink") {
  const auto displacement_to = [](Real t) { return 0.12 * std::sin(3.5 * t); };
  const auto limit_at = [](Real t) { return t < 0.4 ? 0.3 : 0.3 - 2.5 * (t - 0.4); };
  constexpr Real kStiffness = 5, kDashpot = 0.5;
  enum class Steps { explicit_, implicit_, dashpot_at_all_times };
  const auto impulse_to = [&](int steps, Steps kind) {
    const Real h = Real(0.5) / steps;
    Vec3 spring;
    Real impulse = 0;
    for (int k = 0; k < steps; ++k) {
      const Real t = k * h, first = limit_at(t), last = limit_at(t + h);
      const Vec3 displacement{displacement_to(t + h) - displacement_to(t), 0, 0};
      SpringSlider slider{kStiffness, kStiffness, kDashpot, last};
      if (kind != Steps::explicit_) {
        if (kind == Steps::implicit_)
          slider.dashpot *= dashpot_part({kStiffness, kStiffness, kDashpot, first}, spring);
        slider.limit = (first + last) / 2;
        const StepSpring out = step_spring(slider, spring, displacement, h, last);
        spring = out.spring, impulse += h * out.mean.x;
      } else {
        const SpringStep out = spring_step(slider, spring, displacement, h);
        spring = out.spring, impulse += h * out.acting.x;
      }
    }
    return impulse;
  };
  const Real exact = impulse_to(400000, Steps::explicit_);
  const Real coarse = std::abs(impulse_to(50, Steps::implicit_) - exact),
             fine = std::abs(impulse_to(800, Steps::implicit_) - exact),
             another = std::abs(impulse_to(800, Steps::dashpot_at_all_times) - exact);
  CAPTURE(coarse, fine, another, exact);
  CHECK(coarse < 5e-4 * exact);
  CHECK(fine < 1e-5 * exact);
  CHECK(another > 5e-3 * exact);
}

TEST_CASE("while a spring with slider sticks, steps of half the size quarter the error") {
  // An oscillating displacement: T = sin(t) from 0 to 2, stiffness 1.
  const auto error = [](int steps) {
    const Real h = 2.0 / steps;
    Vec3 spring;
    Real impulse = 0;
    for (int k = 0; k < steps; ++k) {
      const Real displacement = std::sin((k + 1) * h) - std::sin(k * h);
      const StepSpring out = step_spring({1, 1, 0, 10}, spring, {displacement, 0, 0}, h, 10);
      spring = out.spring, impulse += h * out.mean.x;
    }
    return std::abs(impulse - (1 - std::cos(2.0)));
  };
  CHECK(near(error(100) / error(200), 4, {.absolute = 0.05}));
}

}  // namespace scree
