// Contact histories across a ridge.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"
#include "support/test_meshes.hpp"

namespace scree {

namespace {

constexpr Real kRadius = 0.02, kMass = 0.1, kStiffness = 1e4, kFriction = 0.05, kGravity = 100;

// Two plates that share the y axis: the second is inclined downwards by this angle, upwards where it is
// negative [rad].
TriangleMesh folded(Real angle) {
  return strip({{-0.2, 0, 0}, {0, 0, 0}, {0.2 * std::cos(angle), 0, -0.2 * std::sin(angle)}}, 0.4, 8);
}

// A sphere on the first plate that moves towards the fold; heavy, so that it follows the surface.
std::string deck(const std::string& method, Real tangential_stiffness, Vec3 velocity) {
  const Real height = kRadius - kMass * kGravity / kStiffness;
  return fmt::format(
      "gravity = [0, 0, {}]\n[space]\ndimension = 3\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\n[time]\nend = "
      "0.2\nstep = 1e-4\ncontrol = \"fixed\"\n[integrator]\nparticles = \"{}\"\n[[contact.pairs]]\nstiffness "
      "= {}\nfriction = {}\ntangential_stiffness = {}\n[[meshes]]\nname = \"fold\"\nkind = "
      "\"rectangle\"\nsize = [0.1, 0.1]\n[[walls]]\nname = \"fold\"\nmesh = \"fold\"\n[[particles]]\nname = "
      "\"ball\"\nkind = \"list\"\npositions = [[-0.005, 0.2, {:.17g}]]\nvelocity = [{}, {}, 0]\nradius = "
      "{}\nmass = {}\n[output]\nhistory_contacts = [\"fold\"]\n",
      -kGravity, method, kStiffness, kFriction, tangential_stiffness, height, velocity.x, velocity.y, kRadius,
      kMass);
}

Model on_fold(Real angle, const std::string& method, Real tangential_stiffness, Vec3 velocity) {
  Model model = model_of(deck(method, tangential_stiffness, velocity), {"contact.max_start_overlap=1.0"});
  model.meshes[0].surface =
      std::make_shared<const SurfaceMesh>(build_surface_mesh(folded(angle), kFeatureAngle, true));
  return model;
}

Vec3 spring_of(const State& state) {
  REQUIRE(state.contacts.keys.size() == 1);
  return {state.contacts.values[0], state.contacts.values[1], state.contacts.values[2]};
}

// The exact contact of the sphere: over the first plate, over the edge of a ridge, over the second plate.
struct Fold {
  Real angle;
  Vec3 along{std::cos(angle), 0, -std::sin(angle)}, normal{std::sin(angle), 0, std::cos(angle)};

  bool is_past(Vec3 c) const { return angle > 0 ? dot(c, along) > 0 : dot(c, normal) < c.z; }
  bool is_on_edge(Vec3 c) const { return angle > 0 && c.x > 0 && !is_past(c); }
  // Normal of the contact.
  Vec3 normal_at(Vec3 c) const {
    if (is_past(c)) return normal;
    if (!is_on_edge(c)) return {0, 0, 1};
    return (1 / std::hypot(c.x, c.z)) * Vec3{c.x, 0, c.z};
  }
};

// Ridges and hollows on one smooth patch, and a ridge between two.
constexpr Real kDegrees[] = {20, -20, 29, 45};
const std::string kMethods[] = {"velocity-verlet", "hht"};

// A sphere with this spring force on the first plate and no further slip, and its spring over the second
// plate.
struct Carried {
  Vec3 spring;
  Real longest_error = 0;  // of its length, relative to that
  int edge_steps = 0;
};
Carried carried_over(const Fold& fold, const std::string& method, Vec3 spring) {
  const Model model = on_fold(fold.angle, method, 1e-20, {0.15, 0, 0});
  SimulationRun first(model);
  first.step();
  State state = first.complete_state();
  REQUIRE(spring_of(state) != spring);
  state.contacts.values = {spring.x, spring.y, spring.z};
  SimulationRun run(model, state);
  Carried out;
  for (int past = 0; past < 20;) {
    REQUIRE(run.time() < 0.15);
    run.step();
    out.spring = spring_of(run.complete_state());
    out.longest_error = std::max(out.longest_error, std::abs(norm(out.spring) / norm(spring) - 1));
    const Vec3 c = run.particles()[0].position;
    past += fold.is_past(c), out.edge_steps += fold.is_on_edge(c);
  }
  return out;
}

}  // namespace

TEST_CASE("a spring crosses a fold at its length, rotated into the next plane") {
  constexpr Real kConserved = 1e-12, kAcross = 1e-3, kAlong = 8e-4;  // the last two: [N]
  for (const std::string& method : kMethods)
    for (const Real degrees : kDegrees) {
      const Fold fold{degrees * M_PI / 180};
      CAPTURE(method, degrees);
      const Carried straight = carried_over(fold, method, {kAcross, 0, 0});
      CHECK((straight.edge_steps > 100) == (degrees > 0));
      CHECK(straight.longest_error < kConserved);
      CHECK(near(straight.spring, kAcross * fold.along, {.relative = kConserved}));
      // It makes the sphere spin about the next normal, and rotates with it.
      const Carried oblique = carried_over(fold, method, {kAcross, kAlong, 0});
      CHECK(oblique.longest_error < kConserved);
      CHECK(std::abs(dot(oblique.spring, fold.normal)) < kConserved * kAcross);
      CHECK(near(oblique.spring.y, kAlong, {.relative = 1e-3}));
    }
}

TEST_CASE("friction of a sphere that slides over a fold is at Coulomb's limit and never beyond it") {
  constexpr Real kRoundOff = 1e-13;  // relative to the limit
  for (const std::string& method : kMethods)
    for (const Real degrees : kDegrees) {
      const Fold fold{degrees * M_PI / 180};
      CAPTURE(method, degrees);
      SimulationRun run(on_fold(fold.angle, method, 2.0 / 7 * kStiffness, {0.5, 0.1, 0}));
      int sliding = 0, past = 0, edge_steps = 0, wrong = 0;
      while (past < 30) {
        REQUIRE(run.time() < 0.15);
        run.step();
        const Vec3 c = run.particles()[0].position, n = fold.normal_at(c);
        const std::vector<Real> on_fold = run.contact_values();
        const Vec3 force{on_fold[0], on_fold[1], on_fold[2]};
        const Real push = -dot(force, n), limit = kFriction * push, tangential = norm(force + push * n);
        wrong += !(push > 0) || tangential > (1 + kRoundOff) * limit;
        sliding += tangential > (1 - kRoundOff) * limit;
        past += fold.is_past(c), edge_steps += fold.is_on_edge(c);
      }
      CHECK(wrong == 0);
      CHECK(sliding > past + edge_steps);
      CHECK((edge_steps > 100) == (degrees > 0));
    }
}

}  // namespace scree
