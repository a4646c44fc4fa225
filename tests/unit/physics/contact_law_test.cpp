// The contact law at one instant: geometry, derivatives, dissipation.
#include "physics/contact_law.hpp"

#include <limits>
#include <string>

#include "physics/normal_laws.hpp"
#include "physics/particle_mass.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 4 * kUlp;
constexpr Real kTruncation = 5e-10;  // of central differences over 1e-6, and their round-off, relative

// A law and the policy that evaluates it, for loops over both.
struct LawCase {
  const char* name;
  NormalLawParameters law;
  ContactForce (*force)(const NormalLawParameters&, Real, Real);
  Real (*energy)(const NormalLawParameters&, Real);
};

template <class Law>
LawCase law_case(const char* name, const NormalLawParameters& law) {
  return {name, law,
          [](const NormalLawParameters& p, Real d, Real d_dot) { return contact_force(Law(p), d, d_dot); },
          [](const NormalLawParameters& p, Real d) { return Law(p).energy(d); }};
}

const LawCase kLaws[] = {
    law_case<LinearLaw>("linear, cut", {1e4, 30, 1, false}),
    law_case<LinearLaw>("linear, tension", {1e4, 30, 1, true}),
    law_case<PowerLaw>("n = 1, cut", {1e4, 30, 1, false}),
    law_case<PowerLaw>("n = 1.5, cut", {1e6, 30, 1.5, false}),
    law_case<PowerLaw>("n = 1.5, tension", {1e6, 30, 1.5, true}),
};

constexpr Real kOverlap = 1e-3, kRates[] = {-0.9, -0.2, 0.0, 0.3};

}  // namespace

TEST_CASE("overlap and normal of two spheres") {
  const ContactGeometry o = sphere_pair(Vec3{3, 4, 0}, Real(6));
  CHECK(o.distance == 5);
  CHECK(o.overlap == 1);
  CHECK(norm(o.normal() - Vec3{0.6, 0.8, 0}) <= 1e-15);
  CHECK(sphere_pair(Vec3{0, 0, -2}, Real(1)).overlap == -1);
}

TEST_CASE("overlap and normal of a sphere and a plane") {
  const ContactGeometry o = plane_pair({1, 3, 7}, 2, {5, 2, 0}, {0, 1, 0});
  CHECK(o.overlap == 1);
  CHECK(o.distance == 1);
  CHECK(o.normal() == Vec3{0, 1, 0});
  CHECK(o.rate({3, -2, 1}) == 2);
}

TEST_CASE("the sizes of a pair: a plane is flat and is rigid") {
  constexpr Real kInfinity = std::numeric_limits<Real>::infinity();
  CHECK(PairSize{2, 2, 3, 6}.effective_radius() == 1);
  CHECK(PairSize{2, 2, 3, 6}.effective_mass() == 2);
  CHECK(PairSize{2, kInfinity, 4, kInfinity}.effective_radius() == 2);
  CHECK(PairSize{2, kInfinity, 4, kInfinity}.effective_mass() == 4);
  CHECK(PairSize{2, kInfinity, 4, kInfinity, 0.25}.effective_mass() == 2);
}

TEST_CASE("stiffness and damping are the derivatives of the force") {
  for (const LawCase& c : kLaws)
    for (const Real rate : kRates) {
      CAPTURE(c.name, rate);
      const ContactForce f = c.force(c.law, kOverlap, rate);
      const Real dd = 1e-6 * kOverlap, dv = 1e-6;
      const Real stiffness =
          (c.force(c.law, kOverlap + dd, rate).force - c.force(c.law, kOverlap - dd, rate).force) / (2 * dd);
      const Real damping =
          (c.force(c.law, kOverlap, rate + dv).force - c.force(c.law, kOverlap, rate - dv).force) / (2 * dv);
      CHECK(near(f.stiffness, stiffness, {.relative = kTruncation}));
      CHECK(near(f.damping, damping, {.relative = kTruncation}));
    }
}

TEST_CASE("the force is tensile only without limit_damping, and only where damping exceeds the spring") {
  for (const LawCase& c : kLaws)
    for (const Real rate : kRates) {
      CAPTURE(c.name, rate);
      const Real force = c.force(c.law, kOverlap, rate).force;
      const Real elastic = c.law.normal_stiffness * std::pow(kOverlap, c.law.exponent);
      const Real printed = elastic + c.law.normal_damping * rate;
      CHECK(near(force, printed < 0 && !c.law.tension ? 0 : printed, {.relative = kRoundOff}));
    }
}

TEST_CASE("the law's dissipation is the work beyond that of the elastic force") {
  for (const LawCase& c : kLaws)
    for (const Real rate : kRates) {
      CAPTURE(c.name, rate);
      const ContactForce f = c.force(c.law, kOverlap, rate);
      const Real elastic = c.law.normal_stiffness * std::pow(kOverlap, c.law.exponent);
      CHECK(near(f.loss, (f.force - elastic) * rate, {.relative = kRoundOff}));
      CHECK(f.loss >= 0);
    }
}

TEST_CASE("the elastic force is the slope of the elastic energy") {
  for (const LawCase& c : kLaws) {
    CAPTURE(c.name);
    const Real d = 1e-6 * kOverlap;
    const Real slope = (c.energy(c.law, kOverlap + d) - c.energy(c.law, kOverlap - d)) / (2 * d);
    CHECK(near(c.force(c.law, kOverlap, 0).force, slope, {.relative = kTruncation}));
    CHECK(c.energy(c.law, 0) == 0);
  }
}

TEST_CASE("masses from densities") {
  CHECK(near(sphere_mass(0.5, 1000), 523.598775598299, {.relative = kRoundOff}));
  CHECK(near(disc_mass(0.5, 0.1, 1000), 78.5398163397448, {.relative = kRoundOff}));
}

TEST_CASE("the arms of two spheres add to the distance of their centres; a plane's is the perpendicular") {
  const Vec3 r{0.3, -0.1, 0.2};
  const PairState pair{sphere_pair(r, Real(0.4)), {}, {0.3, 0.1, 1, 1}};
  const PairState mirrored{sphere_pair(-r, Real(0.4)), {}, {0.1, 0.3, 1, 1}};
  const Vec3 arm = contact_arm(pair);
  CHECK(norm(arm + 0.75 * r) < 1e-16);
  CHECK(norm(arm - contact_arm(mirrored) + r) < 1e-16);
  const PairState wall{
      plane_pair({0, 0, 0.09}, 0.1, {5, 5, 0}, {0, 0, 1}), {}, {0.1, kInfinity, 1, kInfinity}};
  CHECK(contact_arm(wall) == Vec3{0, 0, -0.09});
}

}  // namespace scree
