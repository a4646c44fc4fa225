// A particle that rubs on the disc or sphere of a body in implicit steps: against two particles, whose steps
// are the same, but for how they are solved.
#include <cmath>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "verification/friction/meeting.hpp"

namespace scree {

namespace {

const std::string kHht =
    "particles = \"hht\"\nhht_alpha = -0.05\nresidual_tolerance = 1e-12\ncorrection_tolerance = 1e-12\n";

}  // namespace

TEST_CASE("in implicit steps a heavy body's sphere and disc do to a particle what a particle does") {
  for (const int dimension : {2, 3})
    for (const char* law : {"stiffness = 1e5\ndamping = 30.0\nfriction = 0.4\ntangential_stiffness = 8e4\n"
                            "tangential_damping_ratio = 0.2\n",
                            "stiffness = 1e5\nfriction = 5.0\ntangential_stiffness = 8e4\n"}) {
      CAPTURE(dimension, law);
      const Real z = dimension == 3 ? 0.02 : 0;
      Meeting meeting{dimension,
                      {.position = {0.15, 0.15, z},
                       .velocity = {-1.5, -1, 10 * z},
                       .spin = {200 * z, -500 * z, 30},
                       .radius = 0.05,
                       .mass = 1},
                      {{0, 0, 0}, {0.3, -0.2, 0}, 15, 0.1, 1e15, 1e13},
                      law,
                      2e-4,
                      0.08};
      meeting.integrator = kHht;
      SimulationRun on_body(meeting.with_body()), on_particle(meeting.with_particle());
      Real largest = 0, turned = 0;
      for (int part = 1; part <= 40; ++part) {
        for (SimulationRun* run : {&on_body, &on_particle}) run->run_until(part * meeting.end / 40);
        const Particle p = on_body.particles().at(0), q = on_particle.particles().at(0);
        largest = std::max(largest, difference(p, q, meeting.grain.radius));
        turned = std::max(turned, norm(q.angular_velocity - meeting.grain.spin));
      }
      CHECK(turned > 10);
      CHECK(keeps(largest, {.promise = 1e-8, .measured = 1e-12}));
      CHECK(near(on_body.particle_ledger().contact_loss, on_particle.particle_ledger().contact_loss,
                 {.relative = 1e-8, .absolute = 1e-12}));
    }
}

// At steps of a twentieth and of a third of the contact time.
TEST_CASE("in implicit steps a free body's disc and a particle part as two particles do") {
  for (const Real steps : {20, 3})
    for (const Real phase : {0.0, 0.3, 0.6, 0.9}) {
      CAPTURE(steps, phase);
      Meeting meeting = disc_meeting(steps, 1, phase, {});
      meeting.integrator = kHht;
      SimulationRun run(meeting.with_body()), particles(meeting.with_particle());
      for (SimulationRun* one : {&run, &particles}) one->run();
      REQUIRE(run.particle_ledger().contacts == 0);
      const std::vector<Particle> after = particles.particles();
      const std::vector<Real>& v = run.bodies().velocity;
      CHECK(std::abs(after[1].angular_velocity.z - meeting.partner.spin) > 0.5);
      CHECK(
          keeps(difference(run.particles().at(0), after.at(0), 0.05), {.promise = 1e-8, .measured = 1e-12}));
      CHECK(keeps(norm(Vec3{v[0], v[1], 0} - after[1].velocity), {.promise = 1e-8, .measured = 1e-12}));
      CHECK(keeps(Real(0.05) * (v[2] - after[1].angular_velocity.z), {.promise = 1e-8, .measured = 1e-12}));
    }
}

// The impulse of a step is the same for both; where it acts moves within a step.
TEST_CASE("in implicit steps a particle and a body that it rubs keep what they have together") {
  for (const Vec3 offset : {Vec3{}, Vec3{0.03, -0.02, 0}})
    for (const Real phase : {0.0, 0.25, 0.5, 0.75}) {
      CAPTURE(offset.x, phase);
      Meeting meeting = disc_meeting(20, 1, phase, offset);
      meeting.integrator = kHht;
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
