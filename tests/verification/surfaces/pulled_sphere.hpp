// A heavy sphere beside surfaces that attract it, through decks: targets that are pulled off it.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"
#include "support/state_bits.hpp"

namespace scree {

// Radius of the sphere, and its E* on a rigid partner.
inline constexpr Real kRadius = 1e-3, kYoung = 1e5;

// A heavy sphere in touch with a target at z = 0 below it.
struct CohesiveDeck {
  std::string target;  // tables of the contact record's "target"
  std::string law;     // keys of the pairs of grains with each other and with the target
  Real step = 1e-6, end = 1.2e-3;
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

inline constexpr Real kSpeed = 0.03;  // speed of targets that separate from the sphere [m/s]

inline std::string moved(const std::string& wall) {
  return "[[walls]]\nname = \"target\"\nmaterial = \"stiff\"\n" + wall +
         fmt::format(
             "motions = [{{ type = \"translation\", direction = [0, 0, -1], displacement = {{ kind = "
             "\"ramp\", rate = {} }} }}]\n",
             kSpeed);
}
inline std::string box(const std::string& place) {
  return "[[meshes]]\nname = \"box\"\nkind = \"box\"\nsize = [0.01, 0.01, 0.01]\n" + place;
}
inline std::string body(const std::string& surface) {
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

inline Pull pull_apart(const CohesiveDeck& deck) {
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

struct PulledTarget {
  std::string name, target;
  Real radius;  // R* [m]
};

// Surfaces of all kinds that move away from the sphere.
inline std::vector<PulledTarget> pulled_targets() {
  const std::string corner =
      fmt::format("rotation_axis = [1, -1, 0]\nrotation_angle = {:.17g}\n", std::acos(1 / std::sqrt(3.0)));
  const std::string on_body = "meshes = [{ mesh = \"box\", material = \"stiff\" }]\n";
  return {{"plane", moved("point = [0, 0, 0]\nnormal = [0, 0, 1]\n"), kRadius},
          {"face", box("offset = [0, 0, -0.005]\nrefine = 0.002\n") + moved("mesh = \"box\"\n"), kRadius},
          {"edge",
           box(fmt::format("rotation_axis = [0, 1, 0]\nrotation_angle = {:.17g}\noffset = [0, 0, {:.17g}]\n",
                           std::numbers::pi_v<Real> / 4, -0.005 * std::sqrt(2.0))) +
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
}

// Pulls a refined face sideways under the sphere, until the sphere is beyond its edge, while it sinks: the
// force depends on the distance alone, beyond touch and around the edge. pair: the law for the sphere on a
// plane; sinking: speed away from the sphere [m/s].
template <class Pair>
void slide_over_an_edge(const std::string& law, const Pair& pair, Real sinking) {
  constexpr Real kEdge = 5.0003e-4, kAcross = 1;
  const auto ramp = [](const char* direction, Real rate) {
    return fmt::format(
        "{{ type = \"translation\", direction = {}, displacement = {{ kind = \"ramp\", rate = {} }} }}",
        direction, rate);
  };
  const CohesiveDeck deck{
      .target = box(fmt::format("offset = [{:.17g}, 0.0002, -0.005]\nrefine = 0.0003\n", kEdge - 0.005)) +
                "[[walls]]\nname = \"target\"\nmaterial = \"stiff\"\nmesh = \"box\"\nmotions = [" +
                ramp("[-1, 0, 0]", kAcross) + ", " + ramp("[0, 0, -1]", sinking) + "]\n",
      .law = law};
  SimulationRun run(deck.model());
  int beyond_touch = 0, past_edge = 0;
  while (run.particle_ledger().contacts > 0) {
    REQUIRE(run.time() < 0.9e-3);
    run.step();
    const Vec3 p = run.particles()[0].position;
    const Real over = p.z + sinking * run.time(), past = std::max(p.x - (kEdge - kAcross * run.time()), 0.0);
    const Real overlap = kRadius - std::sqrt(over * over + past * past);
    const std::vector<Real> on_target = run.contact_values();
    const Real pull = norm(Vec3{on_target[0], on_target[1], on_target[2]});
    if (overlap < -0.999 * pair.interaction_range()) continue;
    const Real largest = std::abs(pair.elastic(-1e-9));
    CHECK(near(pull, std::abs(pair.elastic(overlap)), {.relative = 1e-8, .absolute = 1e-9 * largest}));
    beyond_touch += overlap<0, past_edge += past> 0;
  }
  CHECK(beyond_touch > 300);
  CHECK(past_edge > 50);
}

// Restarts a run in which surfaces that move away from the sphere are `stretched` [m] from it and still
// attract it, and repeats it with short-lived lists. law: with an attraction.
inline void restart_under_tension(std::string law, Real stretched) {
  law += "restitution = 0.5\nfriction = 0.4\ntangential_damping_ratio = 0.1\nrolling_friction = 0.1\n";
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
    while (!(gap() > stretched)) first.step();
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
