// Contacts with rolling and twisting resistance in single precision, against those in double.
#include "physics/single_contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "physics/normal_laws.hpp"
#include "physics/rolling_laws.hpp"
#include "physics/tangential_laws.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

using Linear = ContactLaw<LinearRestitutionLaw, LinearSlider, AnyRolling>;
using Hertz = ContactLaw<HertzLaw, MindlinSlider, AnyRolling>;
using Power = ContactLaw<PowerLaw, LinearSlider, AnyRolling>;

constexpr Real kStep = 1e-4;
constexpr Real kInertiaFactor = 0.4;

NormalLawParameters normal_parameters(bool hertz, Real exponent) {
  NormalLawParameters p;
  if (hertz)
    p.effective_modulus = 5e6;
  else
    p.normal_stiffness = 2e5, p.exponent = exponent;
  p.damping_ratio = 0.1;
  return p;
}

template <class Law>
Law law_of(Real tangential_damping, const RollingParameters& rolling) {
  constexpr bool kHertz = std::is_same_v<Law, Hertz>;
  using Normal = typename Law::Normal;
  const Friction friction{0.3, Real(2) / 7 * 2e5, 2e6, tangential_damping};
  return {Normal(normal_parameters(kHertz, std::is_same_v<Law, Power> ? 1.2 : 1)),
          Law::Tangential::of(friction), AnyRolling::of(rolling)};
}

// Two spheres i and j; the position is that of i relative to j.
struct Spheres {
  Real radius_i = 0.5, radius_j = 0.4;  // [m]
  Real density = 2;                     // [kg/m^3]

  Real mass(Real radius) const { return density * Real(4.18879) * radius * radius * radius; }
  RotatingPartner partner(Vec3 spin, Real radius) const {
    return {spin, radius, kInertiaFactor * mass(radius) * radius * radius};
  }
  Real effective_radius() const { return radius_i * radius_j / (radius_i + radius_j); }
};

struct Motion {
  Vec3 start, end;      // position at the start and the end of the step [m]
  Vec3 spin_i, spin_j;  // [rad/s]
};

MovingPair exact_pair(const Spheres& s, const Motion& m, Real h) {
  const ContactGeometry geometry = sphere_pair(m.end, s.radius_i + s.radius_j);
  return {{geometry,
           (1 / h) * (m.end - m.start),
           {s.radius_i, s.radius_j, s.mass(s.radius_i), s.mass(s.radius_j)}},
          sphere_motion(geometry, m.end - m.start, s.partner(m.spin_i, s.radius_i),
                        s.partner(m.spin_j, s.radius_j), h)};
}

SinglePair pair_in_single(const Spheres& s, const Motion& m, Real h) {
  const auto single = [](Real a) { return static_cast<float>(a); };
  const float i = single(s.radius_i), j = single(s.radius_j);
  SinglePair out = single_pair({sphere_pair(in_single(m.end), i + j),
                                in_single((1 / h) * (m.end - m.start)),
                                {i, j, single(s.mass(s.radius_i)), single(s.mass(s.radius_j))}},
                               in_single(m.spin_i), in_single(m.spin_j), single(h));
  out.inertia_i = single(s.partner({}, s.radius_i).inertia);
  out.inertia_j = single(s.partner({}, s.radius_j).inertia);
  return out;
}

// A pair that revolves while its overlap, the rolling and the twisting go back and forth.
Motion motion_at(const Spheres& s, int k, Real scale = 1) {
  const Real reach = s.radius_i + s.radius_j;
  const auto position = [&](int at) {
    const Real t = kStep * at, angle = 0.3 * t, overlap = 0.01 * std::sin(8 * t) + 0.004 * std::sin(31 * t);
    const Real distance = reach * (1 - overlap);
    return distance * Vec3{std::cos(angle) * 0.6, std::sin(angle) * 0.6, 0.8};
  };
  const Real t = kStep * k, rate = 3 * scale;
  return {position(k), position(k + 1), rate * Vec3{std::sin(11 * t), 0.4, std::cos(7 * t)},
          rate * Vec3{0.2, std::cos(5 * t), std::sin(9 * t)}};
}

// Losses by kind over the steps, and largest differences, of one law in both precisions.
struct Comparison {
  ContactHistory exact, single;
  TangentialLosses losses{}, losses_in_single{};
  Real largest_moment = 0, moment_difference = 0, torque_difference = 0, largest_torque = 0;
  Real power = 0, power_in_single = 0;
  int closed = 0, rolled = 0, twisted = 0;  // steps in contact; at the limits
};

template <class Law>
Comparison compare(const Law& law, const Spheres& spheres, int steps, Real scale = 1) {
  Comparison c;
  for (int k = 0; k < steps; ++k) {
    const Motion motion = motion_at(spheres, k, scale);
    const MovingPair pair = exact_pair(spheres, motion, kStep);
    if (!(pair.geometry.overlap > 0)) {
      c.exact = c.single = {};
      continue;
    }
    const ContactOutcome exact = law.respond(pair, c.exact);
    const auto single = single_load(law, pair_in_single(spheres, motion, kStep), c.single);
    c.exact = exact.history, c.single = single.history, ++c.closed;
    c.losses.add(exact.losses());
    for (int kind = 0; kind < kLossKinds; ++kind) c.losses_in_single.of[kind] += single.losses[kind];
    c.power += exact.load.loss, c.power_in_single += single.loss;
    c.largest_moment = std::max(c.largest_moment, norm(c.exact.moment));
    c.moment_difference = std::max(c.moment_difference, norm(c.exact.moment - c.single.moment));
    c.largest_torque = std::max(c.largest_torque, norm(exact.load.torque_i));
    c.torque_difference =
        std::max(c.torque_difference, norm(exact.load.torque_i - in_double(single.torque_i)));
    c.rolled += exact.rolling.sliding > 0, c.twisted += exact.twisting.sliding > 0;
  }
  return c;
}

template <class Law>
void check_precision(const Comparison& c) {
  CAPTURE(c.closed, c.rolled, c.twisted);
  CHECK(c.largest_moment > 0);
  CHECK(c.moment_difference < 2e-4 * c.largest_moment);
  CHECK(c.torque_difference < 2e-4 * c.largest_torque);
  CHECK(near(c.power_in_single, c.power, {.relative = 1e-3}));
  for (int kind = 0; kind < kLossKinds; ++kind) {
    CAPTURE(kind);
    CHECK(c.losses.of[kind] > 0);
    CHECK(near(c.losses_in_single.of[kind], c.losses.of[kind], {.relative = 1e-3}));
  }
}

}  // namespace

TEMPLATE_TEST_CASE("single precision: rolling and twisting moments, their limits and losses by kind", "",
                   Linear, Hertz, Power) {
  // Without dashpots: they are off while a spring slides, which may begin a step earlier in single precision.
  const auto law = law_of<TestType>(0, {.friction = 0.2, .stiffness_factor = 0.3, .twisting_friction = 0.2});
  const Comparison c = compare(law, {}, 6000);
  check_precision<TestType>(c);
  CHECK((c.rolled > 300 && c.twisted > 300));
  CHECK((c.rolled < c.closed - 300 && c.twisted < c.closed - 300));
}

TEMPLATE_TEST_CASE("single precision: dashpots of springs that stick, and viscous rolling", "", Linear, Hertz,
                   Power) {
  const auto law = law_of<TestType>(0.2, {.friction = 0.4,
                                          .stiffness_factor = 2.25,
                                          .damping_ratio = 0.3,
                                          .damping = 2,
                                          .twisting_friction = 2});
  const Comparison c = compare(law, {}, 350, 1e-3);
  check_precision<TestType>(c);
  CHECK((c.rolled == 0 && c.twisted == 0));
}

TEST_CASE("single precision: a stiffness of rolling that the deck gives, and one resistance alone") {
  const RollingParameters each[] = {{.friction = 0.2, .stiffness = 40},
                                    {.friction = 0.2, .stiffness_factor = 2.25},
                                    {.damping = 0.3},
                                    {.twisting_friction = 0.3}};
  for (const RollingParameters& p : each) {
    CAPTURE(p.friction, p.damping, p.twisting_friction);
    const Comparison c = compare(law_of<Hertz>(0, p), {}, 6000);
    CHECK(c.moment_difference <= 2e-4 * c.largest_moment + 1e-12);
    CHECK(c.torque_difference < 2e-4 * c.largest_torque);
    for (const LossKind kind : {kRollingLoss, kTwistingLoss}) {
      CAPTURE(kind);
      const Real resistance = kind == kRollingLoss ? p.friction + p.damping : p.twisting_friction;
      CHECK((c.losses_in_single.of[kind] > 0) == (resistance > 0));
      CHECK(near(c.losses_in_single.of[kind], c.losses.of[kind], {.relative = 1e-3, .absolute = 1e-12}));
    }
  }
}

// With tensile damping ("limit_damping = false") the normal force of a fast rebound is negative.
TEST_CASE("single precision: no friction acts while the normal force is tensile") {
  NormalLawParameters normal;
  normal.normal_stiffness = 2e5, normal.damping_ratio = 0.5, normal.tension = true;
  using Law = ContactLaw<LinearRestitutionLaw, LinearSlider>;
  const Law law{LinearRestitutionLaw(normal), {6e4, 0.3, 0}};
  const Spheres spheres;
  ContactHistory exact, single;
  Real smallest = 0, largest = 0;
  for (int k = 0; k < 100; ++k) {
    const auto at = [](int step) { return Vec3{0, 0, 0.895 + 5e-5 * step}; };
    const Motion motion{at(k), at(k + 1), {1, 0.5, 0}, {1, 0, 0}};
    const MovingPair pair = exact_pair(spheres, motion, kStep);
    if (!(pair.geometry.overlap > 0)) break;
    const ContactOutcome outcome = law.respond(pair, exact);
    const auto in_single = single_load(law, pair_in_single(spheres, motion, kStep), single);
    exact = outcome.history, single = in_single.history;
    smallest = std::min(smallest, outcome.load.force.z), largest = std::max(largest, norm(exact.spring));
    CHECK(norm(in_double(in_single.torque_i) - outcome.load.torque_i) < 2e-2);
    CHECK(norm(single.spring - exact.spring) < 2e-2);
  }
  CHECK(smallest < 0);
  CHECK(largest > 10);
}

// The squares of their moments cannot be represented in single precision.
TEST_CASE("single precision: particles of 5 um slide at the limits of rolling and twisting") {
  Spheres fine;
  fine.radius_i = fine.radius_j = 5e-6, fine.density = 2500;
  ContactHistory history;
  const auto law = law_of<Hertz>(0, {.friction = 0.2, .stiffness_factor = 2.25, .twisting_friction = 0.3});
  constexpr Real kShort = 1e-7;
  Real limits[2] = {}, load = 0;
  for (int k = 0; k < 4000; ++k) {
    const Vec3 at{0, 0, 1e-5 - 1e-12};
    const Motion motion{at, at, {20, 0, 10}, {}};
    const SinglePair pair = pair_in_single(fine, motion, kShort);
    const auto outcome = single_load(law, pair, history);
    history = outcome.history;
    load = dot(in_double(outcome.force), Vec3{0, 0, 1});
    const auto d = static_cast<Real>(pair.geometry.overlap);
    limits[0] = 0.2 * fine.effective_radius() * load;
    limits[1] = Real(2) / 3 * std::sqrt(fine.effective_radius() * d) * 0.3 * load;
  }
  CHECK(limits[0] * limits[0] < 1e-38);  // below the smallest normal number
  CHECK(near(history.moment.x, limits[0], {.relative = 1e-5}));
  CHECK(near(history.moment.z, limits[1], {.relative = 1e-5}));
}

// The increments are below the last bit of the moment in single precision.
TEST_CASE("single precision: moments grow by the smallest rotations, and stay without any") {
  const Spheres spheres;
  const auto law = law_of<Linear>(0, {.friction = 0.4, .stiffness_factor = 2.25, .twisting_friction = 0.3});
  const Vec3 at{0, 0, 0.89};
  ContactHistory exact, single;
  const auto rotate = [&](Vec3 spin, int steps) {
    for (int k = 0; k < steps; ++k) {
      const Motion motion{at, at, spin, {}};
      exact = law.respond(exact_pair(spheres, motion, kStep), exact).history;
      single = single_load(law, pair_in_single(spheres, motion, kStep), single).history;
    }
  };
  rotate({0.5, 0.2, 0.3}, 20);
  const ContactHistory before = single, exact_before = exact;
  rotate({}, 1000);
  CHECK(single.moment == before.moment);
  rotate({1e-9, 0, 1e-9}, 100000);
  const Vec3 grown = single.moment - before.moment;
  CHECK((std::abs(grown.x) > 0 && std::abs(grown.x) < 1e-5 * norm(before.moment)));
  CHECK(near(grown, exact.moment - exact_before.moment, {.relative = 1e-4}));
  rotate({-1e-9, 0, -1e-9}, 100000);
  CHECK(near(single.moment, before.moment, {.relative = 1e-9}));
}

// A moment in single precision would lose what it holds.
TEST_CASE("single precision: a sphere that rolling resistance holds on top of another one does not creep") {
  Spheres spheres;
  const auto law = law_of<Linear>(
      0.3, {.friction = 0.5, .stiffness_factor = 2.25, .damping_ratio = 0.3, .twisting_friction = 0.3});
  const Real mass = spheres.mass(spheres.radius_i), inertia = spheres.partner({}, spheres.radius_i).inertia;
  Vec3 position{0.06, 0.02, 0.8976}, velocity, spin;
  ContactHistory history;
  const auto take_steps = [&](int steps) {
    for (int k = 0; k < steps; ++k) {
      const Vec3 start = position;
      position += kStep * velocity;
      const auto load =
          single_load(law, pair_in_single(spheres, {start, position, spin, {}}, kStep), history);
      history = load.history;
      velocity += (kStep / mass) * (in_double(load.force) - Vec3{0, 0, mass});
      spin += (kStep / inertia) * in_double(load.torque_i);
    }
  };
  take_steps(200000);
  const Vec3 settled = position;
  CHECK(norm(Vec3{settled.x, settled.y, 0}) > 0.05);  // held beside the top
  CHECK(norm(history.moment) > 0);
  take_steps(1000000);
  CHECK(norm(position - settled) < 1e-7);
}

TEST_CASE("single precision: both partners have mirrored histories and the same losses") {
  const auto law = law_of<Hertz>(0.2, {.friction = 0.2,
                                       .stiffness_factor = 2.25,
                                       .damping_ratio = 0.3,
                                       .damping = 0.1,
                                       .twisting_friction = 0.3});
  const Spheres spheres, swapped{spheres.radius_j, spheres.radius_i, spheres.density};
  ContactHistory of_i, of_j;
  int closed = 0;
  for (int k = 0; k < 3000; ++k) {
    const Motion m = motion_at(spheres, k);
    const SinglePair pair = pair_in_single(spheres, m, kStep);
    if (!(pair.geometry.overlap > 0)) continue;
    const auto i = single_load(law, pair, of_i);
    const auto j =
        single_load(law, pair_in_single(swapped, {-m.start, -m.end, m.spin_j, m.spin_i}, kStep), of_j);
    of_i = i.history, of_j = j.history, ++closed;
    REQUIRE(of_j.moment == opposite(of_i.moment));
    REQUIRE(of_j.spring == opposite(of_i.spring));
    for (int kind = 0; kind < kLossKinds; ++kind) REQUIRE(i.losses[kind] == j.losses[kind]);
  }
  CHECK(closed > 1000);
}

}  // namespace scree
