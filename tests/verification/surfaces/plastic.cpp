// Plastic contacts of particles with walls, meshes and bodies, through decks.
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "physics/eepa.hpp"
#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"

namespace scree {

namespace {

// A sphere on a rigid target that it overlaps at the start, which loads the contact.
constexpr Real kRadius = 1e-3, kYoung = 1e5, kWork = 0.1, kRatio = 0.6, kOverlap = 1e-5;
constexpr Real kSpeed = 0.03;  // of the target, away from the sphere [m/s]
constexpr Real kStep = 1e-7;

EepaPair<HertzPairOf<Real>> pair_law(Real radius) {
  NormalLawParameters p;
  p.effective_modulus = kYoung, p.adhesion_work = kWork, p.own = Plasticity(kRatio, 2.5);
  return EepaLaw<HertzLaw>(p).of_pair({radius, kInfinity, 1, kInfinity});
}

Model pulled(const std::string& target) {
  const std::string law =
      fmt::format("plasticity_ratio = {}\nwork_of_adhesion = {}\nadhesion_exponent = 2.5\n", kRatio, kWork);
  return model_of(fmt::format(
      "[space]\ndimension = 3\nmin = [-0.02, -0.02, -0.02]\nmax = [0.02, 0.02, 0.02]\n[time]\nend = 4e-4\n"
      "step = {}\n[integrator]\nparticles = \"velocity-verlet\"\n"
      "[[materials]]\nname = \"grain\"\nyoung_modulus = {}\npoisson_ratio = 0\n"
      "[[materials]]\nname = \"stiff\"\nyoung_modulus = 1e40\npoisson_ratio = 0\n"
      "[[contact.pairs]]\nmaterials = [\"grain\", \"stiff\"]\n{}"
      "[[contact.pairs]]\nmaterials = [\"grain\", \"grain\"]\n{}"
      "[[contact.pairs]]\nmaterials = [\"stiff\", \"stiff\"]\n"
      "[[particles]]\nname = \"grain\"\nkind = \"list\"\nradius = {}\nmaterial = \"grain\"\n"
      "positions = [[0, 0, {:.17g}]]\nmass = 1.0\n"
      "{}[output]\nhistory_interval = 1.0\nhistory_contacts = [\"target\"]\n",
      kStep, kYoung, law, law, kRadius, kRadius - kOverlap, target));
}

std::string moved(const std::string& wall) {
  return "[[walls]]\nname = \"target\"\nmaterial = \"stiff\"\n" + wall +
         fmt::format(
             "motions = [{{ type = \"translation\", direction = [0, 0, -1], displacement = {{ kind = "
             "\"ramp\", rate = {} }} }}]\n",
             kSpeed);
}
const std::string kBox =
    "[[meshes]]\nname = \"box\"\nkind = \"box\"\nsize = [0.01, 0.01, 0.01]\noffset = [0, 0, -0.005]\n";
std::string body(const std::string& shape) {
  return fmt::format(
             "[[bodies]]\nname = \"target\"\nkind = \"spatial\"\nposition = [0, 0, -0.005]\nvelocity = [0, "
             "0, {}]\nmass = 1.0\ninertia_tensor = [1, 1, 1, 0, 0, 0]\n",
             -kSpeed) +
         shape;
}

}  // namespace

TEST_CASE("a plastic contact holds a sphere with the pull-off force of its preload, and opens at touch") {
  struct Case {
    std::string name, target;
    Real radius;  // R* [m]
  };
  const std::vector<Case> cases = {
      {"plane", moved("point = [0, 0, 0]\nnormal = [0, 0, 1]\n"), kRadius},
      {"mesh", kBox + moved("mesh = \"box\"\n"), kRadius},
      {"mesh of a body",
       "[[meshes]]\nname = \"box\"\nkind = \"box\"\nsize = [0.01, 0.01, 0.01]\n" +
           body("meshes = [{ mesh = \"box\", material = \"stiff\" }]\n"),
       kRadius},
      {"sphere of a body", body("shapes = [{ radius = 0.005, material = \"stiff\" }]\n"),
       kRadius * 0.005 / (kRadius + 0.005)}};
  for (const Case& c : cases) {
    CAPTURE(c.name);
    const auto loaded = pair_law(c.radius).after({}, kOverlap);
    const Real pull_off = -loaded.elastic(loaded.state.pull_overlap), d_m = loaded.state.pull_overlap;
    CHECK(pull_off > 0);
    SimulationRun run(pulled(c.target));
    // Before its first step the energy of the contact is the work of loading it.
    CHECK(near(run.particle_ledger().contact_elastic, 0.4 * loaded.stiffness * std::pow(kOverlap, Real(2.5)),
               {.relative = 1e-9}));
    Real largest = 0, at = 0;
    while (run.particle_ledger().contacts == 1) {
      REQUIRE(run.time() < 3.9e-4);
      run.step();
      const Real pull = run.contact_values()[2];
      if (pull > largest) largest = pull, at = kOverlap - kSpeed * run.time();
    }
    CHECK(near(largest, pull_off, {.relative = 5e-3}));
    CHECK(near(at, d_m, {.absolute = 1.1 * kSpeed * kStep}));
    CHECK(near(kSpeed * run.time(), kOverlap, {.absolute = 1.1 * kSpeed * kStep}));
    CHECK(near(run.particle_ledger().contact_loss, loaded.dissipated, {.relative = 2e-3}));
    run.run();
    CHECK(keeps(run.balance_error() / loaded.dissipated, {.promise = 1e-6, .measured = 5e-8}));
  }
}

TEST_CASE("plastic grains settle in a box: no energy is created") {
  for (const std::string keys : {"stiffness = 2e3\n", ""}) {
    CAPTURE(keys);
    const std::string moduli = keys.empty() ? "young_modulus = 1e6\npoisson_ratio = 0.3\n" : "";
    SimulationRun run(model_of(
        "gravity = [1.0, 0.0, -9.81]\n[space]\ndimension = 3\nmin = [0.0, 0.0, 0.0]\nmax = [0.02, 0.02, "
        "0.06]\n"
        "x_min = \"wall\"\nx_max = \"wall\"\ny_min = \"wall\"\ny_max = \"wall\"\nz_min = \"wall\"\n"
        "wall_material = \"soil\"\n[time]\nend = 0.15\nstep = 5e-6\n[integrator]\nparticles = "
        "\"velocity-verlet\"\n[[materials]]\nname = \"soil\"\ndensity = 2000.0\n" +
        moduli + "[[contact.pairs]]\nmaterials = [\"soil\", \"soil\"]\n" + keys +
        "plasticity_ratio = 0.6\nwork_of_adhesion = 2.0\nrestitution = 0.5\nfriction = 0.5\n"
        "rolling_friction = 0.1\nrolling_damping_ratio = 0.3\n"
        "[[particles]]\nname = \"grains\"\nkind = \"random\"\ncount = 150\nmin = [0.0, 0.0, 0.0]\n"
        "max = [0.02, 0.02, 0.03]\nradius = 1e-3\nrandom_velocity = 0.3\nmaterial = \"soil\"\nseed = 3\n"
        "[output]\nhistory_interval = 5e-3\n"));
    Real last = 0;
    run.run([&] {
      const Real loss = run.particle_ledger().contact_loss;
      CHECK(loss >= last);
      last = loss;
    });
    const ParticleLedger end = run.particle_ledger();
    CHECK(end.contacts > 150);
    CHECK(end.cohesion < 0);
    CHECK(keeps(run.balance_error() / run.exchanged(), {.promise = 2e-2, .measured = 9.5e-3}));
  }
}

}  // namespace scree
