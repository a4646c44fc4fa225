// Particles so soft, or so fast, that their centres enter closed meshes: the nearest face acts alone, and
// within an implicit step that may become another one.
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"

namespace scree {

namespace {

constexpr Real kMass = 0.04, kSpeed = 27;  // [kg], [m/s]

// A sphere of 0.05 m meets a closed box from above.
struct PlateDeck {
  std::string pair;       // keys
  std::string thickness;  // of the box [m]
  std::string start = "positions = [[0.01, 0.02, 0.08]]\nvelocity = [1.0, 0.0, -27.0]\n";
  std::string parent = "[[walls]]\nname = \"plate\"\nmesh = \"plate\"\n";

  Model model(const std::vector<std::string>& settings) const {
    return model_of(
        fmt::format("[space]\ndimension = 3\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\nleaving = \"ballistic\"\n"
                    "[time]\nend = 0.016\nstep = 1e-5\n[integrator]\nparticles = \"hht\"\n"
                    "[[contact.pairs]]\n{}[[meshes]]\nname = \"plate\"\nkind = \"box\"\n"
                    "size = [0.4, 0.4, {}]\n{}[[particles]]\nkind = \"list\"\nradius = 0.05\n"
                    "mass = {}\n{}[output]\nhistory_interval = 1e-3\n",
                    pair, thickness, parent, kMass, start),
        settings);
  }
};

const std::vector<std::string> kFine{"integrator.particles=velocity-verlet", "time.step=1e-6"};

// The end of a run.
struct Passed {
  Vec3 velocity, body_velocity;

  Passed(const PlateDeck& deck, const std::vector<std::string>& settings) {
    SimulationRun run(deck.model(settings));
    const Real energy = kMass * kSpeed * kSpeed / 2;
    run.run([&] {
      // Energy error of the steps, at every row of the history.
      const ParticleLedger ledger = run.particle_ledger();
      CHECK(std::abs(ledger.integrator_loss) < 0.01 * energy);
      CHECK(ledger.contact_loss > -1e-9 * energy);
      CHECK(ledger.contact_loss < energy);
    });
    // Explicit steps integrate the dissipation of dashpots to first order.
    CHECK(std::abs(run.balance_error()) < (settings == kFine ? 1e-3 : 1e-7) * energy);
    REQUIRE(run.particle_ledger().contacts == 0);
    velocity = run.particles().at(0).velocity;
    if (!run.bodies().velocity.empty())
      body_velocity = {run.bodies().velocity[0], run.bodies().velocity[1], run.bodies().velocity[2]};
  }
};

}  // namespace

// The energy of an overlap of a radius and half the plate's thickness is 9 J: at 14.6 J the sphere passes
// through.
TEST_CASE("a sphere passes a thin closed plate, or rebounds, as in fine explicit steps") {
  for (const char* friction : {"", "friction = 0.3\ntangential_damping_ratio = 0.1\n"})
    for (const Real stiffness : {3e3, 5e3, 2e4}) {
      const PlateDeck deck{fmt::format("stiffness = {}\nrestitution = 0.9\n{}", stiffness, friction), "0.02"};
      const Vec3 right = Passed(deck, kFine).velocity;
      CHECK((right.z < 0) == (stiffness < 1e4));
      for (const std::vector<std::string>& settings :
           {std::vector<std::string>{}, std::vector<std::string>{"time.control=fixed"},
            std::vector<std::string>{"time.control=fixed", "time.step=4e-5"}}) {
        CAPTURE(friction, stiffness, settings);
        CHECK(near(Passed(deck, settings).velocity, right, {.absolute = 0.01 * kSpeed}));
      }
    }
}

TEST_CASE("a sphere inside of a closed box changes over from its top to its side as in fine explicit steps") {
  const PlateDeck deck{"stiffness = 4e3\nrestitution = 0.9\n", "0.4",
                       "positions = [[0.12, 0.02, 0.26]]\nvelocity = [17.0, 0.0, -21.0]\n"};
  const Vec3 right = Passed(deck, kFine).velocity;
  CHECK(right.x > 17.5);  // the side has pushed it out
  CHECK(near(Passed(deck, {}).velocity, right, {.absolute = 0.01 * kSpeed}));
  CHECK(near(Passed(deck, {"time.control=fixed"}).velocity, right, {.absolute = 0.01 * kSpeed}));
}

TEST_CASE("a sphere goes through the thin plate of a free body, and both keep their momentum") {
  PlateDeck deck{"stiffness = 3e3\nrestitution = 0.9\n", "0.02"};
  deck.parent =
      "[[bodies]]\nname = \"carrier\"\nkind = \"spatial\"\nposition = [0.0, 0.0, 0.0]\nsolids = [{ kind = "
      "\"mesh\", mesh = "
      "\"plate\", density = 300.0 }]\nmeshes = [{ mesh = \"plate\" }]\n";
  constexpr Real kBodyMass = 300 * 0.4 * 0.4 * 0.02;
  const Passed right(deck, kFine), found(deck, {});
  CHECK(right.velocity.z < 0);
  CHECK(near(found.velocity, right.velocity, {.absolute = 0.01 * kSpeed}));
  CHECK(near(kMass * found.velocity + kBodyMass * found.body_velocity, kMass * Vec3{1, 0, -kSpeed},
             {.absolute = 1e-6 * kMass * kSpeed}));
}

}  // namespace scree
