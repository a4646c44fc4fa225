// Cohesion of bodies' shapes with each other, with walls and with meshes, against closed forms.
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "physics/cohesion.hpp"
#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"
#include "support/state_bits.hpp"

namespace scree {

namespace {

// Radius of the ball, its E* and work of adhesion on a rigid partner; radius of another body's sphere.
constexpr Real kRadius = 1e-3, kYoung = 1e5, kWork = 0.1, kSphere = 0.005, kPi = std::numbers::pi_v<Real>;
constexpr Real kSpeed = 0.03;  // of targets that separate from the ball [m/s]

// Johnson, Kendall and Roberts' closed forms, for R*.
Real pull_off(Real radius) { return 1.5 * kPi * kWork * radius; }
Real pull_off_distance(Real radius) {
  return 3 * std::cbrt(kPi * kPi * kWork * kWork * radius / (64 * kYoung * kYoung));
}
Real formation_loss(Real radius) {
  return 7.09219597186396 * std::cbrt(std::pow(kWork, 5) * std::pow(radius, 4) / (kYoung * kYoung));
}

std::string body(const std::string& name, Real z, Real velocity, Real mass, Real inertia,
                 const std::string& surface) {
  return fmt::format(
             "[[bodies]]\nname = \"{}\"\nkind = \"spatial\"\nposition = [0, 0, {:.17g}]\nvelocity = [0, 0, "
             "{:.17g}]\nmass = {}\ninertia_tensor = [{}, {}, {}, 0, 0, 0]\n",
             name, z, velocity, mass, inertia, inertia, inertia) +
         surface;
}
std::string ball(Real z, Real velocity, Real mass, Real inertia) {
  return body("ball", z, velocity, mass, inertia,
              fmt::format("shapes = [{{ radius = {}, material = \"grain\" }}]\n", kRadius));
}
std::string sphere_shape() {
  return fmt::format("shapes = [{{ radius = {}, material = \"stiff\" }}]\n", kSphere);
}
const std::string kBox = "[[meshes]]\nname = \"box\"\nkind = \"box\"\nsize = [0.01, 0.01, 0.01]\n",
                  kOfBox = "meshes = [{ mesh = \"box\", material = \"stiff\" }]\n";

// A ball of a body, and a target whose surface is at z = 0 below it.
struct BallDeck {
  std::string ball, target;
  Real step = 1e-6, end = 1.2e-3;
  std::string law = fmt::format("work_of_adhesion = {}\n", kWork);
  std::string gravity{};

  Model model() const {
    return model_of(
        gravity +
        fmt::format(
            "[space]\ndimension = 3\nmin = [-0.02, -0.02, -0.02]\nmax = [0.02, 0.02, 0.02]\n[time]\n"
            "end = {}\nstep = {}\ncontrol = \"fixed\"\n[integrator]\nparticles = \"velocity-verlet\"\n"
            "[[materials]]\nname = \"grain\"\nyoung_modulus = {}\npoisson_ratio = 0\n"
            "[[materials]]\nname = \"stiff\"\nyoung_modulus = 1e40\npoisson_ratio = 0\n"
            "[[contact.pairs]]\nmaterials = [\"grain\", \"stiff\"]\n{}"
            "[[contact.pairs]]\nmaterials = [\"grain\", \"grain\"]\n{}"
            "[[contact.pairs]]\nmaterials = [\"stiff\", \"stiff\"]\n{}{}"
            "[output]\nhistory_interval = 1.0\nhistory_contacts = [\"target\"]\n",
            end, step, kYoung, law, law, ball, target));
  }
};

std::string moved(const std::string& wall) {
  return "[[walls]]\nname = \"target\"\nmaterial = \"stiff\"\n" + wall +
         fmt::format(
             "motions = [{{ type = \"translation\", direction = [0, 0, -1], displacement = {{ kind = "
             "\"ramp\", rate = {} }} }}]\n",
             kSpeed);
}
const std::string kPlane = "point = [0, 0, 0]\nnormal = [0, 0, 1]\n";

struct Target {
  std::string name, tables;
  Real radius;  // R* [m]
};
constexpr Real kBetween = kRadius * kSphere / (kRadius + kSphere);

}  // namespace

TEST_CASE("JKR holds a sphere of a body with up to 3/2 pi w R*, and breaks at the pull-off distance") {
  const std::vector<Target> targets = {
      {"plane", moved(kPlane), kRadius},
      {"mesh", kBox + "offset = [0, 0, -0.005]\n" + moved("mesh = \"box\"\n"), kRadius},
      {"mesh of a body", kBox + body("target", -0.005, -kSpeed, 1, 1, kOfBox), kRadius},
      {"sphere of a body", body("target", -kSphere, -kSpeed, 1, 1, sphere_shape()), kBetween}};
  for (const Target& target : targets) {
    CAPTURE(target.name);
    const BallDeck deck{ball(kRadius - 1e-6, 0, 1, 1), target.tables};
    SimulationRun run(deck.model());
    REQUIRE(run.particle_ledger().contacts == 1);
    Real largest = 0, broken = 0;
    while (run.time() < deck.end * 0.999 && broken == 0) {
      run.step();
      if (run.particle_ledger().contacts == 0) broken = kSpeed * run.time() - 1e-6;
      largest = std::max(largest, run.contact_values()[2]);
    }
    CHECK(keeps(largest / pull_off(target.radius) - 1, {.promise = 1e-5, .measured = 1e-7}));
    CHECK((broken - pull_off_distance(target.radius)) / (kSpeed * deck.step) < 1.1);
    run.run();
    CHECK(keeps(run.balance_error() / formation_loss(target.radius), {.promise = 1e-2, .measured = 6e-4}));
  }
}

TEST_CASE("a body sticks to a ceiling until it is heavier than the pull-off force") {
  const std::string below = "[[walls]]\nname = \"target\"\nmaterial = \"stiff\"\n";
  for (const std::string& ceiling :
       {below + kPlane, kBox + "offset = [0, 0, -0.005]\n" + below + "mesh = \"box\"\n"})
    for (const Real share : {0.4, 1.1}) {
      CAPTURE(ceiling, share);
      const Real mass = share * pull_off(kRadius) / 10;
      const BallDeck deck{ball(kRadius - 1e-6, 0, mass, 0.4 * mass * kRadius * kRadius),
                          ceiling,
                          1e-5,
                          0.02,
                          fmt::format("work_of_adhesion = {}\nrestitution = 0.1\n", kWork),
                          "gravity = [0, 0, 10]\n"};
      SimulationRun run(deck.model());
      run.run();
      const BodyMotion end = run.multibody().motion(run.bodies())[0];
      if (share < 1) {
        CHECK(run.particle_ledger().contacts == 1);
        CHECK(run.particle_ledger().cohesion < 0);
        CHECK(std::abs(end.velocity.z) < 1e-3);
        CHECK(near(run.contact_values()[2], mass * 10, {.relative = 2e-2}));
      } else {
        CHECK(run.particle_ledger().contacts == 0);
        CHECK(end.velocity.z > 0.05);
      }
      CHECK(std::abs(run.balance_error()) < 1e-2 * run.exchanged());
    }
}

TEST_CASE("an impact of two bodies loses the formation dissipation of JKR, and the energy balance closes") {
  constexpr Real kMass = 1e-5, kOther = 3e-5;
  const Real both = kMass * kOther / (kMass + kOther);
  struct Case {
    Target target;
    Real mass;  // m* [kg]
  };
  const std::vector<Case> cases = {
      {{"wall", "[[walls]]\nname = \"target\"\nmaterial = \"stiff\"\n" + kPlane, kRadius}, kMass},
      {{"mesh of a body", kBox + body("target", -0.005, 0, kOther, 1, kOfBox), kRadius}, both},
      {{"sphere of a body", body("target", -kSphere, 0, kOther, 1, sphere_shape()), kBetween}, both}};
  for (const Case& c : cases) {
    CAPTURE(c.target.name);
    const Real loss = formation_loss(c.target.radius), speed = 2 * std::sqrt(2 * loss / c.mass);
    Real balance[2];
    for (const int k : {0, 1}) {
      const Real step = pull_off_distance(c.target.radius) / speed / (50 * (1 + 3 * k));
      const BallDeck deck{ball(kRadius + speed * step / 2, -speed, kMass, 1), c.target.tables, step,
                          40 * pull_off_distance(kRadius) / speed};
      SimulationRun run(deck.model());
      while (run.particle_ledger().contacts == 0) run.step();
      CHECK(near(run.particle_ledger().contact_loss, loss, {.relative = 2e-2}));
      CHECK(near(run.particle_ledger().cohesion, -loss, {.relative = 0.2}));
      run.run();
      const ParticleLedger ledger = run.particle_ledger();
      CHECK((ledger.contacts == 0 && ledger.contact_elastic == 0 && ledger.cohesion == 0));
      CHECK(near(ledger.contact_loss, loss, {.relative = 2e-2}));
      const std::vector<BodyMotion> end = run.multibody().motion(run.bodies());
      const Real away = end[0].velocity.z - (c.mass < kMass ? end[1].velocity.z : 0);
      CHECK(near(c.mass / 2 * (speed * speed - away * away), loss, {.relative = 3e-2}));
      balance[k] = std::abs(run.balance_error()) / loss;
    }
    CAPTURE(balance[0], balance[1]);
    CHECK(balance[1] < 1e-2);
    CHECK(balance[1] < 0.5 * balance[0]);
  }
}

TEST_CASE("a constant attraction and DMT attract spheres of bodies, also within a range beyond touch") {
  constexpr Real kForce = 2e-4, kRange = 1e-4, kGap = 4e-5;
  const std::vector<Target> targets = {
      {"plane", "[[walls]]\nname = \"target\"\nmaterial = \"stiff\"\n" + kPlane, kRadius},
      {"mesh of a body", kBox + body("target", -0.005, 0, 1, 1, kOfBox), kRadius},
      {"sphere of a body", body("target", -kSphere, 0, 1, 1, sphere_shape()), kBetween}};
  for (const Target& target : targets)
    for (const std::string more : {"", "friction = 0.3\n"}) {
      CAPTURE(target.name, more);
      const auto pull_at = [&](Real gap, const std::string& law) {
        SimulationRun run(
            BallDeck{ball(kRadius + gap, 0, 1, 1), target.tables, 1e-6, 1e-5, law + more}.model());
        return run.contact_values()[2];
      };
      const std::string constant = fmt::format("attraction = {}\nattraction_range = {}\n", kForce, kRange);
      CHECK(near(pull_at(kGap, constant), kForce * (1 - kGap / kRange), {.relative = 1e-9}));
      CHECK(pull_at(1.01 * kRange, constant) == 0);
      const Real repulsion = Real(4) / 3 * kYoung * std::sqrt(target.radius) * std::pow(1e-7, Real(1.5));
      const std::string dmt = fmt::format("work_of_adhesion = {}\nadhesion = \"dmt\"\n", kWork);
      CHECK(near(pull_at(-1e-7, dmt), 2 * kPi * kWork * target.radius - repulsion, {.relative = 1e-9}));
    }
}

TEST_CASE("corners of bodies' meshes do not attract planes") {
  const std::string plane = "[[walls]]\nname = \"target\"\nmaterial = \"grain\"\n" + kPlane;
  const auto force_at = [&](Real height, const std::string& law) {
    SimulationRun run(
        BallDeck{kBox + body("ball", 0.005 + height, 0, 1, 1, kOfBox), plane, 1e-6, 1e-5, law}.model());
    return run.contact_values()[2];
  };
  const std::string jkr =
      fmt::format("work_of_adhesion = {}\nfriction = 0.0\nrolling_friction = 0.1\n", kWork);
  CHECK(force_at(1e-6, jkr) == 0);
  CHECK(force_at(-1e-6, jkr) < 0);
  CHECK(near(force_at(-1e-6, jkr), force_at(-1e-6, "friction = 0.0\n"), {.relative = 1e-14}));
}

TEST_CASE("cohesive contacts of bodies continue after a restart, whatever their list covers") {
  const std::string law = fmt::format(
      "work_of_adhesion = {}\nrestitution = 0.5\nfriction = 0.4\ntangential_damping_ratio = 0.1\n"
      "rolling_friction = 0.1\n",
      kWork);
  const std::vector<Target> targets = {
      {"plane", moved(kPlane), 0},
      {"mesh of a body", kBox + body("target", -0.005, -kSpeed, 1, 1, kOfBox), 0},
      {"sphere of a body", body("target", -kSphere, -kSpeed, 1, 1, sphere_shape()), kSphere}};
  for (const Target& target : targets) {
    CAPTURE(target.name);
    Model model =
        BallDeck{ball(kRadius - 1e-6, 0.02, 1e-3, 4e-10) + "global_angular_velocity = [0, 20, 30]\n",
                 target.tables, 1e-6, 1.2e-3, law}
            .model();
    SimulationRun whole(model), first(model);
    const auto gap = [&] {
      const Real z = first.multibody().motion(first.bodies())[0].position.z;
      return z + kSpeed * first.time() - kRadius;
    };
    while (!(gap() > pull_off_distance(kRadius) / 4)) first.step();
    REQUIRE(first.particle_ledger().contacts == 1);
    SimulationRun second(model, first.complete_state());
    whole.run(), second.run();
    CHECK(whole.particle_ledger().contacts == 0);
    CHECK(differing_arrays(pack(second.complete_state()), pack(whole.complete_state())) == "");
    model.contact.skin = 1e-9;
    SimulationRun often(model);
    often.run();
    CHECK(differing_arrays(pack(often.complete_state()), pack(whole.complete_state())) == "");
  }
}

}  // namespace scree
