// Hertz's law: its force and energy, and its damper over parts of a contact.
#include <cmath>
#include <limits>

#include "physics/contact_losses.hpp"
#include "physics/step_limits.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 8 * kUlp;
constexpr Real kTruncation = 1e-9;  // of central differences over 1e-6, and their round-off, relative
constexpr int kParts = 200000;      // of a path that is integrated
constexpr Real kInfinite = std::numeric_limits<Real>::infinity();
constexpr Real kStep = 1e-4, kReach = 1e-4;  // [s], [m]

// Two spheres of 1 and 3 cm with E* = 1e9 Pa: R* = 7.5 mm, m* = 0.075 kg.
constexpr PairSize kSize{0.01, 0.03, 0.1, 0.3};
const Real kStiffness = 4e9 / 3 * std::sqrt(0.0075);  // K [N/m^1.5]

HertzPairOf<Real> hertz(Real damping_ratio, bool tension = false, const PairSize& size = kSize) {
  return HertzLaw(NormalLawParameters{0, 0, 1, tension, 1e9, damping_ratio}).of_pair(size);
}

Real damping(Real damping_ratio) { return 2 * damping_ratio * std::sqrt(1.25 * 0.075 * kStiffness); }

const HertzPairOf<Real> kLaws[] = {hertz(0), hertz(0.2), hertz(1.1), hertz(0.2, true)};

ContactStep step_between(Real overlap0, Real overlap1, Real rate0) {
  return {overlap0, rate0, overlap1, 2 * (overlap1 - overlap0) / kStep - rate0, kStep};
}

}  // namespace

TEST_CASE("Hertz's force is 4/3 E* sqrt(R*) d^1.5 and a damper of c d^0.25") {
  for (const Real d : {1e-9, 1e-5, 1e-3})
    for (const Real rate : {-0.01, 0.0, 2.0}) {
      CAPTURE(d, rate);
      const ContactForce f = contact_force(hertz(0.2, true), d, rate);
      const Real elastic = kStiffness * std::pow(d, 1.5), damper = damping(0.2) * std::pow(d, 0.25);
      CHECK(near(f.force, elastic + damper * rate, {.absolute = kRoundOff * (elastic + damper)}));
      CHECK(near(f.stiffness, 1.5 * kStiffness * std::sqrt(d), {.relative = kRoundOff}));
      CHECK(near(f.damping, damper, {.relative = kRoundOff}));
      CHECK(near(f.loss, damper * rate * rate, {.relative = kRoundOff}));
      const Real step = 1e-6 * d;
      const auto energy = [](Real overlap) { return hertz(0).energy(overlap); };
      CHECK(near((energy(d + step) - energy(d - step)) / (2 * step), elastic, {.relative = kTruncation}));
    }
}

TEST_CASE("against a wall Hertz's law takes the sphere's own radius and mass") {
  const PairSize wall{0.0075, kInfinite, 0.075, kInfinite};
  for (const Real d : {1e-5, 1e-3}) {
    CHECK(near(hertz(0.2, false, wall).elastic(d), hertz(0.2).elastic(d), {.relative = kRoundOff}));
    CHECK(near(hertz(0.2, false, wall).damping(d), hertz(0.2).damping(d), {.relative = kRoundOff}));
  }
}

TEST_CASE("Hertz's law is the same from both sides, to the bit, and gives nothing at an overlap of 0") {
  const PairSize other{kSize.radius_j, kSize.radius_i, kSize.mass_j, kSize.mass_i};
  for (const Real d : {1e-5, 1.234e-4}) {
    const ContactForce a = contact_force(hertz(0.2), d, 0.3),
                       b = contact_force(hertz(0.2, false, other), d, 0.3);
    CHECK((a.force == b.force && a.loss == b.loss));
  }
  const ContactForce touch = contact_force(hertz(0.2), Real(0), Real(1));
  CHECK((touch.force == 0 && touch.stiffness == 0 && touch.damping == 0 && touch.loss == 0));
}

TEST_CASE("in single precision Hertz's law is the same to its digits") {
  const PairSizeOf<float> size{0.01f, 0.03f, 0.1f, 0.3f};
  const auto single = HertzLaw(NormalLawParameters{0, 0, 1, false, 1e9, 0.2}).as<float>().of_pair(size);
  const ContactForceOf<float> f = contact_force(single, 1e-4f, 0.5f);
  CHECK(near(f.force, contact_force(hertz(0.2), 1e-4, 0.5).force, {.relative = 1e-6}));
}

TEST_CASE("the mean damping is the integral over the overlaps between two") {
  const auto law = hertz(0.2);
  for (const auto& [from, to] : {std::pair{0.0, 1e-4}, {2e-5, 1e-4}, {9.9e-5, 1e-4}, {1e-12, 1e-3}}) {
    CAPTURE(from, to);
    const Real exact = damping(0.2) * 0.8 * (std::pow(to, 1.25) - std::pow(from, 1.25)) / (to - from);
    CHECK(near(law.mean_damping(from, to), exact, {.relative = 1e-13}));
    CHECK(near(law.mean_damping(to, from), exact, {.relative = 1e-13}));
  }
  CHECK(near(law.mean_damping(1e-4, 1e-4), law.damping(1e-4), {.relative = kRoundOff}));
  CHECK(law.mean_damping(0, 0) == 0);
}

TEST_CASE("a contact that parts evenly is cut where its force is zero") {
  const auto law = hertz(0.2);
  for (const Real share : {1e-12, 0.01, 0.5, 0.999}) {
    CAPTURE(share);
    const Real pull = share * law.elastic(kReach), rate = -pull / law.damping(kReach);
    const Real cut = law.cut(kReach, pull);
    CHECK(near(law.elastic(cut), -law.damping(cut) * rate, {.relative = 4 * kRoundOff}));
  }
  CHECK(law.cut(kReach, 0) == 0);
}

TEST_CASE("over a step Hertz's force is continuous at touch, and its work is that of law and damper") {
  for (const auto& law : kLaws) {
    CAPTURE(law.damping_factor, law.tension);
    for (const Real share : {1e-9, 1e-3, 1.0}) {  // fractions of kReach, after a gap
      CAPTURE(share);
      const ContactStep c = step_between(-0.5 * kReach, share * kReach, 2);
      const StepContactForce f = step_contact_force(law, c);
      const Real displacement = c.overlap1 - c.overlap0;
      const Real work = law.energy(c.overlap1) + step_dissipation(law, c);
      CHECK(near(f.force * displacement / 2, work, {.relative = kRoundOff}));
      ContactStep up = c, down = c;
      up.overlap1 *= 1 + 1e-6, down.overlap1 *= 1 - 1e-6;
      const Real slope = (step_contact_force(law, up).force - step_contact_force(law, down).force) /
                         (up.overlap1 - down.overlap1);
      CHECK(near(f.stiffness, slope, {.relative = kTruncation}));
      CHECK((f.stiffness > 0 && f.stiffness < 1e12));
    }
    CHECK(step_contact_force(law, step_between(-0.5 * kReach, 1e-20, 2)).force < 1e-9);
  }
}

TEST_CASE("the dissipation of a Hertz contact over a straight step is its loss along the path") {
  for (const auto& law : kLaws)
    for (const Real overlap0 : {-kReach, 0.0, 0.2 * kReach, kReach})
      for (const Real overlap1 : {-kReach, 0.0, 0.3 * kReach, kReach}) {
        CAPTURE(law.damping_factor, law.tension, overlap0, overlap1);
        const Real displacement = overlap1 - overlap0, rate = displacement / kStep;
        Real sum = 0;
        for (int k = 0; k < kParts; ++k) {
          const Real d = overlap0 + (k + 0.5) / kParts * displacement;
          if (d > 0) sum += contact_force(law, d, rate).loss * kStep / kParts;
        }
        const Real dissipated = straight_dissipation(law, {overlap0, rate, overlap1, rate, kStep});
        CHECK(near(dissipated, sum, {.relative = 2.0 / kParts}));
        CHECK((law.damping_factor > 0 ? dissipated >= 0 : dissipated == 0));
      }
}

TEST_CASE("a pair that does not act has no force under Hertz's law") {
  const auto nothing = HertzLaw(NormalLawParameters{}).of_pair(kSize);
  CHECK(contact_force(nothing, kReach, Real(-1)).force == 0);
  for (const ContactStep& c : {step_between(-kReach, kReach, 1), step_between(kReach, -kReach, -1),
                               step_between(kReach, 0.5 * kReach, 1)}) {
    CHECK(step_contact_force(nothing, c).force == 0);
    CHECK(step_dissipation(nothing, c) == 0);
  }
}

TEST_CASE("which laws take which parameters, and what estimates see of them") {
  const NormalLawParameters linear{1e4, 3}, power{1e4, 3, 1.5}, none{}, modulus{0, 0, 1, true, 1e9, 0.2};
  CHECK((LinearLaw::accepts(linear) && !HertzLaw::accepts(linear)));
  CHECK((PowerLaw::accepts(power) && !LinearLaw::accepts(power) && !HertzLaw::accepts(power)));
  CHECK((HertzLaw::accepts(modulus) && !LinearLaw::accepts(modulus) && !PowerLaw::accepts(modulus)));
  CHECK((HertzLaw::accepts(none) && LinearLaw::accepts(none)));
  CHECK((modulus.acts() && linear.acts() && !none.acts()));
  const NormalLawParameters sized = law_of_size(modulus, kSize);
  CHECK(near(sized.normal_stiffness, kStiffness, {.relative = kRoundOff}));
  CHECK((sized.exponent == 1.5 && sized.tension));
  CHECK(near(sized.normal_damping, damping(0.2) * std::pow(1e-4, 0.25), {.relative = kRoundOff}));
  CHECK(near(typical_stiffness(modulus, kSize), 1.5 * kStiffness * 1e-2, {.relative = kRoundOff}));
}

}  // namespace scree
