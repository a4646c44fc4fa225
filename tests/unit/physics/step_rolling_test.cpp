// Rolling and twisting resistance over an implicit step: energy, derivatives, exchange of the partners.
#include "physics/step_rolling.hpp"

#include "physics/normal_laws.hpp"
#include "physics/tangential_laws.hpp"
#include "random_contact.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

using Law = ContactLaw<LinearRestitutionLaw, LinearSlider, AnyRolling>;

constexpr Real kStep = 1e-3, kStiffness = 1e5, kReach = 1e-4;  // [s], [N/m], [m]
constexpr int kCases = 20000;

Vec3 unit(Vec3 a) { return (1 / norm(a)) * a; }

Law law_with(Real viscous) {
  NormalLawParameters normal{};
  normal.normal_stiffness = kStiffness;
  Law law;
  law.normal = LinearRestitutionLaw(normal);
  law.tangential = {8e4, 0.5, 0.2};
  law.rolling = AnyRolling::of({0.2, 2.25, 0, 0.3, viscous, 0.4});
  return law;
}

// A contact over a step, with a moment at its start of the order of the limits.
struct RandomRolling {
  FrictionStep step{};
  RelativeSpins spins;
  Vec3 moment, relative;  // [N m], relative rotation over the step [rad]
};

RandomRolling random_rolling(RandomNumbers& random, const Law& law, bool lasts) {
  RandomRolling out;
  const Real R = 0.02, mass = 0.1, inertia = 0.4 * mass * R * R;
  const Vec3 n = unit(random.vector());
  const Real d0 = kReach * (lasts ? 1.5 + random() : random()),
             d1 = kReach * (lasts ? 1.5 + random() : random());
  const Real turned = 0.02 * random();
  out.relative = turned * random.vector();
  const RotatingPartner i{(1 / kStep) * out.relative, R, inertia}, j{{}, R, inertia};
  out.step.motion = contact_motion(n, n, kReach * random.vector(), i, j, kStep);
  out.step.motion.overlap0 = d0;
  out.step.step = {d0, 0, d1, 0, kStep};
  out.step.size = {R, R, mass, mass}, out.step.lever_arm_ratio0 = 1, out.step.lagged_limit = -1;
  const auto normal = law.normal.of_pair(out.step.size);
  out.step.start_force = start_force(normal, out.step.step);
  out.step.end_force = d1 > 0 ? normal.elastic(d1) : 0;
  out.step.step_force = step_contact_force(normal, out.step.step).force;
  out.spins = {100 * random.vector(), 100 * random.vector()};
  if (d0 > 0) out.moment = (0.05 * (1 + random())) * R * kStiffness * d0 * random.vector();
  return out;
}

}  // namespace

TEST_CASE("over an implicit step rolling and twisting never give energy, and their balance closes") {
  RandomNumbers random;
  const Law law = law_with(0);
  int slid = 0, twisted = 0;
  for (int k = 0; k < kCases; ++k) {
    const RandomRolling c = random_rolling(random, law, k % 2 == 0);
    const StepRolling out = step_rolling(law, c.step, c.spins, c.moment);
    if (!(c.step.step.overlap0 > 0 || c.step.step.overlap1 > 0)) continue;
    // The trapezoidal rule gives the work of the mean moment: the normal does not rotate here, but the moment
    // rotates with the mean spin about it.
    const Vec3 rotated = rotated_with(c.step.motion, out.start);
    const Vec3 rotation = c.step.motion.rolling + c.step.motion.twisting * c.step.motion.normal1;
    const Real work = Real(0.5) * dot(rotated + out.step, rotation);
    const Real lost = out.rolling_losses.sum() + out.twisting_losses.sum();
    const Real scale = std::abs(work) + out.stored0 + out.stored1 + 1e-12;
    REQUIRE(near(work, out.stored1 - out.stored0 + lost, {.absolute = 1e-12 * scale}));
    REQUIRE(lost >= -1e-12 * scale);
    slid += norm(out.direction) > 0, twisted += out.twisting_load_slope != 0;
  }
  CHECK((slid > kCases / 20 && twisted > kCases / 20));
}

TEST_CASE("the derivatives of the moment over a step are those of differences") {
  RandomNumbers random;
  for (const Real viscous : {0.0, 1e-4}) {
    const Law law = law_with(viscous);
    for (int k = 0; k < 2000; ++k) {
      const RandomRolling c = random_rolling(random, law, true);
      const StepRolling at = step_rolling(law, c.step, c.spins, c.moment);
      if (viscous > 0 && norm(at.direction) == 0 && at.rolling_losses.sliding != 0) continue;
      const Vec3 n = c.step.motion.normal1, along = unit(tangential_part(random.vector(), n));
      const Real difference = 1e-9;
      const auto moved = [&](Real by) {
        RandomRolling other = c;
        other.step.motion.rolling += by * along, other.step.motion.twisting += by;
        return step_rolling(law, other.step, other.spins, other.moment);
      };
      const StepRolling plus = moved(difference), minus = moved(-difference);
      if (norm(plus.direction - minus.direction) > 0.5 ||
          (plus.twisting_load_slope != 0) != (minus.twisting_load_slope != 0))
        continue;  // a kink between the two
      const Vec3 by_difference = (1 / (2 * difference)) * (plus.step - minus.step);
      const Vec3 expected = at.rolling * (along - dot(at.direction, along) * at.direction) + at.twisting * n;
      REQUIRE(near(by_difference, expected, {.absolute = 1e-3 * (at.rolling + at.twisting) + 1e-6}));
    }
  }
}

TEST_CASE("the limits of rolling and twisting follow the normal force of the step, or are lagged with it") {
  constexpr Real kDifference = 1e-5;  // [N]
  RandomNumbers random;
  const Law law = law_with(0);
  for (int k = 0; k < 2000; ++k) {
    RandomRolling c = random_rolling(random, law, true);
    const StepRolling at = step_rolling(law, c.step, c.spins, c.moment);
    const Real load = Real(0.5) * (c.step.start_force + c.step.step_force);
    const auto more = [&](Real by) {
      RandomRolling other = c;
      other.step.step_force += by;
      return step_rolling(law, other.step, other.spins, other.moment).step;
    };
    const Vec3 n = c.step.motion.normal1,
               slope = (0.5 / kDifference) * (more(kDifference) - more(-kDifference)),
               expected = at.rolling_load_slope * at.direction + at.twisting_load_slope * n;
    // The scaling of the moment at the start to the limit there has no derivative.
    if (norm(c.moment) < 0.002 * c.step.size.radius_i * load)
      REQUIRE(near(slope, expected, {.absolute = 0.05 * norm(expected) + 1e-8}));
    c.step.lagged_limit = load;
    const StepRolling lagged = step_rolling(law, c.step, c.spins, c.moment);
    REQUIRE((lagged.rolling_load_slope == 0 && lagged.twisting_load_slope == 0));
    const Vec3 mean = Real(0.5) * (lagged.step + rotated_with(c.step.motion, lagged.start));
    REQUIRE(norm(tangential_part(mean, n)) <= 0.2 * 0.01 * load * (1 + 1e-12));
  }
}

TEST_CASE("the moment over a step changes its sign with the exchange of the partners") {
  RandomNumbers random;
  const Law law = law_with(1e-4);
  for (int k = 0; k < 2000; ++k) {
    const RandomRolling c = random_rolling(random, law, k % 2 == 0);
    RandomRolling other = c;
    ContactMotion& m = other.step.motion;
    m.normal0 = -m.normal0, m.normal1 = -m.normal1, m.slip = -m.slip, m.rolling = -m.rolling;
    m.turn = -m.turn;
    other.moment = -c.moment, other.spins = {-c.spins.start, -c.spins.end};
    const StepRolling a = step_rolling(law, c.step, c.spins, c.moment),
                      b = step_rolling(law, other.step, other.spins, other.moment);
    REQUIRE((a.start == -b.start && a.step == -b.step && a.end == -b.end && a.spring == -b.spring));
    REQUIRE((a.rolling == b.rolling && a.twisting == b.twisting));
  }
}

}  // namespace scree
