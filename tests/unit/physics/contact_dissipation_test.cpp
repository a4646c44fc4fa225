// Contributions of a contact over a step to the energy ledger: the law's dissipation against the law
// integrated in fine parts, and the remainder for the integrator.
#include <algorithm>
#include <cmath>

#include "physics/contact_losses.hpp"
#include "physics/normal_laws.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 4 * kUlp;
constexpr int kParts = 200000;              // of the path that is integrated
constexpr Real kTruncation = 1.0 / kParts;  // one of them contains a jump

constexpr Real kStep = 1e-3, kReach = 2e-4;  // [s], [m]

struct AccountedLaw {
  const char* name;
  NormalLawParameters law;
  Real (*dissipation)(const NormalLawParameters&, const ContactStep&);
  ContactLosses (*losses)(const NormalLawParameters&, const ContactStep&, Real);
  StepContactForce (*over_step)(const NormalLawParameters&, const ContactStep&);
  ContactForce (*at_instant)(const NormalLawParameters&, Real, Real);
  Real (*energy)(const NormalLawParameters&, Real);
};

template <class Law>
AccountedLaw accounted(const char* name, Real stiffness, Real damping, Real exponent, bool tension) {
  return {name,
          {stiffness, damping, exponent, tension},
          [](const NormalLawParameters& p, const ContactStep& c) { return step_dissipation(Law(p), c); },
          [](const NormalLawParameters& p, const ContactStep& c, Real work) {
            return contact_losses(Law(p), c, work);
          },
          [](const NormalLawParameters& p, const ContactStep& c) { return step_contact_force(Law(p), c); },
          [](const NormalLawParameters& p, Real d, Real d_dot) { return contact_force(Law(p), d, d_dot); },
          [](const NormalLawParameters& p, Real d) { return Law(p).energy(d); }};
}

const AccountedLaw kLaws[] = {accounted<LinearLaw>("linear, cut", 1e6, 400, 1, false),
                              accounted<LinearLaw>("linear, tension", 1e6, 400, 1, true),
                              accounted<PowerLaw>("n = 1.5, cut", 1e8, 400, 1.5, false),
                              accounted<PowerLaw>("n = 1.5, tension", 1e8, 400, 1.5, true),
                              accounted<LinearLaw>("linear, cut, undamped", 1e6, 0, 1, false),
                              accounted<PowerLaw>("n = 1.5, cut, undamped", 1e8, 0, 1.5, false),
                              accounted<PowerLaw>("n = 1.5, tension, undamped", 1e8, 0, 1.5, true)};

constexpr Real kOverlaps[] = {-kReach, -0.01 * kReach, 0, 0.3 * kReach, kReach};

// Calls visit(step) for steps between all overlaps, with rates of either sign.
template <class Visit>
void for_each_step(const Visit& visit) {
  for (const Real overlap0 : kOverlaps)
    for (const Real overlap1 : kOverlaps)
      for (const Real rate0 : {-0.5, -0.05, 0.0, 0.3})
        for (const Real rate1 : {-0.4, 0.0, 0.2}) visit(ContactStep{overlap0, rate0, overlap1, rate1, kStep});
}

// Work of the law's own loss along a path with a given rate at each instant, at the middle of small parts.
template <class Overlap, class Rate>
Real integrated(const AccountedLaw& law, const Overlap& overlap, const Rate& rate) {
  Real sum = 0;
  for (int k = 0; k < kParts; ++k) {
    const Real t = (k + 0.5) / kParts, d = overlap(t);
    if (d > 0) sum += law.at_instant(law.law, d, rate(t)).loss * kStep / kParts;
  }
  return sum;
}

bool holds(const AccountedLaw& law, Real overlap, Real rate) {
  return overlap > 0 && (law.law.tension || law.at_instant(law.law, overlap, rate).force > 0);
}

}  // namespace

TEST_CASE("the dissipation of a contact over a step is the law's loss along its path") {
  for (const AccountedLaw& law : kLaws) {
    for_each_step([&](const ContactStep& c) {
      CAPTURE(law.name, c.overlap0, c.overlap1, c.rate0, c.rate1);
      const Real dissipated = law.dissipation(law.law, c);
      if (holds(law, c.overlap0, c.rate0) && holds(law, c.overlap1, c.rate1)) {
        // In contact throughout, at a linearly changing rate: the damper alone.
        const Real mean_square = (c.rate0 * c.rate0 + c.rate0 * c.rate1 + c.rate1 * c.rate1) / 3;
        CHECK(near(dissipated, law.law.normal_damping * mean_square * c.h, {.relative = kRoundOff}));
        return;
      }
      const Real displacement = c.overlap1 - c.overlap0;
      CHECK(near(dissipated,
                 integrated(
                     law, [&](Real t) { return c.overlap0 + t * displacement; },
                     [&](Real) { return displacement / c.h; }),
                 {.relative = kTruncation}));
    });
  }
}

TEST_CASE("a contact never gives energy by its damper, and without one dissipates exactly nothing") {
  for (const AccountedLaw& law : kLaws)
    for_each_step([&](const ContactStep& c) {
      CAPTURE(law.name, c.overlap0, c.overlap1, c.rate0, c.rate1);
      const Real dissipated = law.dissipation(law.law, c);
      CHECK((law.law.normal_damping > 0 ? dissipated >= 0 : dissipated == 0));
    });
}

TEST_CASE("work, elastic energy, dissipation and the integrator's part add up") {
  for (const AccountedLaw& law : kLaws)
    for_each_step([&](const ContactStep& c) {
      const auto stored = [&](Real d) { return d > 0 ? law.energy(law.law, d) : 0; };
      const Real work = 0.37;
      const ContactLosses losses = law.losses(law.law, c, work);
      CHECK(near(work + stored(c.overlap1) - stored(c.overlap0) + losses.dissipated + losses.integrator, 0,
                 {.absolute = kRoundOff}));
    });
}

// The linear law without damping, on the straight path of an impact, for which step_contact_force is exact.
TEST_CASE("the integrator does nothing to an undamped linear contact that opens or closes") {
  for (const AccountedLaw& law : kLaws) {
    if (law.law.exponent != 1 || law.law.normal_damping > 0) continue;
    for_each_step([&](const ContactStep& c) {
      if (c.overlap0 > 0 && c.overlap1 > 0 && law.over_step(law.law, c).force == 0) return;
      const Real start = c.overlap0 > 0 ? law.at_instant(law.law, c.overlap0, c.rate0).force : 0;
      const Real work = -(start + law.over_step(law.law, c).force) / 2 * (c.overlap1 - c.overlap0);
      CAPTURE(c.overlap0, c.overlap1);
      CHECK(std::abs(law.losses(law.law, c, work).integrator) < 1e-12 * law.energy(law.law, kReach));
    });
  }
}

TEST_CASE("a pair of materials without stiffness and damping dissipates nothing") {
  for (const bool tension : {false, true})
    for_each_step([&](const ContactStep& c) {
      const ContactLosses losses = contact_losses(LinearLaw(0, 0, tension), c, 0);
      CHECK((losses.dissipated == 0 && losses.integrator == 0));
    });
}

}  // namespace scree
