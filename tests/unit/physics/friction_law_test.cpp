// Laws with friction and rolling: their histories, limits and moments, their energy.
#include <array>

#include "physics/cohesion.hpp"
#include "physics/contact_law.hpp"
#include "physics/rolling_laws.hpp"
#include "physics/tangential_laws.hpp"
#include "random_contact.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 64 * kUlp;
constexpr int kCases = 1000;

using RollingOnly = RollingAndTwisting<ElasticPlasticRolling>;
using TwistingOnly = RollingAndTwisting<FreeRolling, MarshallTwisting>;
using Both = RollingAndTwisting<ElasticPlasticRolling, MarshallTwisting>;
using Drag = RollingAndTwisting<ViscousRolling>;

template <class Law>
ContactHistory written_and_read(const ContactHistory& history) {
  std::array<Real, 7> numbers{};
  Law::write_history(history, [&](int k, Real value) { numbers.at(static_cast<std::size_t>(k)) = value; });
  return Law::read_history([&](int k) { return numbers.at(static_cast<std::size_t>(k)); });
}

// Component of a moment along the normal.
Real twisting_moment(Vec3 moment, const ContactMotion& c) { return dot(moment, c.normal1); }

}  // namespace

TEST_CASE("the history of a law, and its order in files") {
  static_assert(ContactLaw<LinearLaw>::kHistory == 0 && !ContactLaw<LinearLaw>::kNeedsMotion);
  static_assert(ContactLaw<LinearLaw, LinearSlider>::kHistory == 3);
  static_assert(ContactLaw<LinearLaw, Frictionless, RollingOnly>::kHistory == 3);
  static_assert(ContactLaw<HertzLaw, MindlinSlider, Both>::kHistory == 6);
  static_assert(ContactLaw<HertzLaw, MindlinSlider, Drag>::kHistory == 3);
  static_assert(ContactLaw<JkrLaw, MindlinSlider, Both>::kHistory == 7);
  static_assert(ContactLaw<LinearLaw, Frictionless, Drag>::kHistory == 0);
  static_assert(ContactLaw<LinearLaw, Frictionless, Drag>::kNeedsMotion);
  const ContactHistory all{{1, 2, 3}, {4, 5, 6}, true};
  const ContactHistory seven = written_and_read<ContactLaw<JkrLaw, MindlinSlider, Both>>(all);
  CHECK((seven.spring == all.spring && seven.moment == all.moment && seven.touched));
  const ContactHistory moment = written_and_read<ContactLaw<LinearLaw, Frictionless, RollingOnly>>(all);
  CHECK((moment.spring == Vec3{} && moment.moment == all.moment && !moment.touched));
  const ContactHistory jkr = written_and_read<ContactLaw<JkrLaw>>(all);
  CHECK((jkr.spring == Vec3{} && jkr.moment == Vec3{} && jkr.touched));
}

TEST_CASE("a contact that opens loses its history, and a force that is cut holds nothing") {
  RandomNumbers random;
  RandomContact c = contact_of(random, 0.05, false);
  const ContactLaw<LinearLaw, LinearSlider, Both> law{
      LinearLaw(100, 0, false), {40, 0.4, 0.2}, {{0.2, 0.3, 2.25, 0}, {0.4}}};
  c.pair.geometry.overlap = -1e-9;
  const ContactOutcome open = law.respond(c.pair, c.history);
  CHECK((open.load.force == Vec3{} && open.load.torque_i == Vec3{} && open.history.spring == Vec3{}));
  c = contact_of(random, 0.05, false);
  const Real parting = 2 * 100 * c.pair.geometry.overlap;  // the force of a damping of 1 at separation
  c.pair.velocity =
      c.pair.velocity + (parting + c.pair.geometry.rate(c.pair.velocity)) * c.pair.geometry.normal();
  ContactLaw<LinearLaw, LinearSlider, Both> damped = law;
  damped.normal = LinearLaw(100, 1, false);
  const ContactOutcome cut = damped.respond(c.pair, c.history);
  CHECK((cut.load.force == Vec3{} && cut.history.spring == Vec3{} && cut.history.moment == Vec3{}));
}

TEST_CASE("forces and moments stay within their limits") {
  RandomNumbers random;
  const Real mu = 0.4, mu_roll = 0.2;
  const ContactLaw<HertzLaw, MindlinSlider, Both> law{
      HertzLaw(100, 0.5, false), {40, mu, 0.2}, {{mu_roll, 0.3, 2.25, 0}, {mu}}};
  for (int k = 0; k < kCases; ++k, random.vector()) {
    const RandomContact c = contact_of(random, 0.05, false);
    const ContactOutcome out = law.respond(c.pair, c.history);
    const Vec3 n = c.pair.motion.normal1;
    const Real normal = dot(out.load.force, n), d = c.pair.geometry.overlap;
    CHECK(norm(tangential_part(out.load.force, n)) <= mu * normal * (1 + kRoundOff));
    // The torque beyond that of friction is the rolling law's.
    const Vec3 moment = out.history.moment;
    const Real radius = c.pair.size.effective_radius(), a = std::sqrt(radius * d);
    CHECK(norm(tangential_part(moment, n)) <= mu_roll * radius * normal * (1 + kRoundOff));
    CHECK(std::abs(twisting_moment(moment, c.pair.motion)) <=
          Real(2) / 3 * a * mu * normal * (1 + kRoundOff));
  }
}

TEST_CASE("rolling and twisting springs take their stiffness from the contact") {
  RandomNumbers random;
  for (int k = 0; k < kCases; ++k, random.vector()) {
    RandomContact c = contact_of(random, 1e-3, false);
    c.pair.motion.overlap0 = c.pair.geometry.overlap;  // nothing grows or shrinks
    const Real radius = c.pair.size.effective_radius(), a = std::sqrt(radius * c.pair.geometry.overlap);
    // Limits that are never reached.
    const ContactLaw<HertzLaw, MindlinSlider, Both> law{
        HertzLaw(100, 0, false), {40, 1e6, 0}, {{1e-2, 0, 2.25, 0}, {1e6}}};
    const ContactOutcome out = law.respond(c.pair, {});
    const Real rolling = 2.25 * (1.5 * 100 * a) * 1e-4 * radius * radius;
    CHECK(near(tangential_part(out.history.moment, c.pair.motion.normal1), rolling * c.pair.motion.rolling,
               {.absolute = 1e-12 * norm(out.history.moment)}));
    CHECK(near(twisting_moment(out.history.moment, c.pair.motion),
               8 * 40 * a * a * a / 2 * c.pair.motion.twisting,
               {.absolute = 1e-12 * norm(out.history.moment)}));
    const Real friction_energy = dot(out.history.spring, out.history.spring) / (2 * 8 * 40 * a),
               rolls = rolling / 2 * dot(c.pair.motion.rolling, c.pair.motion.rolling) +
                       8 * 40 * a * a * a / 4 * c.pair.motion.twisting * c.pair.motion.twisting,
               energy = friction_energy + rolls;
    const SpringEnergies springs = law.springs_of(c.pair, out.history);
    CHECK(near(springs.friction, friction_energy, {.relative = 1e-12}));
    CHECK(near(springs.rolling, rolls, {.relative = 1e-12}));
    CHECK(springs.sum() == springs.friction + springs.rolling);
    // From rest and without losses, it is the work of the springs.
    CHECK(std::abs(out.friction.sum() + out.rolling.sum()) <= 1e-12 * energy);
  }
  const ElasticPlasticRolling given{0.3, 0, 0, 7};
  CHECK(given.stiffness_at({1, 1, 1, 1}, 1e9) == 7);
}

TEST_CASE("viscous rolling: a moment against the rolling rate that takes its power") {
  RandomNumbers random;
  for (int k = 0; k < kCases; ++k, random.vector()) {
    const RandomContact c = contact_of(random, 1e-9, false);
    const ContactLaw<LinearLaw, Frictionless, Drag> law{LinearLaw(100, 0, false), {}, {{0.7}, {}}};
    const ContactOutcome out = law.respond(c.pair, {});
    const Vec3 rate = tangential_part(c.spin_i - c.spin_j, c.pair.motion.normal1);
    CHECK(near(out.load.torque_i, -0.7 * rate, {.relative = 1e-6}));
    CHECK(out.load.torque_j == -out.load.torque_i);
    CHECK(near(out.load.loss, 0.7 * dot(rate, rate), {.relative = 1e-6}));
  }
}

TEST_CASE("a contact that begins within a step slips over its part of the step") {
  RandomNumbers random;
  RandomContact c = contact_of(random, 1e-3, false);
  c.history = {};
  const ContactLaw<LinearLaw, LinearSlider> law{LinearLaw(100, 0, false), {40, 1e6, 0}};
  c.pair.motion.overlap0 = c.pair.geometry.overlap;
  const Vec3 all = law.respond(c.pair, {}).history.spring;
  c.pair.motion.overlap0 = -3 * c.pair.geometry.overlap;
  CHECK(near(law.respond(c.pair, {}).history.spring, Real(0.25) * all, {.relative = kRoundOff}));
}

}  // namespace scree
