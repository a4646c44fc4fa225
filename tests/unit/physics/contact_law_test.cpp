// The contact law at one instant: geometry, derivatives, dissipation.
#include "physics/contact_law.hpp"

#include <string>

#include "physics/particle_mass.hpp"
#include "support/catch.hpp"

namespace scree {

namespace {

// A law and the policy that computes it, for loops over both.
struct LawCase {
  const char* name;
  KelvinVoigt law;
  ContactForce (*force)(const KelvinVoigt&, Real, Real);
  Real (*energy)(const KelvinVoigt&, Real);
};

const LawCase kLaws[] = {
    {"linear, cut", {1e4, 30, 1, false}, contact_force<LinearElastic>, LinearElastic::energy},
    {"linear, tension", {1e4, 30, 1, true}, contact_force<LinearElastic>, LinearElastic::energy},
    {"n = 1, cut", {1e4, 30, 1, false}, contact_force<PowerElastic>, PowerElastic::energy},
    {"n = 1.5, cut", {1e6, 30, 1.5, false}, contact_force<PowerElastic>, PowerElastic::energy},
    {"n = 1.5, tension", {1e6, 30, 1.5, true}, contact_force<PowerElastic>, PowerElastic::energy},
};

constexpr Real kOverlap = 1e-3, kRates[] = {-0.9, -0.2, 0.0, 0.3};

}  // namespace

TEST_CASE("overlap and normal of two spheres") {
  const Overlap o = sphere_overlap({3, 4, 0}, 6);
  CHECK(o.distance == 5);
  CHECK(o.overlap == 1);
  CHECK(norm(o.normal - Vec3{0.6, 0.8, 0}) <= 1e-15);
  CHECK(sphere_overlap({0, 0, -2}, 1).overlap == -1);
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
      const Real truncation = 1e-8;
      CHECK(f.stiffness == Approx(stiffness).epsilon(truncation).margin(truncation));
      CHECK(f.damping == Approx(damping).epsilon(truncation).margin(truncation));
    }
}

TEST_CASE("the force pulls only with tension, and only where damping wins") {
  for (const LawCase& c : kLaws)
    for (const Real rate : kRates) {
      CAPTURE(c.name, rate);
      const Real force = c.force(c.law, kOverlap, rate).force;
      const Real elastic = c.law.normal_stiffness * std::pow(kOverlap, c.law.exponent);
      const Real printed = elastic + c.law.normal_damping * rate;
      CHECK(force == Approx(printed < 0 && !c.law.tension ? 0 : printed).epsilon(1e-14));
    }
}

TEST_CASE("what the law takes out is the work that the elastic force does not do") {
  for (const LawCase& c : kLaws)
    for (const Real rate : kRates) {
      CAPTURE(c.name, rate);
      const ContactForce f = c.force(c.law, kOverlap, rate);
      const Real elastic = c.law.normal_stiffness * std::pow(kOverlap, c.law.exponent);
      CHECK(f.loss == Approx((f.force - elastic) * rate).margin(1e-12));
      CHECK(f.loss >= 0);
    }
}

TEST_CASE("the elastic force is the slope of the elastic energy") {
  for (const LawCase& c : kLaws) {
    CAPTURE(c.name);
    const Real d = 1e-6 * kOverlap;
    const Real slope = (c.energy(c.law, kOverlap + d) - c.energy(c.law, kOverlap - d)) / (2 * d);
    CHECK(c.force(c.law, kOverlap, 0).force == Approx(slope).epsilon(1e-8));
    CHECK(c.energy(c.law, 0) == 0);
  }
}

TEST_CASE("masses from densities") {
  CHECK(sphere_mass(0.5, 1000) == Approx(523.598775598299).epsilon(1e-14));
  CHECK(disc_mass(0.5, 0.1, 1000) == Approx(78.5398163397448).epsilon(1e-14));
}

}  // namespace scree
