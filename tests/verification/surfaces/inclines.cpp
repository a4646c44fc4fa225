// Spheres with rolling resistance on tilted planes of triangles.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "physics/spatial_rotation.hpp"
#include "support/backends.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"
#include "support/test_meshes.hpp"

namespace scree {

namespace {

constexpr Real kRadius = 0.02, kMass = 0.1, kStiffness = 2e3, kGravity = 9.81, kStep = 1e-4,
               kRollingFriction = 0.3;
constexpr Real kSame = 1e-12, kTrajectory = 1e-10;  // relative to the weight, to the displacement
// Axes of rotations.
const Vec3 kSlanted = (1 / std::sqrt(3.0)) * Vec3{1, -1, 1}, kLevel = (1 / std::sqrt(2.0)) * Vec3{1, 1, 0};

std::string text(Vec3 v) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x, v.y, v.z); }

struct Grain {
  Vec3 position, velocity, gravity;
  Real end;  // [s]
};

std::string deck(const Grain& grain) {
  return "gravity = " + text(grain.gravity) +
         fmt::format(
             "\n[space]\ndimension = 3\nmin = [-3, -3, -3]\nmax = [3, 3, 3]\n[time]\nend = {}\nstep = "
             "{}\ncontrol = \"fixed\"\n[integrator]\nparticles = "
             "\"velocity-verlet\"\n[contact]\nmax_start_overlap = "
             "1.0\n[[contact.pairs]]\nstiffness = {}\nrestitution = 0.5\nfriction = "
             "0.4\ntangential_damping_ratio = 0.3\nrolling_friction = {}\nrolling_damping_ratio = "
             "0.3\n",
             grain.end, kStep, kStiffness, kRollingFriction) +
         "[[particles]]\nname = \"grain\"\nkind = \"list\"\npositions = [" + text(grain.position) +
         "]\nvelocity = " + text(grain.velocity) + fmt::format("\nradius = {}\nmass = {}\n", kRadius, kMass);
}

using Settings = std::vector<std::string>;
Model on_plane(const Grain& grain, Vec3 normal, const Settings& settings = {}) {
  return model_of(deck(grain) + "[[walls]]\nname = \"floor\"\npoint = [0, 0, 0]\nnormal = " + text(normal),
                  settings);
}
// The plane of on_plane() as triangles, 1 m wide.
Model on_triangles(const Grain& grain, const Mat3& turn, int n, const Settings& settings = {}) {
  Model model = model_of(deck(grain) +
                             "[[meshes]]\nname = \"floor\"\nkind = \"rectangle\"\nsize = [2, "
                             "2]\n[[walls]]\nname = \"floor\"\nmesh = \"floor\"\n",
                         settings);
  const TriangleMesh flat = mapped(jittered_grid(n, 3), [](Vec3 v) { return Vec3{v.x - 0.5, v.y - 0.5, 0}; });
  model.meshes[0].surface =
      std::make_shared<const SurfaceMesh>(build_surface_mesh(rotated(flat, turn), kFeatureAngle, true));
  return model;
}

// The rotated plane z = 0.
struct Tilt {
  Mat3 turn;
  Vec3 normal;
  explicit Tilt(Vec3 rotation) : turn(rotation_matrix(exponential(rotation))), normal(turn * Vec3{0, 0, 1}) {}
};

// A sphere laid on an incline.
Grain laid(const Tilt& tilt, Real end) {
  const Vec3 place = tilt.turn * Vec3{0.013, 0.021, kRadius - 4e-4};
  return {place, {}, {0, 0, -kGravity}, end};
}

}  // namespace

// Angles of friction and of rolling friction: 0.38 and 0.29.
TEST_CASE("a sphere on an incline of triangles below its angles of friction stays for 1e6 steps") {
  constexpr Real kSettling = 4;                // [s]
  Real time = tests_on_gpu() ? Real(2) : 100;  // where a step of one sphere costs a kernel launch
  Settings settings;
  SECTION("in explicit steps") {}
  SECTION("in implicit steps, a fifth of the time in steps that are twice as long") {
    settings = {"integrator.particles=hht", "time.step=2e-4"}, time /= 5;
  }
  const Tilt tilt(0.28 * kLevel);
  SimulationRun run(on_triangles(laid(tilt, kSettling + time), tilt.turn, 300, settings));
  run.run_until(kSettling);
  const Vec3 settled = run.particles()[0].position;
  CHECK(norm(settled) < 0.1);
  Real creep = 0;
  for (int k = 1; k <= 10; ++k) {
    run.run_until(kSettling + time / 10 * k);
    creep = std::max(creep, norm(run.particles()[0].position - settled));
  }
  CAPTURE(creep);
  CHECK(creep < 1e-12);
}

TEST_CASE(
    "a sphere on an incline of triangles above its angle of rolling friction rolls down as on the plane") {
  Settings settings;
  SECTION("in explicit steps") {}
  SECTION("in implicit steps") { settings = {"integrator.particles=hht"}; }
  const Tilt tilt(0.31 * kLevel);
  const Grain grain = laid(tilt, 1);
  SimulationRun mesh(on_triangles(grain, tilt.turn, 100, settings)),
      plane(on_plane(grain, tilt.normal, settings));
  mesh.run_until(0.5);
  const Vec3 before = mesh.particles()[0].velocity;
  mesh.run(), plane.run();
  const Particle m = mesh.particles()[0], p = plane.particles()[0];
  CHECK(near(m.position, p.position, {.relative = kTrajectory}));
  CHECK(near(m.velocity, p.velocity, {.relative = kTrajectory}));
  // Its mass and the rotational one, 2/5 of it, under gravity down the slope and mu_r N R over R up.
  const Real expected = 5.0 / 7 * kGravity * (std::sin(0.31) - kRollingFriction * std::cos(0.31));
  CHECK(near(norm(m.velocity - before), 0.5 * expected, {.relative = 1e-6}));
}

// One step from the plane's state with its springs: positions and normals are rounded, nothing else differs.
TEST_CASE("one state on a tilted plane and on the same plane of triangles: the same forces and moments") {
  for (const Vec3 rotation : {Vec3{}, 0.1 * kSlanted, 0.7 * kSlanted, 2.0 * kSlanted, 3.1 * kSlanted}) {
    const Tilt tilt(rotation);
    const Grain grain{(kRadius - 4e-4) * tilt.normal, 1.5 * (tilt.turn * Vec3{1, 0.2, 0}),
                      -kGravity * tilt.normal, 0.6};
    const Model plane_model = on_plane(grain, tilt.normal), mesh_model = on_triangles(grain, tilt.turn, 30);
    SimulationRun plane(plane_model), mesh(mesh_model);
    for (const Real t : {0.001, 0.05, 0.2, 0.4}) {
      plane.run_until(t);
      const State state = plane.complete_state();
      SimulationRun one(plane_model, state), other(mesh_model, state);
      one.step(), other.step();
      const Particle p = one.particles()[0], m = other.particles()[0];
      CHECK(near(m.acceleration, p.acceleration, {.absolute = kSame * kGravity}));
      CHECK(near(m.angular_acceleration, p.angular_acceleration,
                 {.absolute = kSame * kGravity * kMass * kRadius / p.moment_of_inertia}));
    }
    plane.run(), mesh.run();
    const Particle p = plane.particles()[0], m = mesh.particles()[0];
    CAPTURE(norm(rotation));
    CHECK(norm(p.position) > 0.3);
    CHECK(p.rolling_loss > 0.3 * kMass * 1.5 * 1.5 / 2);
    CHECK(near(m.position, p.position, {.relative = kTrajectory}));
    CHECK(near(m.velocity, p.velocity, {.relative = kTrajectory}));
    CHECK(near(m.angular_velocity, p.angular_velocity, {.relative = kTrajectory}));
    CHECK(near(m.rolling_loss, p.rolling_loss, {.relative = kTrajectory}));
    if (rotation == Vec3{}) {
      CHECK(m.position == p.position);
      CHECK(m.velocity == p.velocity);
      CHECK(m.angular_velocity == p.angular_velocity);
    }
  }
}

}  // namespace scree
