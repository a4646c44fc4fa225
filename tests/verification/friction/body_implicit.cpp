// Friction of a particle on the disc or sphere of a body in implicit steps: against two particles, whose
// steps are the same except for the solver.
#include <cmath>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/near.hpp"
#include "verification/friction/oblique_pair.hpp"

namespace scree {

namespace {

const std::string kHht =
    "particles = \"hht\"\nhht_alpha = -0.05\nresidual_tolerance = 1e-13\ncorrection_tolerance = 1e-12\n";

// Without a damping ratio, whose dashpot has an inertia in which a body counts as unmovable.
const std::string kRollingKeys = "rolling_friction = 0.2\nrolling_damping = 0.02\n";

}  // namespace

TEST_CASE("in implicit steps a heavy body's sphere and disc do to a particle what a particle does") {
  std::string rolling;
  SECTION("with friction") {}
  SECTION("with rolling and twisting resistance") { rolling = kRollingKeys; }
  for (const int dimension : {2, 3})
    for (const char* law : kHeavyLaws) {
      CAPTURE(dimension, law);
      const HeavyMeeting met(dimension, (law + rolling).c_str(), 2e-4, kHht);
      CHECK(met.turned > 10);
      CHECK(keeps(met.apart, {.promise = 1e-8, .measured = 1e-12}));
      CHECK(near(met.loss_on_body, met.loss_on_particle, {.relative = 1e-8, .absolute = 1e-12}));
    }
}

// At steps of a twentieth and of a third of the contact time.
TEST_CASE("in implicit steps a free body's disc and a particle part as two particles do") {
  std::string rolling;
  SECTION("with friction") {}
  SECTION("with rolling resistance") { rolling = kRollingKeys; }
  for (const Real steps : {20, 3})
    for (const Real phase : {0.0, 0.3, 0.6, 0.9}) {
      CAPTURE(steps, phase);
      Meeting meeting = disc_meeting(steps, 1, phase, {});
      meeting.integrator = kHht, meeting.law += rolling;
      SimulationRun run(meeting.with_body()), particles(meeting.with_particle());
      for (SimulationRun* one : {&run, &particles}) one->run();
      REQUIRE(run.particle_ledger().contacts == 0);
      const std::vector<Particle> after = particles.particles();
      const std::vector<Real>& v = run.bodies().velocity;
      CHECK(std::abs(after[1].angular_velocity.z - meeting.partner.spin) > 0.4);
      for (const Real error :
           {difference(run.particles().at(0), after.at(0), 0.05),
            norm(Vec3{v[0], v[1], 0} - after[1].velocity), Real(0.05) * (v[2] - after[1].angular_velocity.z)})
        CHECK(
            measured("frictional_body/velocity", "m/s", keeps(error, {.promise = 1e-8, .measured = 1e-12})));
    }
}

// The impulse of a step is the same for both; its point of action moves within a step.
TEST_CASE("in implicit steps a particle and a body with friction conserve their momenta") {
  std::string rolling;
  SECTION("with friction") {}
  SECTION("with rolling resistance") { rolling = kRollingKeys; }
  for (const Vec3 offset : {Vec3{}, Vec3{0.03, -0.02, 0}})
    for (const Real phase : {0.0, 0.25, 0.5, 0.75}) {
      CAPTURE(offset.x, phase);
      Meeting meeting = disc_meeting(20, 1, phase, offset);
      meeting.integrator = kHht, meeting.law += rolling;
      SimulationRun run(meeting.with_body());
      const Momenta before = momenta(run, meeting.partner);
      run.run();
      REQUIRE(run.particle_ledger().contacts == 0);
      const Momenta after = momenta(run, meeting.partner);
      CHECK(keeps(norm(after.linear - before.linear), {.promise = 1e-9, .measured = 1e-12}));
      CHECK(keeps(norm(after.angular - before.angular) / meeting.grain.radius,
                  {.promise = 1e-4, .measured = 6.4e-7}));
      CHECK(keeps(run.balance_error() / run.exchanged(), {.promise = 1e-5, .measured = 2.2e-7}));
    }
}

}  // namespace scree
