// A contact over a step in which it opens or closes: continuity, energy, derivatives.
#include "physics/step_contact.hpp"

#include <cmath>

#include "physics/normal_laws.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kStep = 1e-3;           // [s]
constexpr Real kReach = 2e-4;          // typical overlap at the start or end of a step [m]
constexpr Real kRoundOff = 16 * kUlp;  // relative
constexpr Real kTruncation = 3e-8;     // of central differences over 1e-6, and their round-off

struct StepLaw {
  const char* name;
  NormalLawParameters law;
  StepContactForce (*over_step)(const NormalLawParameters&, const ContactStep&);
  ContactForce (*at_instant)(const NormalLawParameters&, Real, Real);
  Real (*energy)(const NormalLawParameters&, Real);

  // Elastic energy [J]; 0 without contact.
  Real stored(Real overlap) const { return overlap > 0 ? energy(law, overlap) : 0; }
  // Force at the start of the step [N].
  Real start(const ContactStep& c) const {
    return c.overlap0 > 0 ? at_instant(law, c.overlap0, c.rate0).force : 0;
  }
};

template <class Law>
StepLaw step_law(const char* name, Real stiffness, Real damping, Real exponent, bool tension) {
  return {name,
          {stiffness, damping, exponent, tension},
          [](const NormalLawParameters& p, const ContactStep& c) { return step_contact_force(Law(p), c); },
          [](const NormalLawParameters& p, Real d, Real d_dot) { return contact_force(Law(p), d, d_dot); },
          [](const NormalLawParameters& p, Real d) { return Law(p).energy(d); }};
}

const StepLaw kLaws[] = {
    step_law<LinearLaw>("linear, cut", 1e6, 40, 1, false),
    step_law<LinearLaw>("linear, tension", 1e6, 40, 1, true),
    step_law<PowerLaw>("n = 1.5, cut", 1e8, 40, 1.5, false),
    step_law<PowerLaw>("n = 1.5, tension", 1e8, 40, 1.5, true),
    step_law<LinearLaw>("linear, cut, undamped", 1e6, 0, 1, false),
    step_law<LinearLaw>("linear, tension, undamped", 1e6, 0, 1, true),
    step_law<PowerLaw>("n = 1.5, cut, undamped", 1e8, 0, 1.5, false),
    step_law<PowerLaw>("n = 1.5, tension, undamped", 1e8, 0, 1.5, true),
};

// A step from overlap0 to overlap1 whose rates are consistent with the straight line and the trapezoidal
// rule, as in HHT with hht_alpha = 0: (rate0 + rate1) / 2 = (overlap1 - overlap0) / h.
ContactStep step_between(Real overlap0, Real overlap1, Real rate0) {
  return {overlap0, rate0, overlap1, 2 * (overlap1 - overlap0) / kStep - rate0, kStep};
}

Real slope_by_difference(const StepLaw& law, ContactStep c, Real ContactStep::*variable, Real difference) {
  ContactStep up = c, down = c;
  up.*variable += difference, down.*variable -= difference;
  return (law.over_step(law.law, up).force - law.over_step(law.law, down).force) / (2 * difference);
}

// Steps of each kind: touching, releasing slowly and fast.
const ContactStep kTouching[] = {step_between(-kReach, kReach, 0.3),
                                 step_between(-0.01 * kReach, kReach, 0.2),
                                 step_between(-kReach, 0.01 * kReach, 0.25), step_between(0, kReach, 0.2)};
const ContactStep kReleasing[] = {step_between(kReach, -kReach, -0.3),
                                  step_between(0.1 * kReach, -kReach, -0.2),
                                  step_between(kReach, -0.1 * kReach, -0.1), step_between(kReach, 0, -0.1)};
// In compression throughout.
const ContactStep kLasting = step_between(kReach, 1.2 * kReach, 0.05);
// The clipped force of a damped contact is zero before the overlap is.
const ContactStep kFading = step_between(kReach, 0.01 * kReach, 0);

bool fades_early(const StepLaw& law) { return !law.law.tension && law.law.normal_damping > 0; }

}  // namespace

TEST_CASE("a contact that stays open has no force") {
  for (const StepLaw& law : kLaws) {
    CAPTURE(law.name);
    const StepContactForce f = law.over_step(law.law, step_between(-kReach, -0.5 * kReach, 0.1));
    CHECK((f.force == 0 && f.stiffness == 0 && f.damping == 0));
  }
}

TEST_CASE("a contact that stays closed and pushes has the force at the end of the step") {
  for (const StepLaw& law : kLaws) {
    CAPTURE(law.name);
    const StepContactForce f = law.over_step(law.law, kLasting);
    const ContactForce end = law.at_instant(law.law, kLasting.overlap1, kLasting.rate1);
    CHECK(f.force == end.force);
    CHECK(f.stiffness == end.stiffness);
    CHECK(f.damping == end.damping);
  }
}

TEST_CASE("the force is continuous where a contact touches at the end of the step") {
  for (const StepLaw& law : kLaws)
    for (const Real gap : {kReach, 0.1 * kReach}) {
      CAPTURE(law.name, gap);
      const Real tiny = 1e-9 * kReach;
      const StepContactForce f = law.over_step(law.law, step_between(-gap, tiny, 0.2));
      // At most what its slope permits.
      CHECK(f.force >= 0);
      CHECK(f.force <= 2 * (law.law.normal_stiffness + 2 * law.law.normal_damping / kStep) * tiny);
    }
}

// For n = 1 only: the trapezoidal work of another exponent's end forces is not the change of its energy.
TEST_CASE("the force is continuous where a pulling contact releases at the end of the step") {
  for (const StepLaw& law : kLaws) {
    if (!law.law.tension || law.law.exponent != 1) continue;
    for (const Real rate0 : {-0.4, -0.1, 0.2}) {
      CAPTURE(law.name, rate0);
      const Real tiny = 1e-9 * kReach;
      const Real closed = law.over_step(law.law, step_between(kReach, tiny, rate0)).force;
      const Real open = law.over_step(law.law, step_between(kReach, -tiny, rate0)).force;
      const Real largest_slope = 4 * (law.law.normal_stiffness + law.law.normal_damping / kStep);
      CHECK(std::abs(closed - open) <= largest_slope * tiny);
    }
  }
}

TEST_CASE("the force is continuous where a contact without tension releases") {
  for (const StepLaw& law : kLaws) {
    if (law.law.tension) continue;
    for (const Real overlap1 : {0.3 * kReach, 0.0, -0.2 * kReach}) {
      CAPTURE(law.name, overlap1);
      ContactStep c{kReach, -0.1, overlap1, 0, kStep};
      // The rate at which the law's force is zero at the end, or that force depends on overlap1 alone.
      if (law.law.normal_damping > 0) {
        const Real slope0 = law.at_instant(law.law, kReach, 0).stiffness;
        const Real elastic = overlap1 > 0 ? law.at_instant(law.law, overlap1, 0).force : slope0 * overlap1;
        c.rate1 = -elastic / law.law.normal_damping;
      } else {
        c.overlap1 = 0;
      }
      ContactStep above = c, below = c;
      const Real tiny = 1e-9;
      above.rate1 += tiny, below.rate1 -= tiny;
      above.overlap1 += tiny * kReach, below.overlap1 -= tiny * kReach;
      const Real largest_slope = 4 * law.at_instant(law.law, kReach, 0).stiffness;
      const Real allowed = 2 * tiny * (law.law.normal_damping + largest_slope * kReach);
      CHECK(std::abs(law.over_step(law.law, above).force - law.over_step(law.law, below).force) <= allowed);
    }
  }
}

// For the linear law the energy of a clipped contact is exact too.
TEST_CASE("without damping, the step's work is the change of the elastic energy") {
  for (const StepLaw& law : kLaws) {
    if (law.law.normal_damping > 0) continue;
    const bool releases_exactly = law.law.tension || law.law.exponent == 1;
    const auto check = [&](const ContactStep& c) {
      CAPTURE(law.name, c.overlap0, c.overlap1);
      const Real force = (law.start(c) + law.over_step(law.law, c).force) / 2;
      const Real change = law.stored(c.overlap1) - law.stored(c.overlap0);
      CHECK(near(force * (c.overlap1 - c.overlap0), change, {.relative = kRoundOff}));
    };
    for (const ContactStep& c : kTouching) check(c);
    if (!releases_exactly) continue;
    for (const ContactStep& c : kReleasing) check(c);
  }
}

// A sphere between the faces of a plate has contact with the nearer face: the contact with one ends at the
// overlap at which that with the other begins. The last two do not move along their normals while in
// contact.
TEST_CASE(
    "contacts that change over do the work of their elastic energies, and their dissipation is accounted "
    "for") {
  struct Change {
    Real gone0, gone1, come0, come1;  // overlaps of the contact that ends and of the one that begins
  };
  for (const StepLaw& law : kLaws)
    for (const Change& c : {Change{0.9, 1.2, 1.15, 0.95}, Change{1, 1.01, 1.5, 0.2}, Change{0.9, 0.9, 1, 0.6},
                            Change{0.8, 1.4, 1, 1}}) {
      CAPTURE(law.name, c.gone0, c.come1);
      const Real nearer0 = c.come0 - c.gone0, nearer1 = c.gone1 - c.come1,
                 share = nearer0 / (nearer0 + nearer1);
      const Real overlap = kReach * (c.gone0 + share * (c.gone1 - c.gone0));
      ContactStep gone = step_between(kReach * c.gone0, kReach * c.gone1, 0.1),
                  come = step_between(kReach * c.come0, kReach * c.come1, -0.1);
      gone.change = {Changeover::Kind::ends, overlap, share};
      come.change = {Changeover::Kind::begins, overlap, 1 - share};
      CHECK((gone.acts_at_start() && !gone.acts_at_end() && !come.acts_at_start() && come.acts_at_end()));
      const Real work =
          (law.start(gone) + law.over_step(law.law, gone).force) / 2 * (gone.overlap1 - gone.overlap0) +
          law.over_step(law.law, come).force / 2 * (come.overlap1 - come.overlap0);
      const Real change = law.stored(come.overlap1) - law.stored(gone.overlap0);
      const Real scale = law.stored(kReach);
      if (law.law.normal_damping == 0) CHECK(near(work, change, {.absolute = 1e-8 * scale}));
      if (law.law.normal_damping > 0) CHECK(work >= change - 1e-8 * scale);
    }
}

TEST_CASE("derivatives of the step's force are not negative and exact") {
  for (const StepLaw& law : kLaws) {
    const auto check = [&](const ContactStep& c) {
      CAPTURE(law.name, c.overlap0, c.overlap1);
      const StepContactForce f = law.over_step(law.law, c);
      CHECK(f.stiffness >= 0);
      CHECK(f.damping >= 0);
      if (c.overlap1 == 0) return;  // a kink: no derivative to compare with
      const Real stiffness = slope_by_difference(law, c, &ContactStep::overlap1, 1e-6 * std::abs(c.overlap1));
      CHECK(near(f.stiffness, stiffness, {.relative = kTruncation, .absolute = kTruncation}));
      const Real damping = slope_by_difference(law, c, &ContactStep::rate1, 1e-6);
      CHECK(near(f.damping, damping, {.relative = kTruncation, .absolute = kTruncation}));
    };
    for (const ContactStep& c : kTouching) check(c);
    for (const ContactStep& c : kReleasing) check(c);
    if (fades_early(law) && law.law.exponent == 1) check(kFading);
  }
}

TEST_CASE("a pair of materials without stiffness and damping has no force") {
  for (const bool tension : {false, true}) {
    const NormalLawParameters nothing{0, 0, 1, tension};
    for (const ContactStep& c : {kTouching[0], kReleasing[0], step_between(kReach, 0.5 * kReach, 0.1)}) {
      CAPTURE(tension, c.overlap0, c.overlap1);
      CHECK(step_contact_force(LinearLaw(nothing), c).force == 0);
    }
  }
}

}  // namespace scree
