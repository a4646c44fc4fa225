// Contact kinematics and the transport of histories: symmetry, lengths, rigid rotations, momentum.
#include "physics/contact_motion.hpp"

#include "physics/normal_laws.hpp"
#include "physics/orientation.hpp"
#include "physics/rolling_laws.hpp"
#include "physics/tangential_laws.hpp"
#include "random_contact.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/reference_table.hpp"

namespace scree {

namespace {

// Rotation of a body at constant angular velocity after this time.
Quaternion turned_in(Vec3 omega, Real time) {
  const Real half = norm(omega) * time / 2, s = std::sin(half) / norm(omega);
  return {std::cos(half), s * omega.x, s * omega.y, s * omega.z};
}

constexpr Real kRoundOff = 64 * kUlp;
constexpr int kCases = 1000;

using Law = ContactLaw<LinearLaw, MindlinSlider, RollingAndTwisting<ElasticPlasticRolling, MarshallTwisting>>;

Law all_laws() { return {LinearLaw(100, 3, false), {40, 0.4, 0.2}, {{0.2, 0.3, 2.25, 0}, {0.4}}}; }

Vec3 vector(const ReferenceTable::Row& row, const std::string& name) {
  return {row[name + "x"], row[name + "y"], row[name + "z"]};
}

}  // namespace

TEST_CASE("both sides of a pair see the same contact, odd or even, to the last bit") {
  RandomNumbers random;
  for (int k = 0; k < kCases; ++k, random.vector()) {
    const RandomContact one = contact_of(random, 0.05, false), other = contact_of(random, 0.05, true);
    const ContactMotion &a = one.pair.motion, &b = other.pair.motion;
    CHECK((a.normal0 == -b.normal0 && a.normal1 == -b.normal1 && a.overlap0 == b.overlap0));
    CHECK((a.slip == -b.slip && a.rolling == -b.rolling));
    CHECK((a.twisting == b.twisting && a.turn == -b.turn && a.lever_arm_ratio == b.lever_arm_ratio));
    const ContactOutcome f = all_laws().respond(one.pair, one.history);
    const ContactOutcome g = all_laws().respond(other.pair, other.history);
    CHECK((f.load.force == -g.load.force && f.load.loss == g.load.loss));
    CHECK((f.load.torque_i == g.load.torque_j && f.load.torque_j == g.load.torque_i));
    CHECK((f.history.spring == -g.history.spring && f.history.moment == -g.history.moment));
    CHECK(f.friction.sum() == g.friction.sum());
  }
}

TEST_CASE("a contact gives no linear and no angular momentum") {
  RandomNumbers random;
  for (int k = 0; k < kCases; ++k, random.vector()) {
    const RandomContact c = contact_of(random, 0.05, false);
    const ContactOutcome out = all_laws().respond(c.pair, c.history);
    // The forces are opposite; their moment about j, and both torques:
    const Vec3 moment =
        cross(c.pair.geometry.direction, out.load.force) + out.load.torque_i + out.load.torque_j;
    CHECK(norm(moment) <= kRoundOff * norm(out.load.force) * c.pair.geometry.distance);
  }
}

TEST_CASE("the power of force and torques is that of the spring over the slip") {
  RandomNumbers random;
  constexpr Real h = 1e-8;  // so short that nothing rotates
  for (int k = 0; k < kCases; ++k, random.vector()) {
    const RandomContact c = contact_of(random, h, false);
    const ContactLaw<LinearLaw, LinearSlider> law{LinearLaw(100, 0, false), {40, 1e9, 0}};
    const ContactOutcome out = law.respond(c.pair, c.history);
    const Real power = dot(out.load.force, c.pair.velocity) + dot(out.load.torque_i, c.spin_i) +
                       dot(out.load.torque_j, c.spin_j);
    const Real normal_power = -100 * c.pair.geometry.overlap * c.pair.geometry.rate(c.pair.velocity);
    CHECK(
        near(power - normal_power, -dot(out.history.spring, c.pair.motion.slip) / h, {.absolute = 200 * h}));
  }
}

TEST_CASE("a transported history keeps its length, and its part along the normal") {
  RandomNumbers random;
  for (int k = 0; k < kCases; ++k, random.vector()) {
    const RandomContact c = contact_of(random, 0.05, false);
    const Vec3 spring = rotated_tangential(c.pair.motion, c.history.spring),
               moment = rotated_with(c.pair.motion, c.history.moment);
    CHECK(near(norm(spring), norm(c.history.spring), {.relative = kRoundOff}));
    CHECK(std::abs(dot(spring, c.pair.motion.normal1)) <= kRoundOff * norm(spring));
    CHECK(near(norm(moment), norm(c.history.moment), {.relative = kRoundOff}));
    CHECK(near(dot(moment, c.pair.motion.normal1), dot(c.history.moment, c.pair.motion.normal0),
               {.absolute = kRoundOff}));
    const Vec3 same = rotated_with(c.pair.motion, c.history.spring);
    CHECK(near(same, spring, {.relative = kRoundOff}));
  }
}

TEST_CASE("a pair that rotates rigidly takes its spring along, to second order") {
  const ReferenceTable table("contact/spring_turned_rigidly.csv");
  for (const auto& row : table.rows()) {
    const Vec3 omega = vector(row, "Om"), n = vector(row, "n"), xi = vector(row, "xi");
    const auto error_after = [&](int steps) {
      const Real h = row["t"] / steps, radius[2] = {0.02, 0.03}, reach = radius[0] + radius[1];
      const RotatingPartner i{omega, radius[0], 1}, j{omega, radius[1], 1};
      Vec3 r = Real(0.99) * reach * vector(row, "n0"), spring = vector(row, "xi0"), slip{};
      for (int k = 0; k < steps; ++k) {
        const Vec3 half = r + (h / 2) * cross(omega, r);  // the midpoint rule, kept at its length
        const Vec3 raw = r + h * cross(omega, half), next = (norm(r) / norm(raw)) * raw;
        const ContactMotion c = sphere_motion(sphere_pair(next, reach), next - r, i, j, h);
        spring = rotated_tangential(c, spring), slip += c.slip;
        r = next;
      }
      CHECK(norm(slip) <= 10 * reach / (static_cast<Real>(steps) * steps));
      CHECK(norm((1 / norm(r)) * r - n) <= 100.0 / (static_cast<Real>(steps) * steps));
      return norm(spring - xi) / norm(xi);
    };
    const Real coarse = error_after(200), fine = error_after(400);
    CAPTURE(coarse, fine);
    CHECK(fine < 1e-3);
    CHECK((coarse / fine > 3.7 && coarse / fine < 4.3));
  }
}

TEST_CASE("a sphere that rotates with the face it lies on keeps its spring, and does not slip") {
  const Vec3 omega{0.4, -1.1, 0.7};
  const Real radius = 0.02;
  const auto error_after = [&](int steps) {
    const Real h = 1.0 / steps;
    Vec3 n{0, 0, 1}, spring{0.3, 0.5, 0}, slip{};
    const Quaternion whole = turned_in(omega, 1), part = turned_in(omega, h);
    for (int k = 0; k < steps; ++k) {
      const Vec3 next = rotated(part, n), middle = Real(0.5) * (n + next);
      // The centre's velocity over that of the face's point under it.
      const Vec3 displacement = h * cross(omega, radius * middle);
      const ContactGeometry geometry{0, radius, next, 1};
      const ContactMotion c = face_motion(geometry, n, displacement, {omega, radius, 1}, {omega}, h);
      spring = rotated_tangential(c, spring), slip += c.slip;
      n = next;
    }
    CHECK(norm(slip) <= 10 * kUlp);
    return norm(spring - rotated(whole, {0.3, 0.5, 0}));
  };
  const Real coarse = error_after(50), fine = error_after(100);
  CHECK(fine < 1e-4);
  CHECK(near(coarse / fine, 4, {.absolute = 0.1}));
}

}  // namespace scree
