// Spheres with moments of inertia unlike solid ones: from sliding to rolling on a wall.
#include "physics/particle_mass.hpp"
#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "verification/friction/plane_run.hpp"

namespace scree {

namespace {

constexpr Real kSpeed = 2, kRadius = 0.1, kMass = 1, kFriction = 0.25, kGravity = 9.81;

// The oscillations of the slip have decayed at the end.
SimulationRun slide(Real factor, std::vector<std::string> settings) {
  settings.push_back(fmt::format("particles.grain0.inertia_factor={}", factor));
  return SimulationRun(resting_model({.velocity = {kSpeed, 0, 0}, .radius = kRadius, .mass = kMass},
                                     kFriction, 1e5, 0.3, {0, 0, -kGravity}, 2e-5, 1, settings));
}

}  // namespace

// I = f m R^2. Sliding and rolling both keep the angular momentum about the line of contact, v + f R w = v0,
// so that the sphere rolls at v0/(1 + f) after v0 f/((1 + f) mu g), and f/(1 + f) of its energy is lost.
TEST_CASE("a sphere that slides rolls in the end at a speed that its moment of inertia sets") {
  for (const std::vector<std::string>& method : {std::vector<std::string>{}, implicit_steps(0)})
    for (const Real factor : {Real(0.1), Real(2) / 3, Real(1)}) {
      CAPTURE(factor, method.empty());
      SimulationRun run = slide(factor, method);
      CHECK(run.particles().at(0).moment_of_inertia == moment_of_inertia(factor, kMass, kRadius));
      const Real rolling = kSpeed / (1 + factor), t_roll = rolling * factor / (kFriction * kGravity);
      run.run_until(t_roll / 2);
      Particle p = run.particles().at(0);
      // The spring loads first.
      CHECK(near(p.velocity.x, kSpeed - kFriction * kGravity * run.time(), {.absolute = 1e-4}));
      run.run();
      p = run.particles().at(0);
      // Implicit steps end oscillations at their tolerance.
      const Bars end = method.empty() ? Bars{.promise = 1e-10, .measured = 1e-12}
                                      : Bars{.promise = 1e-7, .measured = 1e-9};
      CHECK(keeps(p.velocity.x / rolling - 1, end));
      CHECK(keeps(kRadius * p.angular_velocity.y / p.velocity.x - 1, end));
      CHECK(keeps(p.velocity.x + factor * kRadius * p.angular_velocity.y - kSpeed,
                  {.promise = 1e-10, .measured = 1e-12}));
      const Real lost = kMass * kSpeed * kSpeed / 2 * factor / (1 + factor);
      CHECK(keeps(run.particle_ledger().contact_loss / lost - 1, {.promise = 1e-3, .measured = 1e-4}));
    }
}

TEST_CASE("the standard moment of inertia is a solid sphere's, to the bit") {
  SimulationRun standard(resting_model({.velocity = {kSpeed, 0, 0}, .radius = kRadius, .mass = kMass},
                                       kFriction, 1e5, 0.3, {0, 0, -kGravity}, 2e-5, 0.02)),
      given(resting_model({.velocity = {kSpeed, 0, 0}, .radius = kRadius, .mass = kMass}, kFriction, 1e5, 0.3,
                          {0, 0, -kGravity}, 2e-5, 0.02, {"particles.grain0.inertia_factor=0.4"}));
  for (SimulationRun* run : {&standard, &given}) run->run();
  const Particle a = standard.particles().at(0), b = given.particles().at(0);
  CHECK((a.angular_velocity == b.angular_velocity && a.position == b.position));
  CHECK(a.angular_velocity.y > 0);
}

}  // namespace scree
