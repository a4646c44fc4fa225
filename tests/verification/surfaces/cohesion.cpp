// Cohesion of particles with meshes, moving walls and shapes of bodies, through decks.
#include "physics/cohesion.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "dem/reports/triangle_works.hpp"
#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"
#include "support/state_bits.hpp"

namespace scree {

namespace {

// Radius of the sphere, its E* and work of adhesion on a rigid partner.
constexpr Real kRadius = 1e-3, kYoung = 1e5, kWork = 0.1, kPi = std::numbers::pi_v<Real>;

// Johnson, Kendall and Roberts' closed forms, for R*.
Real pull_off(Real radius) { return 1.5 * kPi * kWork * radius; }
Real pull_off_distance(Real radius) {
  return 3 * std::cbrt(kPi * kPi * kWork * kWork * radius / (64 * kYoung * kYoung));
}
Real formation_loss(Real radius) {
  return 7.09219597186396 * std::cbrt(std::pow(kWork, 5) * std::pow(radius, 4) / (kYoung * kYoung));
}

// A heavy sphere in touch with a target at z = 0 below it.
struct CohesiveDeck {
  std::string target;  // tables of the contact record's "target"
  Real step = 1e-6, end = 1.2e-3;
  std::string law = fmt::format("work_of_adhesion = {}\n", kWork);
  std::string grain = fmt::format("positions = [[0, 0, {:.17g}]]\nmass = 1.0\n", kRadius - 1e-6);
  std::string output = {};  // further keys of `output`

  Model model() const {
    return model_of(
        fmt::format("[space]\ndimension = 3\nmin = [-0.02, -0.02, -0.02]\nmax = [0.02, 0.02, 0.02]\n[time]\n"
                    "end = {}\nstep = {}\n[integrator]\nparticles = \"velocity-verlet\"\n"
                    "[[materials]]\nname = \"grain\"\nyoung_modulus = {}\npoisson_ratio = 0\n"
                    "[[materials]]\nname = \"stiff\"\nyoung_modulus = 1e40\npoisson_ratio = 0\n"
                    "[[contact.pairs]]\nmaterials = [\"grain\", \"stiff\"]\n{}"
                    "[[contact.pairs]]\nmaterials = [\"grain\", \"grain\"]\n{}"
                    "[[contact.pairs]]\nmaterials = [\"stiff\", \"stiff\"]\n"
                    "[[particles]]\nname = \"grain\"\nkind = \"list\"\nradius = {}\nmaterial = \"grain\"\n{}"
                    "{}[output]\nhistory_interval = 1.0\nhistory_contacts = [\"target\"]\n{}",
                    end, step, kYoung, law, law, kRadius, grain, target, output));
  }
};

constexpr Real kSpeed = 0.03;  // speed of targets that separate from the sphere [m/s]

std::string moved(const std::string& wall) {
  return "[[walls]]\nname = \"target\"\nmaterial = \"stiff\"\n" + wall +
         fmt::format(
             "motions = [{{ type = \"translation\", direction = [0, 0, -1], displacement = {{ kind = "
             "\"ramp\", rate = {} }} }}]\n",
             kSpeed);
}
std::string box(const std::string& place) {
  return "[[meshes]]\nname = \"box\"\nkind = \"box\"\nsize = [0.01, 0.01, 0.01]\n" + place;
}
std::string body(const std::string& surface) {
  return fmt::format(
             "[[bodies]]\nname = \"target\"\nkind = \"spatial\"\nposition = [0, 0, -0.005]\nvelocity = [0, "
             "0, {}]\nmass = 1.0\ninertia_tensor = [1, 1, 1, 0, 0, 0]\n",
             -kSpeed) +
         surface;
}

struct Pull {
  Real largest = 0;  // [N]
  Real broken = 0;   // displacement of the target at that time [m]
  Real last = 0;     // before the break [N]
  Real balance = 0;  // balance error [J]
};

Pull pull_apart(const CohesiveDeck& deck) {
  SimulationRun run(deck.model());
  Pull out;
  REQUIRE(run.particle_ledger().contacts == 1);
  while (run.time() < deck.end * 0.999) {
    run.step();
    const std::vector<Real> on_target = run.contact_values();
    if (run.particle_ledger().contacts == 0) {
      CHECK(norm(Vec3{on_target[0], on_target[1], on_target[2]}) == 0);
      CHECK(on_target[6] == 0);
      out.broken = kSpeed * run.time() - 1e-6;
      break;
    }
    CHECK(on_target[6] == 1);
    out.last = on_target[2], out.largest = std::max(out.largest, on_target[2]);
  }
  REQUIRE(out.broken > 0);
  run.run();
  CHECK(run.particle_ledger().contacts == 0);
  out.balance = run.balance_error();
  return out;
}

}  // namespace

TEST_CASE("JKR holds a sphere with up to 3/2 pi w R*, and breaks at the pull-off distance") {
  const std::string corner =
      fmt::format("rotation_axis = [1, -1, 0]\nrotation_angle = {:.17g}\n", std::acos(1 / std::sqrt(3.0)));
  struct Case {
    std::string name, target;
    Real radius;  // R* [m]
  };
  const std::string on_body = "meshes = [{ mesh = \"box\", material = \"stiff\" }]\n";
  const std::vector<Case> cases = {
      {"plane", moved("point = [0, 0, 0]\nnormal = [0, 0, 1]\n"), kRadius},
      {"face", box("offset = [0, 0, -0.005]\nrefine = 0.002\n") + moved("mesh = \"box\"\n"), kRadius},
      {"edge",
       box(fmt::format("rotation_axis = [0, 1, 0]\nrotation_angle = {:.17g}\noffset = [0, 0, {:.17g}]\n",
                       kPi / 4, -0.005 * std::sqrt(2.0))) +
           moved("mesh = \"box\"\n"),
       kRadius},
      {"corner",
       box(corner + fmt::format("offset = [0, 0, {:.17g}]\n", -0.005 * std::sqrt(3.0))) +
           moved("mesh = \"box\"\n"),
       kRadius},
      {"sheet",
       "[[meshes]]\nname = \"sheet\"\nkind = \"rectangle\"\nsize = [0.01, 0.01]\n" +
           moved("mesh = \"sheet\"\n"),
       kRadius},
      {"mesh of a body", box("") + body(on_body), kRadius},
      {"sphere of a body", body("shapes = [{ radius = 0.005, material = \"stiff\" }]\n"),
       kRadius * 0.005 / (kRadius + 0.005)}};
  for (const Case& c : cases) {
    CAPTURE(c.name);
    const Pull pull = pull_apart({.target = c.target});
    CHECK(measured("jkr/pull_off", "",
                   keeps(pull.largest / pull_off(c.radius) - 1, {.promise = 1e-5, .measured = 4.2e-8})));
    CHECK(near(pull.last, Real(5) / 9 * pull_off(c.radius), {.relative = 0.1}));
    const Real displacement = kSpeed * 1e-6;  // displacement in a step [m]
    CHECK(measured("jkr/length", "steps",
                   at_most((pull.broken - pull_off_distance(c.radius)) / displacement, 1.1)));
    CHECK(measured("jkr/balance", "",
                   keeps(pull.balance / formation_loss(c.radius), {.promise = 1e-2, .measured = 6e-4})));
  }
}

// Over the inner edges of a refined face and then beyond the edge of the box, along which it is pulled while
// it sinks: the force depends on its distance alone, beyond touch and around the edge.
TEST_CASE("a JKR contact moves along a face and over its edge without a jump") {
  constexpr Real kEdge = 5.0003e-4, kAcross = 1, kSinking = 5e-3;
  const auto ramp = [](const char* direction, Real rate) {
    return fmt::format(
        "{{ type = \"translation\", direction = {}, displacement = {{ kind = \"ramp\", rate = {} }} }}",
        direction, rate);
  };
  const CohesiveDeck deck{
      .target = box(fmt::format("offset = [{:.17g}, 0.0002, -0.005]\nrefine = 0.0003\n", kEdge - 0.005)) +
                "[[walls]]\nname = \"target\"\nmaterial = \"stiff\"\nmesh = \"box\"\nmotions = [" +
                ramp("[-1, 0, 0]", kAcross) + ", " + ramp("[0, 0, -1]", kSinking) + "]\n"};
  SimulationRun run(deck.model());
  const auto law = JkrLaw(4 * kYoung / 3, 0, kWork).of_pair({kRadius, kInfinity, 1, kInfinity});
  int beyond_touch = 0, past_edge = 0;
  while (run.particle_ledger().contacts > 0) {
    REQUIRE(run.time() < 0.9e-3);
    run.step();
    const Vec3 p = run.particles()[0].position;
    const Real over = p.z + kSinking * run.time(), past = std::max(p.x - (kEdge - kAcross * run.time()), 0.0);
    const Real overlap = kRadius - std::sqrt(over * over + past * past);
    const std::vector<Real> on_target = run.contact_values();
    const Real pull = norm(Vec3{on_target[0], on_target[1], on_target[2]});
    if (overlap < -0.999 * pull_off_distance(kRadius)) continue;
    CHECK(near(pull, std::abs(law.elastic(overlap)), {.relative = 1e-8, .absolute = 1e-9 * law.pull_off}));
    beyond_touch += overlap<0, past_edge += past> 0;
  }
  CHECK(beyond_touch > 300);
  CHECK(past_edge > 50);
}

namespace {

// A light sphere that hits the target, with a JKR contact that forms and breaks.
CohesiveDeck impact_on(const std::string& target, Real mass, Real speed, Real step) {
  return {.target = target,
          .step = step,
          .end = 40 * pull_off_distance(kRadius) / speed,
          .grain = fmt::format("positions = [[0, 0, {:.17g}]]\nvelocity = [0, 0, {}]\nmass = {}\n",
                               kRadius + speed * step / 2, -speed, mass)};
}

Real impact_work(const State& state) {
  Real sum = 0;
  for (const TriangleWorkValues& of : work_values(state.works)) sum += of.impact;
  return sum;
}

}  // namespace

TEST_CASE(
    "an impact loses the formation dissipation of JKR, on meshes and on free bodies, and the energy balance "
    "closes") {
  constexpr Real kMass = 1e-5, kBody = 3e-5, kSphere = 0.002;
  const auto free_body = [&](Real place, const std::string& surface) {
    return fmt::format(
               "[[bodies]]\nname = \"target\"\nkind = \"spatial\"\nposition = [0, 0, {}]\nmass = {}\n"
               "inertia_tensor = [1, 1, 1, 0, 0, 0]\n",
               place, kBody) +
           surface;
  };
  struct Case {
    std::string name, target;
    Real radius, mass;  // R* [m], m* [kg]
    bool mesh;
  };
  const Real both = kMass * kBody / (kMass + kBody);
  const std::vector<Case> cases = {
      {"wall",
       box("offset = [0, 0, -0.005]\n") +
           "[[walls]]\nname = \"target\"\nmesh = \"box\"\nmaterial = \"stiff\"\n",
       kRadius, kMass, true},
      {"mesh of a body", box("") + free_body(-0.005, "meshes = [{ mesh = \"box\", material = \"stiff\" }]\n"),
       kRadius, both, true},
      {"sphere of a body",
       free_body(-kSphere, fmt::format("shapes = [{{ radius = {}, material = \"stiff\" "
                                       "}}]\n",
                                       kSphere)),
       kRadius * kSphere / (kRadius + kSphere), both, false}};
  for (const Case& c : cases) {
    CAPTURE(c.name);
    const Real loss = formation_loss(c.radius), speed = 2 * std::sqrt(2 * loss / c.mass);
    Real balance[2];
    for (const int k : {0, 1}) {
      const Real step = pull_off_distance(c.radius) / speed / (50 * (1 + 3 * k));
      CohesiveDeck deck = impact_on(c.target, kMass, speed, step);
      deck.output = c.mesh ? "surface_fields = [\"impact_work\"]\n" : "";
      SimulationRun run(deck.model());
      while (run.particle_ledger().contacts == 0) run.step();
      CHECK(near(run.particle_ledger().contact_loss, loss, {.relative = 2e-2}));
      CHECK(near(run.particle_ledger().cohesion, -loss, {.relative = 0.2}));
      run.run();
      const ParticleLedger ledger = run.particle_ledger();
      CHECK((ledger.contacts == 0 && ledger.contact_elastic == 0 && ledger.cohesion == 0));
      CHECK(near(ledger.contact_loss, loss, {.relative = 2e-2}));
      if (c.mesh) CHECK(near(impact_work(run.complete_state()), ledger.contact_loss, {.relative = 1e-12}));
      const Real away = run.particles()[0].velocity.z -
                        (c.mass < kMass ? run.multibody().motion(run.bodies())[0].velocity.z : 0);
      CHECK(near(c.mass / 2 * (speed * speed - away * away), loss, {.relative = 3e-2}));
      balance[k] = std::abs(run.balance_error()) / loss;
    }
    CAPTURE(balance[0], balance[1]);
    CHECK(balance[1] < 1e-2);
    CHECK(balance[1] < 0.5 * balance[0]);
  }
}

TEST_CASE("a JKR contact under tension continues after a restart, whatever its list covers") {
  const std::string law = fmt::format(
      "work_of_adhesion = {}\nrestitution = 0.5\nfriction = 0.4\ntangential_damping_ratio = 0.1\n"
      "rolling_friction = 0.1\n",
      kWork);
  const auto grain = [](Real x) {
    return fmt::format(
        "positions = [[{}, 0, {:.17g}]]\nvelocity = [0.3, 0, 0.02]\nangular_velocity = [0, 20, 30]\n"
        "mass = 1e-3\n",
        x, kRadius - 1e-6);
  };
  struct Case {
    std::string target;
    Real start, radius;  // x of the particle, radius of the target [m]
  };
  const std::vector<Case> cases = {
      {box("refine = 0.001\n") + body("meshes = [{ mesh = \"box\", material = \"stiff\" }]\n"), 4.95e-3, 0},
      {body("shapes = [{ radius = 0.005, material = \"stiff\" }]\n"), 0, 5e-3},
      {moved("point = [0, 0, 0]\nnormal = [0, 0, 1]\n"), 0, 0}};
  for (const Case& c : cases) {
    CAPTURE(c.target);
    Model model = CohesiveDeck{.target = c.target, .law = law, .grain = grain(c.start)}.model();
    SimulationRun whole(model), first(model);
    const auto gap = [&] {
      const Vec3 p = first.particles()[0].position + Vec3{0, 0, kSpeed * first.time()};
      return (c.radius > 0 ? norm(p + Vec3{0, 0, c.radius}) - c.radius : p.z) - kRadius;
    };
    while (!(gap() > pull_off_distance(kRadius) / 3)) first.step();
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
