// Fields of triangles in snapshots.
#include "run/record/mesh_surfaces.hpp"

#include <algorithm>

#include "mesh/surface_mesh.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"

namespace scree {

namespace {

// A ball that falls on a box of small triangles and slides over it.
const std::string kBall = R"(
[space]
dimension = 3
min = [-1.0, -1.0, -1.0]
max = [1.0, 1.0, 1.0]
[time]
step = 1e-6
control = "fixed"
end = 1.0e-5
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = 1e4
damping = 1.0
friction = 0.1
tangential_stiffness = 1e8
wear_coefficient = 2e-12
[[meshes]]
name = "box"
kind = "box"
size = [0.4, 0.2, 0.1]
offset = [0.1, 0.0, 0.0]
refine = 0.05
[[walls]]
name = "box"
mesh = "box"
[[particles]]
name = "ball"
kind = "list"
positions = [[0.19, -0.053, 0.098]]
radius = 0.05
density = 1000.0
velocity = [0.3, 0.0, -0.4]
[output]
surface_fields = ["sliding_work", "wear_depth", "impact_work"]
)";

// A disc that rests on the second segment of a line, on a conveyor with wear.
const std::string kDisc = R"(
gravity = [0.0, -10.0]
[space]
dimension = 2
min = [-{half}, -{half}]
max = [{half}, {half}]
[time]
step = 1e-4
control = "fixed"
end = 0.1
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = 1e4
damping = 100.0
friction = 0.1
tangential_stiffness = 1e4
wear_coefficient = 2e-9
[[meshes]]
name = "line"
kind = "line"
points = [[-0.5, 0.0], [-0.1, 0.0], [0.1, 0.0], [0.5, 0.0]]
[[walls]]
name = "line"
mesh = "line"
surface_velocity = [1.0, 0.0]
[[particles]]
name = "disc"
kind = "list"
positions = [[0.0, 0.049]]
radius = 0.05
mass = 1.0
[output]
surface_fields = ["pressure", "shear", "sliding_work", "wear_depth"]
)";

}  // namespace

TEST_CASE("in 2D a segment has its load and its wear per length, however large the space is") {
  for (const char* half : {"1.0", "20.0"}) {
    CAPTURE(half);
    std::string text = kDisc;
    for (std::size_t at = text.find("{half}"); at != std::string::npos; at = text.find("{half}"))
      text.replace(at, 6, half);
    const Model model = model_of(text);
    SimulationRun run(model);
    run.run();
    const MeshSurfaces surfaces(model);
    // One of the two triangles of the segment has the whole value.
    const std::vector<Index>& numbers = model.meshes[0].surface->original;
    const auto second = static_cast<Index>(std::ranges::find(numbers, 2) - numbers.begin());
    const std::vector<TriangleLoad> loads{{0, second, 10, {1, 0, 0}}};
    const MeshSurfaces::Sample sample = surfaces.sample(std::vector<BodyMotion>(SurfaceSet(model).parents()),
                                                        loads, run.complete_state().works);
    REQUIRE(sample.pressure.size() == 6);
    Real slid = 0;
    for (const Real work : sample.sliding_work) slid += work;
    CHECK(slid > 0.05);
    for (std::size_t t = 0; t < 6; ++t) {
      const bool touched = t == 2 || t == 3;
      CHECK(near(sample.pressure[t], touched ? 50 : 0, {.absolute = 1e-12}));
      CHECK(near(sample.shear[t].x, touched ? 5 : 0, {.absolute = 1e-12}));
      CHECK(near(sample.wear_depth[t], touched ? 2e-9 / 0.1 * slid / 0.2 : 0, {.relative = 1e-12}));
    }
  }
}

TEST_CASE(
    "a snapshot has the dissipated work and the wear that the deck asks for, where there are contacts") {
  const Model model = model_of(kBall);
  SimulationRun run(model);
  run.run();
  const State& state = run.complete_state();
  const MeshSurfaces surfaces(model);
  const MeshSurfaces::Sample sample =
      surfaces.sample(std::vector<BodyMotion>(SurfaceSet(model).parents()), {}, state.works);
  CHECK(sample.pressure.empty());
  CHECK(sample.shear.empty());
  const SeriesTriangles triangles = surfaces.triangles();
  REQUIRE(std::ssize(sample.impact_work) == triangles.count());
  int touched = 0;
  for (std::size_t t = 0; t < sample.impact_work.size(); ++t) {
    Vec3 corner[3], lowest = sample.position[static_cast<std::size_t>(triangles.corners[3 * t])],
                    highest = lowest;
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = sample.position[static_cast<std::size_t>(triangles.corners[3 * t + k])];
      lowest = {std::min(lowest.x, corner[k].x), std::min(lowest.y, corner[k].y), 0};
      highest = {std::max(highest.x, corner[k].x), std::max(highest.y, corner[k].y), 0};
    }
    const Real area = norm(cross(corner[1] - corner[0], corner[2] - corner[0])) / 2;
    CHECK(near(sample.wear_depth[t] * area, 2e-12 / 0.1 * sample.sliding_work[t], {.relative = 1e-12}));
    if (sample.impact_work[t] == 0) continue;
    ++touched;
    const Particle& ball = state.particles.at(0);
    CHECK(near(sample.impact_work[t] + sample.sliding_work[t], ball.contact_loss, {.relative = 1e-12}));
    CHECK(near(sample.sliding_work[t], ball.friction_loss, {.relative = 1e-12}));
    CHECK(ball.friction_loss > 0);
    CHECK(corner[0].z == 0.05);
    CHECK(corner[1].z == 0.05);
    CHECK((lowest.x < 0.19 && highest.x > 0.19 && lowest.y < -0.053 && highest.y > -0.053));
  }
  CHECK(touched == 1);
}

}  // namespace scree
