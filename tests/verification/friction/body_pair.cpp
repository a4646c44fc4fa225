// Oblique impact of a particle on the disc or sphere of a body, with spins: against two particles.
#include <cmath>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "verification/contact/errors.hpp"
#include "verification/friction/oblique_pair.hpp"

namespace scree {

TEST_CASE("a heavy body's sphere and disc do to a particle what a particle does that moves as they do") {
  for (const int dimension : {2, 3})
    for (const char* law : kHeavyLaws) {
      CAPTURE(dimension, law);
      const HeavyMeeting met(dimension, law, 2e-5);
      CHECK(met.turned > 10);
      CHECK(keeps(met.apart, {.promise = 1e-9, .measured = 1e-12}));
      CHECK(near(met.loss_on_body, met.loss_on_particle, {.relative = 1e-9, .absolute = 1e-12}));
    }
}

// The error is of first order, as for two particles that slide in changing directions.
TEST_CASE("a free body's disc and a particle part as two particles do, to the order of the method") {
  const auto errors_at = [](Real steps, int substeps) {
    Errors errors;
    for (const Real phase : {0.0, 0.25, 0.5, 0.75}) {
      SimulationRun run(disc_meeting(steps, substeps, phase, {}).with_body()),
          exact(disc_meeting(4000, 1, phase, {}).with_particle());
      for (SimulationRun* one : {&run, &exact}) one->run();
      REQUIRE(run.particle_ledger().contacts == 0);
      const std::vector<Particle> after = exact.particles();
      const std::vector<Real>& v = run.bodies().velocity;
      errors.add(difference(run.particles().at(0), after.at(0), 0.05));
      errors.add(norm(Vec3{v[0], v[1], 0} - after[1].velocity));
      errors.add(Real(0.05) * (v[2] - after[1].angular_velocity.z));
    }
    return errors;
  };
  for (const int substeps : {1, 5}) {
    CAPTURE(substeps);
    const Errors coarse = errors_at(20, substeps), fine = errors_at(80, substeps);
    CHECK(keeps(coarse.worst(), {.promise = 2e-2, .measured = 4.3e-3}));
    CHECK(keeps(fine.worst(), {.promise = 5e-3, .measured = 1.1e-3}));
    CHECK(order_between(coarse, fine) / 2 > 0.9);
  }
}

// A step of the particles uses the predicted pose of the body, the next one begins at its corrected pose.
TEST_CASE(
    "a particle and a free body with friction keep momentum and angular momentum to the method's order") {
  for (const Vec3 offset : {Vec3{}, Vec3{0.03, -0.02, 0}})
    for (const int substeps : {1, 5}) {
      CAPTURE(offset.x, substeps);
      const auto errors_at = [&](Real steps, Errors& balance) {
        Errors errors;
        for (const Real phase : {0.0, 0.25, 0.5, 0.75}) {
          const Meeting meeting = disc_meeting(steps, substeps, phase, offset);
          SimulationRun run(meeting.with_body());
          const Momenta before = momenta(run, meeting.partner);
          run.run();
          REQUIRE(run.particle_ledger().contacts == 0);
          const Momenta after = momenta(run, meeting.partner);
          errors.add(norm(after.linear - before.linear));
          errors.add(norm(after.angular - before.angular) / meeting.grain.radius);
          balance.add(run.balance_error() / run.exchanged());
        }
        return errors;
      };
      Errors coarse_balance, fine_balance;
      const Errors coarse = errors_at(20, coarse_balance), fine = errors_at(80, fine_balance);
      CHECK(keeps(coarse.worst(), {.promise = 1e-3, .measured = 2.4e-4}));
      CHECK(keeps(fine.worst(), {.promise = 5e-5, .measured = 5.1e-6}));
      CHECK(order_between(coarse, fine) / 2 > 1.75);
      CHECK(keeps(coarse_balance.worst(), {.promise = 2e-2, .measured = 5.3e-3}));
      CHECK(keeps(fine_balance.worst(), {.promise = 2e-3, .measured = 4.5e-4}));
    }
}

// Both cross the side in contact.
TEST_CASE("friction on a body across a periodic side is that in an open domain") {
  Meeting meeting{2,
                  {.position = {1.6, 0.1499, 0},
                   .velocity = {2.5, -0.2, 0},
                   .spin = {0, 0, 10},
                   .radius = 0.05,
                   .mass = 1},
                  {{1.6, 0, 0}, {2, 0, 0}, 5, 0.1, 1e15, 1e13},
                  "stiffness = 1e5\nfriction = 0.4\ntangential_stiffness = 8e4\n",
                  2e-5,
                  0.4};
  meeting.law = "stiffness = 30.0\ndamping = 0.5\nfriction = 0.2\ntangential_stiffness = 20.0\n";
  meeting.sides = "x_min = \"periodic\"\nx_max = \"periodic\"\n";
  SimulationRun periodic(meeting.with_body());
  meeting.sides = "", meeting.half = 5;
  SimulationRun open(meeting.with_body());
  int touching = 0;
  bool through = false;
  for (int part = 1; part <= 200; ++part) {
    for (SimulationRun* run : {&periodic, &open}) run->run_until(part * meeting.end / 200);
    const Particle p = periodic.particles().at(0), q = open.particles().at(0);
    CHECK(difference(p, q, meeting.grain.radius) < 1e-11);
    const std::int64_t contacts = open.particle_ledger().contacts;
    CHECK(periodic.particle_ledger().contacts == contacts);
    touching += contacts > 0 && p.image.x != 0, through = through || p.image.x != 0;
  }
  CHECK(touching > 10);
  CHECK(through);
}

}  // namespace scree
