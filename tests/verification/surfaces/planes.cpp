// A plane made of triangles against an analytic one, through decks.
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "mesh/surface_mesh.hpp"
#include "physics/spatial_rotation.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"
#include "support/state_bits.hpp"
#include "support/test_meshes.hpp"
#include "verification/surfaces/particles.hpp"

namespace scree {

namespace {

constexpr Real kTrajectory = 1e-10;  // relative to the displacement

// The rectangle from -1 to 3 in x and y at z = 0, cut in many ways.
std::vector<std::pair<std::string, TriangleMesh>> triangulations() {
  const auto over = [](const TriangleMesh& unit, Real sx, Real sy) {
    return mapped(unit, [&](Vec3 v) { return Vec3{-1 + 4 * sx * v.x, -1 + 4 * sy * v.y, 0}; });
  };
  std::vector<std::pair<std::string, TriangleMesh>> meshes;
  meshes.emplace_back("two triangles", over(unit_grid(1, 1), 1, 1));
  meshes.emplace_back("squares", over(unit_grid(7, 7), 1, 1));
  meshes.emplace_back("small squares", over(unit_grid(200, 200), 1, 1));
  meshes.emplace_back("slivers along x", over(unit_grid(1, 1000), 1, 1));
  meshes.emplace_back("slivers along y", over(unit_grid(1000, 1), 1, 1));
  for (const int n : {5, 40, 120})
    meshes.emplace_back(fmt::format("jittered {}", n), over(jittered_grid(n, 7), 1, 1));
  meshes.emplace_back("a kilometre", over(unit_grid(3, 3), 250, 250));
  return meshes;
}

Model with_floor(const Model& of_rectangle, const TriangleMesh& floor) {
  Model model = of_rectangle;
  model.meshes[0].surface =
      std::make_shared<const SurfaceMesh>(build_surface_mesh(welded(floor), kFeatureAngle, true));
  return model;
}

const std::string kPlane = "[[walls]]\nname = \"floor\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n";
const std::string kMesh =
    "[[meshes]]\nname = \"floor\"\nkind = \"rectangle\"\nsize = [2.0, 2.0]\n[[walls]]\nname = "
    "\"floor\"\nmesh = "
    "\"floor\"\n";
// A plane with a new pose in every step, at its old position; a state has the force on it.
const std::string kStill =
    "motions = [{ type = \"translation\", direction = [1, 0, 0], displacement = 0 }]\n";
const std::string kWrench = "bodies/wrench ";

State end_of(const Model& model) {
  SimulationRun run(model);
  run.run();
  return run.complete_state();
}

}  // namespace

TEST_CASE(
    "whatever the triangulation of a plane along the axes, particles with friction have the plane's bits") {
  for (const std::string method : {"velocity-verlet", "hht"}) {
    const std::string deck = falling_grains(method);
    const State plane = end_of(model_of(deck + kPlane));
    const Model rectangle = model_of(deck + kMesh);
    for (const auto& [name, mesh] : triangulations()) {
      CAPTURE(method, name);
      const State on_mesh = end_of(with_floor(rectangle, mesh));
      CHECK(differing_arrays(pack(on_mesh), pack(plane)) == "");
    }
  }
}

TEST_CASE(
    "particles that stick to a plane of triangles, or to a moving plane, keep the bits of a static one") {
  const std::string powder =
      "[[materials]]\nname = \"powder\"\nyoung_modulus = 1e6\npoisson_ratio = 0.3\n[[contact.pairs]]\n"
      "restitution = 0.6\n";
  const std::string friction_keys = "friction = 0.4\ntangential_damping_ratio = 0.1\n";
  const std::string pull = "[[contact.pairs]]\nstiffness = 1e4\nrestitution = 0.6\nattraction = 0.3\n";
  const std::vector<std::string> laws = {
      powder + "work_of_adhesion = 20\n",
      powder + "work_of_adhesion = 5\nrolling_friction = 0.2\ntwisting_friction = 0.2\n" + friction_keys,
      powder + "work_of_adhesion = 5\nadhesion = \"dmt\"\n" + friction_keys,
      pull,
      pull + "attraction_range = 1e-3\n",
      pull + "attraction_range = 1e-3\n" + friction_keys};
  const std::vector<std::pair<std::string, TriangleMesh>> cut = triangulations();
  for (const std::string& law : laws) {
    CAPTURE(law);
    const std::string deck = falling_grains("velocity-verlet", law);
    const State plane = end_of(model_of(deck + kPlane));
    const Model rectangle = model_of(deck + kMesh);
    for (const std::size_t k : {1u, 3u, 6u}) {
      CAPTURE(cut[k].first);
      State on_mesh = end_of(with_floor(rectangle, cut[k].second));
      CHECK(state_hash(on_mesh, true) == state_hash(plane, true));
      if (!plane.contacts.content.exists())
        on_mesh.contacts = {};  // contacts that began above the open surface
      CHECK(differing_arrays(pack(on_mesh), pack(plane)) == "");
    }
    const State on_posed = end_of(model_of(deck + kPlane + kStill));
    CHECK(differing_arrays(pack(on_posed), pack(plane)) == kWrench);
  }
}

TEST_CASE("particles that slide through periodic sides keep their springs on a moving plane") {
  const std::string slick = "[[contact.pairs]]\nstiffness = 1e4\nrestitution = 0.6\nfriction = 0.02\n";
  const std::string deck = falling_grains("velocity-verlet", slick);
  Model still = model_of(deck + kPlane + kStill);
  const State at_rest = end_of(model_of(deck + kPlane)), placed = end_of(still);
  CHECK(differing_arrays(pack(placed), pack(at_rest)) == kWrench);
  still.contact.skin = 1e-9;  // particles are wrapped in every step
  const State wrapped = end_of(still);
  CHECK(differing_arrays(pack(wrapped), pack(placed)) == "");
}

TEST_CASE("the upper side of a block has the plane's bits of positions, velocities and spins") {
  const std::string deck = falling_grains("velocity-verlet");
  const std::string block =
      "[[meshes]]\nname = \"floor\"\nkind = \"box\"\nsize = [4.0, 4.0, 1.0]\noffset = [1.0, 1.0, "
      "-0.5]\nrefine = "
      "0.3\n[[walls]]\nname = \"floor\"\nmesh = \"floor\"\n";
  SimulationRun on_plane(model_of(deck + kPlane)), on_block(model_of(deck + block));
  on_plane.run(), on_block.run();
  const std::vector<Particle> a = on_plane.particles(), b = on_block.particles();
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK(a[i].position == b[i].position);
    CHECK(a[i].velocity == b[i].velocity);
    CHECK(a[i].angular_velocity == b[i].angular_velocity);
  }
}

TEST_CASE("on a tilted plane of triangles particles move as on the analytic one") {
  for (const Real angle : {0.1, 0.7, 2.0, 3.1}) {
    const Mat3 a = rotation_matrix(exponential(angle * (1 / std::sqrt(3.0)) * Vec3{1, -1, 1}));
    const auto text = [](Vec3 v) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x, v.y, v.z); };
    const Vec3 normal = a * Vec3{0, 0, 1}, along = a * Vec3{1, 0, 0};
    const std::string deck = sliding_grain(text(0.0199 * normal), text(0.8 * along), text(-9.81 * normal));
    SimulationRun plane(
        model_of(deck + "[[walls]]\nname = \"floor\"\npoint = [0, 0, 0]\nnormal = " + text(normal)));
    Model tilted = model_of(deck + kMesh, {"contact.max_start_overlap=1.0"});
    tilted = with_floor(tilted, rotated(mapped(jittered_grid(30, 3),
                                               [](Vec3 v) {
                                                 return Vec3{4 * v.x - 2, 4 * v.y - 2, 0};
                                               }),
                                        a));
    SimulationRun mesh(tilted);
    plane.run(), mesh.run();
    CAPTURE(angle);
    const Particle p = plane.particles()[0], m = mesh.particles()[0];
    CHECK(norm(p.position) > 0.3);
    CHECK(near(m.position, p.position, {.relative = kTrajectory}));
    CHECK(near(m.velocity, p.velocity, {.relative = kTrajectory}));
    CHECK(near(m.angular_velocity, p.angular_velocity, {.relative = kTrajectory}));
  }
}

TEST_CASE(
    "a sphere thrown along a floor of small triangles rolls at 5/7 of its speed, with the plane's bits") {
  const std::string deck = sliding_grain("[0.0, 0.0, 0.02]", "[0.8, 0.0, 0.0]", "[0.0, 0.0, -9.81]");
  SimulationRun plane(model_of(deck + kPlane)),
      mesh(with_floor(model_of(deck + kMesh), mapped(jittered_grid(400, 5), [](Vec3 v) {
                        return Vec3{2 * v.x - 0.5, 2 * v.y - 1, 0};
                      })));
  plane.run(), mesh.run();
  const Particle p = plane.particles()[0], m = mesh.particles()[0];
  CHECK(near(m.velocity.x, 0.8 * 5 / 7, {.relative = 1e-4}));
  CHECK(m.position == p.position);
  CHECK(m.velocity == p.velocity);
  CHECK(m.angular_velocity == p.angular_velocity);
}

}  // namespace scree
