// A dashpot beside the slider of friction: the same law in all integrators. Oblique impacts in steps that
// resolve them, explicit and implicit.
#include <cmath>
#include <numbers>

#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/near.hpp"
#include "verification/contact/errors.hpp"
#include "verification/contact/hertz_impacts.hpp"
#include "verification/friction/oblique_pair.hpp"

namespace scree {

namespace {

constexpr Real kSpeed = 10;            // relative speed of the partners, about [m/s]
constexpr Real kOneLaw = 0.01;         // of the speed before an impact
constexpr Real kExplicitParts = 3000;  // of the contact time

struct Law {
  std::string keys, materials;
  Real contact_time;
};

std::vector<Law> laws_of(Real ratio, Real friction) {
  const std::string friction_keys =
      fmt::format("restitution = 0.8\nfriction = {}\ntangential_damping_ratio = {}\n", friction, ratio);
  const Real linear = std::numbers::pi_v<Real> / std::sqrt(Real(1e6));
  return {{"stiffness = 1e6\n" + friction_keys, "", linear},
          {friction_keys, hertz_materials(1e8, 0.3), 2.2e-3}};
}

// Spheres of 1 kg at several angles to the normal of a wall, without spin and with spins about all axes:
// sliding in changing directions.
GrainDeck impacts_on_wall(const Law& law, Real step) {
  GrainDeck deck{.law = law.keys, .grains = {}, .step = step, .end = 3 * law.contact_time};
  deck.materials = law.materials;
  for (const Real degrees : {20, 40, 60, 75})
    for (const Vec3 spin : {Vec3{}, Vec3{60, -30, 20}}) {
      const Real angle = degrees * std::numbers::pi_v<Real> / 180;
      const Vec3 velocity{kSpeed * std::sin(angle), 0, -kSpeed * std::cos(angle)};
      const Real y = 0.2 * static_cast<Real>(deck.grains.size());
      deck.grains.push_back({.position = {0, y, 0.05 - 0.1 * law.contact_time * velocity.z},
                             .velocity = velocity,
                             .spin = spin,
                             .radius = 0.05,
                             .mass = 1});
    }
  return deck;
}

std::vector<Particle> after(GrainDeck deck, const std::vector<std::string>& settings) {
  deck.settings = settings;
  SimulationRun run(deck.model());
  run.run();
  REQUIRE(run.particle_ledger().contacts == 0);
  return run.particles();
}

}  // namespace

TEST_CASE("with a dashpot of friction rebounds from a wall are those of explicit steps in implicit ones") {
  for (const Real ratio : {0.1, 0.3, 1.0})
    for (const Real friction : {0.3, 0.5})
      for (const Law& law : laws_of(ratio, friction)) {
        CAPTURE(ratio, friction, law.keys);
        const std::vector<Particle> exact =
            after(impacts_on_wall(law, law.contact_time / kExplicitParts), {});
        const auto errors_at = [&](Real parts, Real alpha) {
          const std::vector<Particle> found =
              after(impacts_on_wall(law, law.contact_time / parts), implicit_steps(alpha));
          Errors errors;
          for (std::size_t k = 0; k < exact.size(); ++k)
            errors.add(difference(found[k], exact[k], 0.05) / kSpeed);
          return errors;
        };
        const Errors coarse = errors_at(100, -0.05), fine = errors_at(400, -0.05);
        CHECK(measured("one_law/wall", "", at_most(fine.worst(), kOneLaw)));
        CHECK(measured("one_law/wall, T/100", "", at_most(coarse.worst(), 2 * kOneLaw)));
        CHECK(at_most(errors_at(400, -0.3).worst(), kOneLaw));
      }
}

// Exact: 0.482 of the speed along the floor remains where the spring slides back at its limit, with any
// ratio whose dashpot has nothing to act on in between.
TEST_CASE("a ball that hits a rough floor at 60 degrees keeps the same speed along it in all steps") {
  const Real tangent = std::sqrt(Real(3));
  for (const auto& [ratio, kept] : {std::pair{0.1, 0.482}, {0.3, 0.482}, {1.0, 0.485}}) {
    CAPTURE(ratio);
    GrainDeck deck{
        .law = fmt::format("stiffness = 1e6\nrestitution = 0.8\nfriction = 0.5\n"
                           "tangential_damping_ratio = {}\n",
                           ratio),
        .grains = {{.position = {0, 0, 0.06}, .velocity = {5 * tangent, 0, -5}, .radius = 0.05, .mass = 1}},
        .step = 2e-6,
        .end = 6e-3};
    for (const std::vector<std::string>& settings :
         {std::vector<std::string>{}, implicit_steps(-0.05), implicit_steps(0)})
      CHECK(near(after(deck, settings)[0].velocity.x / (5 * tangent), kept, {.absolute = 1.5e-3}));
    // Adaptive steps are as long as the motion permits.
    const Real adaptive = after(deck, {"integrator.particles=hht", "time.control=adaptive"})[0].velocity.x;
    CHECK(near(adaptive / (5 * tangent), kept, {.absolute = kOneLaw}));
  }
}

// Unequal partners with opposite spins; a body instead of the second particle.
TEST_CASE("with a frictional dashpot pairs separate alike in explicit and implicit steps, and on bodies") {
  for (const int dimension : {2, 3})
    for (const Real ratio : {0.1, 1.0})
      for (const Vec3 along : {Vec3{-3, -9, 0}, Vec3{-6, -8, 0}, Vec3{-8, -3, 0}}) {
        CAPTURE(dimension, ratio, along.x);
        const Real radius = 0.08, mass = 4, touch = 2.8e-3;
        const Vec3 lift{0, 0, dimension == 3 ? 2.0 : 0.0};
        Meeting meeting{dimension,
                        {.position = Vec3{0.13, 0, 0} - 0.1 * touch * (along + lift),
                         .velocity = along + lift,
                         .spin = {5 * lift.z, 0, 10},
                         .radius = 0.05,
                         .mass = 1},
                        {{}, {}, -15, radius, mass, (dimension == 3 ? 0.4 : 0.5) * mass * radius * radius},
                        fmt::format("stiffness = 1e6\nrestitution = 0.9\nfriction = 0.5\n"
                                    "tangential_damping_ratio = {}\n",
                                    ratio),
                        touch / kExplicitParts,
                        3 * touch};
        SimulationRun exact(meeting.with_particle());
        meeting.step = touch / 400;
        meeting.settings = implicit_steps(-0.05);
        SimulationRun pair(meeting.with_particle());
        for (SimulationRun* run : {&exact, &pair}) {
          run->run();
          REQUIRE(run->particle_ledger().contacts == 0);
        }
        for (std::size_t k : {0, 1})
          CHECK(measured(
              "one_law/pair", "",
              at_most(difference(pair.particles()[k], exact.particles()[k], 0.05) / kSpeed, kOneLaw)));
        if (dimension == 3) continue;
        // A planar body, which rotates about z alone, and the particle that it replaces.
        SimulationRun on_body(meeting.with_body());
        on_body.run();
        REQUIRE(on_body.particle_ledger().contacts == 0);
        const std::vector<Real>& v = on_body.bodies().velocity;
        const Particle other = exact.particles()[1];
        CHECK(measured(
            "one_law/body", "",
            at_most(difference(on_body.particles()[0], exact.particles()[0], 0.05) / kSpeed, kOneLaw)));
        CHECK(measured("one_law/body", "",
                       at_most((norm(Vec3{v[0], v[1], 0} - other.velocity) +
                                radius * std::abs(v[2] - other.angular_velocity.z)) /
                                   kSpeed,
                               kOneLaw)));
      }
}

}  // namespace scree
