// Spheres and meshes of bodies, against those of the ground and of other bodies.
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"

namespace scree {

namespace {

constexpr Real kStiffness = 1e8, kSpeed = 1, kRadius = 0.05, kSphereMass = 1, kBoxMass = 2;
const Vec3 kBoxInertia{0.012, 0.02, 0.017};  // principal, along the axes of the body's frame [kg m^2]

std::string text(Vec3 v) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x, v.y, v.z); }

// The longest contact is that of the sphere with a rigid partner.
const Real kDuration = M_PI * std::sqrt(kSphereMass / kStiffness);  // [s]
constexpr Real kGap = 1e-5;                                         // [m]

std::string setup(const std::string& law, const std::string& method) {
  return fmt::format(
      "[space]\ndimension = 3\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\n[time]\nend = {:.17g}\nstep = "
      "{:.17g}\ncontrol = \"fixed\"\n[integrator]\nparticles = \"{}\"\n[[contact.pairs]]\nstiffness = "
      "{}\n{}[[meshes]]\nname = \"box\"\nkind = \"box\"\nsize = [0.2, 0.2, 0.2]\nrefine = 0.07\n",
      kGap / kSpeed + 1.2 * kDuration, kDuration / 100, method, kStiffness, law);
}
std::string sphere(Vec3 position, Vec3 velocity) {
  return "[[bodies]]\nname = \"sphere\"\nkind = \"spatial\"\nposition = " + text(position) +
         "\nvelocity = " + text(velocity) +
         fmt::format(
             "\nmass = {}\ninertia_tensor = [1e-3, 1e-3, 1e-3, 0, 0, 0]\nshapes = [{{ radius = {} }}]\n",
             kSphereMass, kRadius);
}
std::string box(Vec3 position, Vec3 velocity) {
  return "[[bodies]]\nname = \"box\"\nkind = \"spatial\"\nposition = " + text(position) +
         "\nvelocity = " + text(velocity) +
         fmt::format("\nmass = {}\ninertia_tensor = [{}, {}, {}, 0, 0, 0]\nmeshes = [{{ mesh = \"box\" }}]\n",
                     kBoxMass, kBoxInertia.x, kBoxInertia.y, kBoxInertia.z);
}

Vec3 momentum_of(const std::vector<BodyMotion>& two) {
  return kSphereMass * two[0].velocity + kBoxMass * two[1].velocity;
}
Vec3 angular_momentum_of(const std::vector<BodyMotion>& two) {
  const Vec3 w = two[1].spin;
  const Vec3 spun = rotation_matrix(two[1].orientation) *
                    Vec3{kBoxInertia.x * w.x, kBoxInertia.y * w.y, kBoxInertia.z * w.z};
  return cross(two[0].position, kSphereMass * two[0].velocity) + 1e-3 * global_spin(two[0]) +
         cross(two[1].position, kBoxMass * two[1].velocity) + spun;
}

const std::vector<std::string> kMethods = {"velocity-verlet", "hht"};

}  // namespace

// From a face, an edge and a corner, the latter where the sphere's centre lies in the direction of (1, 1,
// 1).
TEST_CASE("a body's sphere that falls on a mesh comes off its faces, edges and corners as from a mirror") {
  for (const std::string& method : kMethods)
    for (const Vec3 towards : {Vec3{0, 0, 1}, Vec3{0, 1, 1}, Vec3{1, 1, 1}}) {
      CAPTURE(method, towards.x, towards.y);
      const Vec3 normal = (1 / norm(towards)) * towards;
      const Vec3 start_position =
          0.1 * towards + (kRadius + kGap) * normal + (towards.x > 0 ? Vec3{} : Vec3{0.013, 0, 0});
      const Vec3 velocity = -kSpeed * normal + 0.3 * cross(normal, Vec3{1, 0, 0});
      SimulationRun run(model_of(setup("", method) + "[[walls]]\nname = \"box\"\nmesh = \"box\"\n" +
                                 sphere(start_position, velocity)));
      run.run();
      REQUIRE(run.particle_ledger().contacts == 0);
      const Vec3 found = run.multibody().motion(run.bodies())[0].velocity;
      const Vec3 expected = velocity + 2 * kSpeed * normal;
      // The normal rotates during the contact, by some 1e-4, and the explicit step is of second order.
      CHECK(keeps(norm(found - expected), {.promise = 1e-2, .measured = 2.1e-3}));
      CHECK(norm(global_spin(run.multibody().motion(run.bodies())[0])) < 1e-12);
    }
}

TEST_CASE("a body's mesh that falls on another body's sphere: impulse and momenta of two rigid bodies") {
  for (const std::string& method : kMethods) {
    CAPTURE(method);
    const Vec3 arm{-0.06, -0.03, -0.1};  // from the box's centre to the point of contact
    const Vec3 start_position = Vec3{0, 0, kRadius + kGap} - arm;
    SimulationRun run(model_of(setup("", method) + sphere({}, {}) + box(start_position, {0, 0, -kSpeed})));
    const auto motion = [&] { return run.multibody().motion(run.bodies()); };
    const Vec3 before = momentum_of(motion()), angular_before = angular_momentum_of(motion());
    run.run();
    REQUIRE(run.particle_ledger().contacts == 0);
    const std::vector<BodyMotion> after = motion();
    const Vec3 lever = cross(arm, {0, 0, 1});
    const Vec3 turned{lever.x / kBoxInertia.x, lever.y / kBoxInertia.y, lever.z / kBoxInertia.z};
    const Real impulse = 2 * kSpeed / (1 / kSphereMass + 1 / kBoxMass + dot(lever, turned));
    CHECK(near(after[0].velocity, {0, 0, -impulse / kSphereMass}, {.relative = 5e-3}));
    CHECK(near(after[1].velocity, {0, 0, impulse / kBoxMass - kSpeed}, {.absolute = 5e-3 * kSpeed}));
    CHECK(near(global_spin(after[1]), impulse * turned, {.relative = 5e-3}));
    CHECK(keeps(norm(momentum_of(after) - before), {.promise = 1e-9, .measured = 5e-14}));
    CHECK(keeps(norm(angular_momentum_of(after) - angular_before), {.promise = 1e-8, .measured = 1.8e-10}));
  }
}

TEST_CASE(
    "friction of a body's mesh on another body's sphere: momenta are kept, and the energy balance closes") {
  for (const std::string& method : kMethods) {
    CAPTURE(method);
    const Vec3 arm{-0.06, -0.03, -0.1};
    const Vec3 start_position = Vec3{0, 0, kRadius + kGap} - arm;
    SimulationRun run(model_of(setup("friction = 0.4\n", method) + sphere({}, {}) +
                               box(start_position, {0.5, -0.2, -kSpeed})));
    const auto motion = [&] { return run.multibody().motion(run.bodies()); };
    const Vec3 before = momentum_of(motion()), angular_before = angular_momentum_of(motion());
    run.run();
    REQUIRE(run.particle_ledger().contacts == 0);
    CHECK(norm(global_spin(motion()[0])) > 1);
    CHECK(run.particle_ledger().rotation.losses.of[kFrictionLoss] > 1e-3);
    CHECK(keeps(norm(momentum_of(motion()) - before), {.promise = 1e-9, .measured = 5e-14}));
    CHECK(
        keeps(norm(angular_momentum_of(motion()) - angular_before), {.promise = 1e-8, .measured = 1.8e-10}));
    CHECK(keeps(run.balance_error() / run.exchanged(), {.promise = 1e-2, .measured = 4e-4}));
  }
}

TEST_CASE("shapes have no contacts with meshes of connected bodies, nor with their own") {
  const std::string joint =
      "[[joints]]\nname = \"pin\"\ntype = \"spherical\"\nbodies = [\"sphere\", \"box\"]\npoint = [0, 0, 0]\n";
  SimulationRun run(model_of(setup("", "hht") + sphere({0, 0, 0.02}, {}) + box({0, 0, -0.05}, {}) + joint));
  CHECK(run.particle_ledger().contacts == 0);
  run.run();
  CHECK(run.multibody().motion(run.bodies())[0].velocity == Vec3{});
  std::string own = box({0, 0, -0.05}, {});
  own += "shapes = [{ radius = 0.05, offset = [0, 0, 0.09] }]\n";
  SimulationRun alone(model_of(setup("", "hht") + own));
  CHECK(alone.particle_ledger().contacts == 0);
}

}  // namespace scree
