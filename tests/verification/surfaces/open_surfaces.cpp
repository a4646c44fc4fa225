// Soft particles that penetrate open surfaces by more than their radius are pushed back to their side.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>
#include <string>
#include <vector>

#include "dem/history/contact_key.hpp"
#include "run/state/state.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"
#include "support/state_bits.hpp"
#include "unit/output/scratch.hpp"

namespace scree {

namespace {

constexpr Real kRadius = 1, kMass = 1, kStiffness = 1, kInertia = 0.4 * kMass * kRadius * kRadius;
const std::string kMethods[] = {"velocity-verlet", "hht"};

// A particle that hits the open surface "sheet", 6 m wide around the origin, at z = 0.
struct SurfaceDeck {
  std::string method = "velocity-verlet";
  Real friction = 0;
  std::string grain = "positions = [[0.3, 0.2, 1.5]]\nvelocity = [0.4, 0.0, -1.5]\n";
  std::string gravity = "[0, 0, 0]";
  std::string parent = "[[walls]]\nname = \"sheet\"\nmesh = \"sheet\"\n";
  Real skin = 0.2;
  Real end = 5;

  Model model() const {
    return model_of(fmt::format(
        "gravity = {}\n[space]\ndimension = 3\nmin = [-9, -9, -9]\nmax = [9, 9, 9]\n[time]\nend = {}\nstep = "
        "0.01\ncontrol = \"fixed\"\n[integrator]\nparticles = \"{}\"\n[contact]\nskin = {}\n"
        "[[contact.pairs]]\nstiffness = {}\n{}[[meshes]]\nname = \"sheet\"\nkind = \"rectangle\"\nsize = [6, "
        "6]\nrefine = 0.7\n{}[[particles]]\nname = \"grain\"\nkind = \"list\"\nradius = {}\nmass = {}\n{}"
        "[output]\nhistory_interval = 0.5\nhistory_contacts = [\"sheet\"]\n",
        gravity, end, method, skin, kStiffness, friction > 0 ? fmt::format("friction = {}\n", friction) : "",
        parent, kRadius, kMass, grain));
  }
};

// A strip, bent along its length.
struct Strip {
  int along, across;
  Vec3 (*at)(Real u, Real v);  // both from 0 to 1
};
const Strip kSpiral{80, 6, [](Real u, Real v) {
                      const Real angle = 5 * M_PI * u, radius = 0.02 + 0.05 * u;
                      return Vec3{radius * std::cos(angle), 0.3 * (v - 0.5), radius * std::sin(angle)};
                    }};
const Strip kZigzag{24, 8, [](Real u, Real v) {
                      return Vec3{0.3 * (u - 0.5), 0.3 * (v - 0.5), std::lround(24 * u) % 2 == 0 ? 0 : 0.02};
                    }};

void write_strip(const std::string& file, const Strip& strip) {
  std::ofstream out(file);
  out.precision(17);
  for (int i = 0; i <= strip.along; ++i)
    for (int j = 0; j <= strip.across; ++j) {
      const Vec3 p = strip.at(Real(i) / strip.along, Real(j) / strip.across);
      out << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
    }
  for (int i = 0; i < strip.along; ++i)
    for (int j = 0; j < strip.across; ++j) {
      const int a = (strip.across + 1) * i + j + 1, b = a + strip.across + 1;
      out << "f " << a << ' ' << b << ' ' << b + 1 << "\nf " << a << ' ' << b + 1 << ' ' << a + 1 << '\n';
    }
}

Vec3 force_on_surface(SimulationRun& run) {
  const std::vector<Real> values = run.contact_values();
  return {values[0], values[1], values[2]};
}

int contacts_past(const State& state) {
  return static_cast<int>(std::count_if(state.contacts.keys.begin(), state.contacts.keys.end(),
                                        [](auto key) { return is_penetrated(key); }));
}

}  // namespace

TEST_CASE("a particle whose centre penetrates an open surface is pushed back by K times its overlap") {
  for (const std::string& method : kMethods)
    for (const Real friction : {0.0, 0.3}) {
      CAPTURE(method, friction);
      SimulationRun run(SurfaceDeck{method, friction}.model());
      Real lowest = 1, worst = 0, most = 0;
      while (run.time() < 4.99) {
        run.step();
        const Particle p = run.particles()[0];
        const Vec3 force = force_on_surface(run);
        const Real overlap = std::max(kRadius - p.position.z, Real(0)),
                   sliding = std::hypot(force.x, force.y);
        worst = std::max(worst, std::abs(force.z + kStiffness * overlap));
        most = std::max(most, sliding - friction * kStiffness * overlap);
        lowest = std::min(lowest, p.position.z);
        CHECK((contacts_past(run.complete_state()) == 1) == (p.position.z < 0));
      }
      const Particle p = run.particles()[0];
      CHECK(near(lowest, -0.5, {.absolute = 1e-4}));
      CHECK(worst < 1e-12);
      CHECK(most < 1e-12);
      CHECK(near(p.velocity.z, 1.5, {.relative = 1e-5}));
      CHECK(std::abs(run.balance_error()) < 1e-4);
      // About the line below it on the surface no force has a lever arm.
      CHECK(near(kMass * kRadius * p.velocity.x + (friction > 0 ? kInertia * p.angular_velocity.y : 0),
                 0.4 * kMass * kRadius, {.relative = 1e-12}));
      CHECK((p.velocity.x < 0.39) == (friction > 0));
    }
}

TEST_CASE("lists, restarts and moving bodies do not change on which side of an open surface a particle is") {
  for (const std::string& method : kMethods)
    for (const Real friction : {0.0, 0.3}) {
      CAPTURE(method, friction);
      SurfaceDeck deck{method, friction};
      SimulationRun whole(deck.model());
      whole.run_until(2);
      const State half = whole.complete_state();
      CHECK(contacts_past(half) == 1);
      whole.run();
      SimulationRun parts(deck.model(), half);
      parts.run();
      CHECK(differing_arrays(pack(parts.complete_state()), pack(whole.complete_state())) == "");
      deck.skin = 1e-6;
      SimulationRun listed(deck.model());
      listed.run();
      CHECK(state_hash(listed.complete_state(), true) == state_hash(whole.complete_state(), true));
      CHECK(listed.particles()[0].velocity.z > 1.4);
    }
}

// They move by 0.3 of their radius in a step, farther than the row of triangles of the previous step
// extends, and touch both turns of a spiral between which they are, or folds of a zigzag of which the next
// row has fewer.
TEST_CASE("the history of fast particles on an open surface does not depend on lists") {
  const ScratchDirectory folder;
  const std::string file = folder.path() + "/strip.obj";
  const auto hash = [&](Real skin, Real friction) {
    SimulationRun run(model_of(fmt::format(
        "[space]\ndimension = 3\nmin = [-0.2, -0.2, -0.2]\nmax = [0.2, 0.2, 0.2]\nx_min = "
        "\"periodic\"\nx_max = "
        "\"periodic\"\ny_min = \"periodic\"\ny_max = \"periodic\"\nz_min = \"periodic\"\nz_max = "
        "\"periodic\"\n"
        "[time]\nend = 0.6\nstep = 3e-3\n[integrator]\nparticles = \"velocity-verlet\"\n[contact]\nskin = "
        "{}\n"
        "[[contact.pairs]]\nstiffness = 10.0\n{}[[meshes]]\nname = \"strip\"\nkind = \"file\"\nfile = "
        "\"{}\"\n"
        "sheet = true\nfeature_angle = 1.0\n[[walls]]\nname = \"strip\"\nmesh = \"strip\"\n[[particles]]\n"
        "name = \"grains\"\nkind = \"random\"\ncount = 200\nmin = [-0.1, -0.15, -0.1]\nmax = [0.1, 0.15, "
        "0.1]\n"
        "radius = {{ kind = \"uniform\", min = 0.006, max = 0.012 }}\ndensity = 2500.0\nrandom_velocity = "
        "1.0\n"
        "seed = 1\n[output]\nhistory_interval = 0.6\n",
        skin, friction > 0 ? fmt::format("friction = {}\n", friction) : "", file)));
    run.run();
    return state_hash(run.complete_state(), true);
  };
  for (const Strip& strip : {kSpiral, kZigzag}) {
    write_strip(file, strip);
    for (const Real friction : {0.0, 0.3}) CHECK(hash(1e-4, friction) == hash(8e-3, friction));
  }
}

// The middle of the surface is beyond a side of the domain by the extent of the surface from its point; the
// smallest motion takes the point across the other side.
TEST_CASE("a moving open surface acts across the sides of a periodic domain wherever its point is") {
  for (const Real rate : {0.0, 1e-9, -1e-9}) {
    CAPTURE(rate);
    SimulationRun run(model_of(fmt::format(
        "gravity = [0, 0, -9]\n[space]\ndimension = 3\nmin = [0, 0, -0.1]\nmax = [0.6, 0.4, 0.4]\nx_min = "
        "\"periodic\"\nx_max = \"periodic\"\n[time]\nend = 0.15\nstep = 1e-4\n[integrator]\nparticles = "
        "\"velocity-verlet\"\n[[contact.pairs]]\nstiffness = 1000.0\n[[meshes]]\nname = \"sheet\"\nkind = "
        "\"rectangle\"\nsize = [0.5, 0.3]\noffset = [0.38, 0.2, 0.1]\nrefine = 0.05\n[[walls]]\nname = "
        "\"sheet\"\nmesh = \"sheet\"\nmotions = [{{ type = \"translation\", direction = [1, 0, 0], "
        "displacement = {{ kind = \"ramp\", rate = {} }} }}]\n[[particles]]\nkind = \"list\"\npositions = "
        "[[0.02, 0.2, 0.112]]\nradius = 0.01\ndensity = 2500.0\nvelocity = [0, 0, -0.3]\n[output]\n"
        "history_interval = 1.0\n",
        rate)));
    run.run();
    CHECK(near(run.particles()[0].position.z, 0.1169, {.absolute = 1e-4}));
  }
}

TEST_CASE("shapes keep their side of open surfaces of bodies: momentum and energy are those of a rebound") {
  const std::string body =
      "[[bodies]]\nname = \"{}\"\nkind = \"spatial\"\nmass = 1.0\ninertia_tensor = [9, 9, 9, "
      "0, 0, 0]\n";
  const std::string plate =
      fmt::format(fmt::runtime(body), "sheet") + "position = [0, 0, 0]\nmeshes = [{ mesh = \"sheet\" }]\n";
  const std::string wall = "[[walls]]\nname = \"sheet\"\nmesh = \"sheet\"\n";
  const std::string ball = fmt::format(fmt::runtime(body), "ball") +
                           "position = [0, 0, 1.5]\nvelocity = [0, 0, -1.5]\nshapes = [{ radius = 1.0 }]\n";
  const std::string far = "positions = [[7, 7, 7]]\n",
                    launched = "positions = [[0, 0, 1.5]]\nvelocity = [0, 0, -2.0]\n";
  for (const std::string& method : kMethods)
    for (const Real friction : {0.0, 0.3}) {
      CAPTURE(method, friction);
      SimulationRun grain(SurfaceDeck{method, friction, launched, "[0, 0, 0]", plate}.model());
      grain.run();
      CHECK(std::abs(grain.particles()[0].velocity.z) < 1e-3);
      CHECK(near(grain.bodies().velocity[2], -2.0, {.relative = 1e-3}));
      SimulationRun shape(SurfaceDeck{method, friction, far, "[0, 0, 0]", ball + wall}.model());
      shape.run();
      CHECK(near(shape.bodies().velocity[2], 1.5, {.relative = 1e-3}));
    }
}

TEST_CASE("a particle that moves around a free edge is then on the other side of the open surface") {
  SurfaceDeck deck;
  deck.grain = "positions = [[3.4, 0.1, 1.2]]\nvelocity = [0.0, 0.0, -1.0]\n";
  deck.gravity = "[-0.3, 0.0, 0.1]";  // around the edge, and up against the surface from below
  deck.end = 8;
  for (const std::string& method : kMethods) {
    CAPTURE(method);
    deck.method = method;
    SimulationRun run(deck.model());
    Real worst = 0;
    while (run.time() < deck.end - 0.005) {
      run.step();
      const Vec3 c = run.particles()[0].position, from{std::max(c.x - 3, Real(0)), 0, c.z};
      const Real overlap = std::max(kRadius - norm(from), Real(0));
      const Vec3 expected = norm(from) > 0 ? -(kStiffness * overlap / norm(from)) * from : Vec3{};
      worst = std::max(worst, norm(force_on_surface(run) - expected));
    }
    CHECK(worst < 1e-12);
    CHECK(run.particles()[0].position.z < -0.5);
    CHECK(run.particles()[0].position.x < 2.5);
    CHECK(contacts_past(run.complete_state()) == 0);
  }
}

}  // namespace scree
