// Oblique impact of two spinning bodies, a disc or a sphere each: against two particles of the same masses
// and moments of inertia.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "verification/contact/errors.hpp"
#include "verification/friction/oblique_pair.hpp"

namespace scree {

namespace {

constexpr Real kSize = 0.05;  // radius [m]
const std::string kExplicit = "particles = \"velocity-verlet\"\n",
                  kImplicit =
                      "particles = \"hht\"\nhht_alpha = -0.05\nresidual_tolerance = 1e-12\n"
                      "correction_tolerance = 1e-12\nmax_iterations = 200\n";
const std::string kStuck = "stiffness = 1e6\nfriction = 1.0\ntangential_stiffness = 8e5\n",
                  kDamped =
                      "stiffness = 1e6\ndamping = 100.0\nfriction = 0.3\ntangential_stiffness = 8e5\n"
                      "tangential_damping_ratio = 0.2\n";

// One of the two bodies; with discs the spin is about z. offset: of the shape from the body's centre [m].
struct One {
  Vec3 position, velocity, spin;
  Real mass;
  Vec3 offset{};
};

struct TwoMeet {
  int dimension;
  One one, other;
  std::string law, integrator;
  Real step, end;
  std::string more{};

  Real inertia(const One& of) const { return (dimension == 3 ? 0.4 : 0.5) * of.mass * kSize * kSize; }
  std::string vector(Vec3 a) const { return dimension == 3 ? toml(a) : fmt::format("[{}, {}]", a.x, a.y); }
  std::string setup() const {
    return fmt::format(
        "[space]\ndimension = {}\nmin = {}\nmax = {}\n{}[time]\nend = {:.17g}\nstep = {:.17g}\ncontrol = "
        "\"fixed\"\n[integrator]\n{}[[contact.pairs]]\n{}",
        dimension, vector({-2, -2, -2}), vector({2, 2, 2}), more, end, step, integrator, law);
  }
  std::string particle(const char* name, const One& of) const {
    return fmt::format(
        "[[particles]]\nname = \"{}\"\nkind = \"list\"\npositions = [{}]\nvelocity = {}\n"
        "angular_velocity = {}\nradius = {}\nmass = {}\n",
        name, vector(of.position), vector(of.velocity),
        dimension == 3 ? toml(of.spin) : fmt::format("[{}]", of.spin.z), kSize, of.mass);
  }
  std::string body(const char* name, const One& of) const {
    const Real j = inertia(of);
    const std::string turning =
        dimension == 3 ? fmt::format(
                             "kind = \"spatial\"\ninertia_tensor = [{:.17g}, {:.17g}, {:.17g}, 0, 0, "
                             "0]\nglobal_angular_velocity = {}\n",
                             j, j, j, toml(of.spin))
                       : fmt::format("inertia = {:.17g}\nangular_velocity = {}\n", j, of.spin.z);
    return fmt::format(
               "[[bodies]]\nname = \"{}\"\nposition = {}\nvelocity = {}\nmass = {}\nshapes = [{{ radius = "
               "{}, offset "
               "= {} }}]\n",
               name, vector(of.position - of.offset), vector(of.velocity), of.mass, kSize,
               vector(of.offset)) +
           turning;
  }
  Model bodies() const { return model_of(setup() + body("one", one) + body("other", other)); }
  Model particles() const { return model_of(setup() + particle("one", one) + particle("other", other)); }
};

// phase: of the first touch within a step.
TwoMeet meet(int dimension, const std::string& law, const std::string& integrator, Real steps, Real phase) {
  const Vec3 normal = dimension == 3 ? Vec3{0.48, 0.6, 0.64} : Vec3{0.8, 0.6, 0};
  const Real z = dimension == 3 ? 1 : 0, h = kContactTime / steps;
  TwoMeet out{dimension,
              {{}, {-1.5, 0.4, -0.3 * z}, {7 * z, -12 * z, 20}, 1},
              {{}, {0.5, 0.1, 0.2 * z}, {-9 * z, 3 * z, 12}, 1.3},
              law,
              integrator,
              h,
              std::ceil(2 * steps) * h};
  const Real speed = dot(out.one.velocity - out.other.velocity, normal);
  out.one.position = (2 * kSize - (phase + 0.5) * h * speed) * normal;
  return out;
}

struct Motion {
  Vec3 velocity[2], spin[2];  // [m/s], [rad/s]
};
Motion of_bodies(const SimulationRun& run) {
  Motion out;
  const std::vector<BodyMotion> motion = run.multibody().motion(run.bodies());
  for (const std::size_t k : {0, 1})
    out.velocity[k] = motion[k].velocity, out.spin[k] = global_spin(motion[k]);
  return out;
}
Motion of_particles(const SimulationRun& run) {
  const std::vector<Particle> p = run.particles();
  return {{p[0].velocity, p[1].velocity}, {p[0].angular_velocity, p[1].angular_velocity}};
}
Real apart(const Motion& a, const Motion& b) {
  Real most = 0;
  for (const int k : {0, 1})
    most = std::max({most, norm(a.velocity[k] - b.velocity[k]), kSize * norm(a.spin[k] - b.spin[k])});
  return most;
}

// Momenta of both bodies about the origin.
Momenta momenta_of(const SimulationRun& run, const TwoMeet& meeting) {
  Momenta sum;
  const std::vector<BodyMotion> motion = run.multibody().motion(run.bodies());
  for (const std::size_t k : {0, 1}) {
    const One& of = k == 0 ? meeting.one : meeting.other;
    const Vec3 linear = of.mass * motion[k].velocity;
    sum.linear += linear;
    sum.angular += cross(motion[k].position, linear) + meeting.inertia(of) * global_spin(motion[k]);
  }
  return sum;
}

}  // namespace

TEST_CASE("in implicit steps two bodies with friction separate as two particles do") {
  for (const std::string& law : {kUndamped, kStuck, kDamped})
    for (const Real steps : {20, 4}) {
      CAPTURE(law, steps);
      const TwoMeet meeting = meet(2, law, kImplicit, steps, 0.3);
      SimulationRun bodies(meeting.bodies()), particles(meeting.particles());
      bodies.run(), particles.run();
      REQUIRE(bodies.particle_ledger().contacts == 0);
      const Motion exact = of_particles(particles);
      REQUIRE(kSize * norm(exact.spin[1] - meeting.other.spin) > 0.02);
      CHECK(keeps(apart(of_bodies(bodies), exact), {.promise = 1e-8, .measured = 1e-12}));
      const ParticleLedger of_two = bodies.particle_ledger(), expected = particles.particle_ledger();
      CHECK(near(of_two.contact_loss, expected.contact_loss, {.absolute = 1e-8}));
      CHECK(near(of_two.rotation.losses.of[kFrictionLoss], expected.rotation.losses.of[kFrictionLoss],
                 {.absolute = 1e-8}));
      CHECK(keeps(bodies.balance_error() / bodies.exchanged(), {.promise = 1e-5, .measured = 1e-12}));
    }
}

// In space a body's rotation within a step is a rotation vector, a particle's the sum of its spins.
TEST_CASE("in implicit steps two spheres of bodies part as two particles do, to second order") {
  for (const std::string& law : {kUndamped, kStuck, kDamped}) {
    CAPTURE(law);
    const auto error_at = [&](Real steps) {
      const TwoMeet meeting = meet(3, law, kImplicit, steps, 0.3);
      SimulationRun bodies(meeting.bodies()), particles(meeting.particles());
      bodies.run(), particles.run();
      REQUIRE(bodies.particle_ledger().contacts == 0);
      CHECK(keeps(bodies.balance_error() / bodies.exchanged(), {.promise = 1e-5, .measured = 1e-12}));
      return apart(of_bodies(bodies), of_particles(particles));
    };
    const Real coarse = error_at(20), fine = error_at(80);
    CHECK(keeps(coarse, {.promise = 1e-4, .measured = 1.1e-5}));
    CHECK(std::log2(coarse / fine) / 2 > 1.8);
  }
}

// Bodies are integrated by HHT, the particles by leapfrog.
TEST_CASE("in explicit steps two bodies with friction separate as two particles do, to the method's order") {
  for (const int dimension : {2, 3})
    for (const std::string& law : {kUndamped, kStuck}) {
      CAPTURE(dimension, law);
      const auto errors_at = [&](Real steps, Errors& balance) {
        Errors errors;
        for (const Real phase : {0.0, 0.5}) {
          SimulationRun run(meet(dimension, law, kExplicit, steps, phase).bodies()),
              exact(meet(dimension, law, kExplicit, 2000, phase).particles());
          run.run(), exact.run();
          REQUIRE(run.particle_ledger().contacts == 0);
          errors.add(apart(of_bodies(run), of_particles(exact)));
          balance.add(run.balance_error() / run.exchanged());
        }
        return errors;
      };
      Errors coarse_balance, fine_balance;
      const Errors coarse = errors_at(20, coarse_balance), fine = errors_at(80, fine_balance);
      CHECK(keeps(coarse.worst(), {.promise = 2e-2, .measured = 4.8e-3}));
      CHECK(keeps(fine.worst(), {.promise = 5e-3, .measured = 1.1e-3}));
      CHECK(order_between(coarse, fine) / 2 > 0.8);
      CHECK(keeps(coarse_balance.worst(), {.promise = 2e-2, .measured = 1.2e-2}));
      CHECK(keeps(fine_balance.worst(), {.promise = 2e-3, .measured = 4.4e-4}));
    }
}

TEST_CASE("two bodies with friction keep their momentum, and their angular momentum to the method's order") {
  for (const std::string& integrator : {kExplicit, kImplicit})
    for (const int dimension : {2, 3})
      for (const Vec3 offset : {Vec3{}, Vec3{0.03, -0.02, 0}}) {
        CAPTURE(integrator, dimension, offset.x);
        const auto errors_at = [&](Real steps) {
          TwoMeet meeting = meet(dimension, kUndamped, integrator, steps, 0.4);
          meeting.one.offset = offset;
          SimulationRun run(meeting.bodies());
          const Momenta before = momenta_of(run, meeting);
          run.run();
          REQUIRE(run.particle_ledger().contacts == 0);
          const Momenta after = momenta_of(run, meeting);
          CHECK(keeps(norm(after.linear - before.linear), {.promise = 1e-9, .measured = 1e-13}));
          return norm(after.angular - before.angular) / kSize;
        };
        const Real coarse = errors_at(20), fine = errors_at(80);
        CHECK(keeps(coarse, {.promise = 1e-4, .measured = 5.2e-6}));
        CHECK(keeps(fine, {.promise = 1e-6, .measured = 8e-8}));
      }
}

}  // namespace scree
