// Bodies of one sphere, and blocks of spheres, on planes and on the same planes of triangles: sliding,
// rolling and sticking.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "mesh/surface_mesh.hpp"
#include "physics/spatial_rotation.hpp"
#include "support/bars.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"
#include "support/test_meshes.hpp"

namespace scree {

namespace {

constexpr Real kGravity = 9.81, kStiffness = 1e5, kFriction = 0.4, kStep = 1e-4;
const std::vector<std::string> kMethods = {"velocity-verlet", "hht"};

std::string text(Vec3 v) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x, v.y, v.z); }

// A rotated floor z = 0, and the deck on it.
struct Floor {
  Mat3 turn = identity3();
  bool of_triangles = false;
  Vec3 normal() const { return turn * Vec3{0, 0, 1}; }
};

// slope: angle between gravity and the floor's normal, down along its x [rad]; extra: keys of the pair.
Model model_on(const Floor& floor, const std::string& body, Real slope, Real end, const std::string& method,
               const std::string& extra = "") {
  const Vec3 gravity = kGravity * (floor.turn * Vec3{std::sin(slope), 0, -std::cos(slope)});
  Model model = model_of(
      "gravity = " + text(gravity) +
      fmt::format("\n[space]\ndimension = 3\nmin = [-9, -9, -9]\nmax = [9, 9, 9]\n[time]\nend = {}\nstep = "
                  "{}\ncontrol = \"fixed\"\n[integrator]\nparticles = \"{}\"\n[contact]\nmax_start_overlap = "
                  "1.0\n[[contact.pairs]]\nstiffness = {}\nrestitution = 0.2\nfriction = {}\n"
                  "tangential_damping_ratio = 0.3\n{}",
                  end, kStep, method, kStiffness, kFriction, extra) +
      (floor.of_triangles
           ? "[[meshes]]\nname = \"floor\"\nkind = \"rectangle\"\nsize = [2, 2]\n[[walls]]\n"
             "name = \"floor\"\nmesh = \"floor\"\n"
           : "[[walls]]\nname = \"floor\"\npoint = [0, 0, 0]\nnormal = " + text(floor.normal()) + "\n") +
      body + "[output]\nhistory_interval = 0.1\n");
  if (floor.of_triangles) {
    const TriangleMesh flat = mapped(jittered_grid(40, 3), [](Vec3 v) {
      return Vec3{12 * v.x - 6, 12 * v.y - 6, 0};
    });
    model.meshes[0].surface = std::make_shared<const SurfaceMesh>(
        build_surface_mesh(rotated(flat, floor.turn), kFeatureAngle, true));
  }
  return model;
}

std::string spatial_body(const Floor& floor, Vec3 start_position, Vec3 velocity, Real mass, Real inertia,
                         const std::string& shapes) {
  const Quaternion q = quaternion_of(floor.turn);
  return "[[bodies]]\nname = \"body\"\nkind = \"spatial\"\nposition = " + text(floor.turn * start_position) +
         "\nvelocity = " + text(floor.turn * velocity) +
         fmt::format(
             "\nquaternion = [{:.17g}, {:.17g}, {:.17g}, {:.17g}]\nmass = {}\ninertia_tensor = [{}, {}, "
             "{}, 0, 0, 0]\nshapes = {}\n",
             q.w, q.x, q.y, q.z, mass, inertia, inertia, inertia, shapes);
}

constexpr Real kRadius = 0.1, kMass = 2, kSpeed = 3;
std::string ball(const Floor& floor, Real speed = kSpeed) {
  const Vec3 start_position{0, 0, kRadius - kMass * kGravity / kStiffness};
  return spatial_body(floor, start_position, {speed, 0, 0}, kMass, 0.4 * kMass * kRadius * kRadius,
                      fmt::format("[{{ radius = {} }}]", kRadius));
}

// Four spheres under a heavy plate.
constexpr Real kFoot = 0.05;
std::string block(const Floor& floor, Real slope) {
  const Real sunk = kMass * kGravity * std::cos(slope) / 4 / kStiffness;
  std::string shapes;
  for (const char* at : {"0.2, 0.1", "0.2, -0.1", "-0.2, 0.1", "-0.2, -0.1"})
    shapes += fmt::format("{{ radius = {}, offset = [{}, -0.04] }}, ", kFoot, at);
  return spatial_body(floor, {-2, 0.3, 0.04 + kFoot - sunk}, {}, kMass, 0.03, "[" + shapes + "]");
}

Vec3 position(const SimulationRun& run) { return run.multibody().motion(run.bodies())[0].position; }
Vec3 velocity(const SimulationRun& run) { return run.multibody().motion(run.bodies())[0].velocity; }

const Floor kTilted{rotation_matrix(exponential({0.3, -0.7, 0.5}))};

// On an incline of 0.3 rad, after settling; the time in s.
void check_creep(Real time) {
  constexpr Real kSlope = 0.3, kSettling = 1.2;
  for (const std::string& method : kMethods)
    for (const bool triangles : {false, true}) {
      CAPTURE(method, triangles);
      Floor floor = kTilted;
      floor.of_triangles = triangles;
      SimulationRun run(model_on(floor, block(floor, kSlope), kSlope, kSettling + time, method));
      run.run_until(kSettling);
      const Vec3 settled = position(run);
      run.run();
      CHECK(norm(position(run) - settled) < 1e-12);
      CHECK(norm(velocity(run)) < 1e-11);
    }
}

}  // namespace

TEST_CASE("a body's sphere goes from sliding to rolling with 5/7 of its speed, on a plane and on triangles") {
  const Real end = 2 * kSpeed / (7 * kFriction * kGravity) + 0.4;
  for (const std::string& method : kMethods) {
    CAPTURE(method);
    SimulationRun plane(model_on({}, ball({}), 0, end, method));
    SimulationRun mesh(model_on({.of_triangles = true}, ball({}), 0, end, method));
    Floor tilted = kTilted;
    SimulationRun tilted_plane(model_on(tilted, ball(tilted), 0, end, method));
    tilted.of_triangles = true;
    SimulationRun tilted_mesh(model_on(tilted, ball(tilted), 0, end, method));
    for (SimulationRun* run : {&plane, &mesh, &tilted_plane, &tilted_mesh}) run->run();
    CHECK(keeps(velocity(plane).x / kSpeed - 5.0 / 7, {.promise = 1e-9, .measured = 1e-13}));
    CHECK(keeps(norm(velocity(tilted_mesh)) / kSpeed - 5.0 / 7, {.promise = 1e-9, .measured = 1e-12}));
    CHECK(mesh.bodies().position == plane.bodies().position);
    CHECK(mesh.bodies().velocity == plane.bodies().velocity);
    CHECK(near(position(tilted_mesh), position(tilted_plane), {.relative = 1e-10}));
    CHECK(near(velocity(tilted_mesh), velocity(tilted_plane), {.relative = 1e-10}));
    // Fraction of the kinetic energy dissipated by sliding: 2/7.
    const ParticleLedger ledger = plane.particle_ledger();
    CHECK(near(ledger.rotation.losses.of[kFrictionLoss], kMass * kSpeed * kSpeed / 7, {.relative = 1e-3}));
    CHECK(ledger.rotation.losses.of[kFrictionLoss] <= ledger.contact_loss);
    CHECK(keeps(plane.balance_error() / plane.exchanged(), {.promise = 2e-3, .measured = 4.6e-4}));
  }
}

TEST_CASE("a block of four spheres slides down an incline of triangles with g (sin - mu cos)") {
  constexpr Real kSlope = 0.5;  // the angle of friction is 0.38
  const Real expected = kGravity * (std::sin(kSlope) - kFriction * std::cos(kSlope));
  for (const std::string& method : kMethods)
    for (const bool triangles : {false, true}) {
      CAPTURE(method, triangles);
      Floor floor = kTilted;
      floor.of_triangles = triangles;
      SimulationRun run(model_on(floor, block(floor, kSlope), kSlope, 1.2, method));
      run.run_until(0.7);
      const Real from = run.time();
      const Vec3 before = velocity(run);
      run.run();
      const Vec3 along = floor.turn * Vec3{1, 0, 0};
      const Real found = dot(velocity(run) - before, along) / (run.time() - from);
      CHECK(keeps(found / expected - 1, {.promise = 1e-9, .measured = 1e-12}));
    }
}

TEST_CASE("a block of four spheres below its angle of friction sticks and does not creep") { check_creep(2); }

// A million steps.
TEST_CASE("a block of four spheres below its angle of friction does not creep for long", "[.][long]") {
  check_creep(100);
}

// EPSD springs: the sphere oscillates, and stays in place.
TEST_CASE("a body's sphere that resists rolling stays on an incline below its angle of rolling friction") {
  constexpr Real kPush = 0.3, kEnd = 3, kRollingFriction = 0.2, kSteep = 0.25;
  const std::string rolling =
      fmt::format("rolling_friction = {}\nrolling_damping_ratio = 0.3\n", kRollingFriction);
  for (const std::string& method : kMethods)
    for (const bool triangles : {false, true}) {
      CAPTURE(method, triangles);
      const Floor floor{.of_triangles = triangles};
      const auto down = [&](Real slope) {
        return model_on(floor, ball(floor, kPush), slope, kEnd, method, rolling);
      };
      SimulationRun stays(down(0.15)), rolls(down(kSteep));
      stays.run(), rolls.run_until(1);
      const Real from = rolls.time();
      const Vec3 before = velocity(rolls);
      rolls.run();
      CHECK(norm(velocity(stays)) < 1e-9);
      CHECK(stays.particle_ledger().rotation.losses.of[kRollingLoss] > 0.5 * kMass * kPush * kPush);
      const Real expected = 5.0 / 7 * kGravity * (std::sin(kSteep) - kRollingFriction * std::cos(kSteep));
      CHECK(near((velocity(rolls).x - before.x) / (rolls.time() - from), expected, {.relative = 1e-6}));
    }
}

}  // namespace scree
