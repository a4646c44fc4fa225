// What snapshots tell of triangles.
#include "run/mesh_surfaces.hpp"

#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"

namespace scree {

namespace {

// A ball that comes down on a box of small triangles and slides over it.
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

}  // namespace

TEST_CASE("a snapshot has the works and the wear that the deck asks for, where something touches") {
  const Model model = model_of(kBall);
  SimulationRun run(model);
  run.run();
  const State& state = run.complete_state();
  const MeshSurfaces surfaces(model);
  const MeshSurfaces::Look look =
      surfaces.look(std::vector<BodyMotion>(SurfaceSet(model).carriers()), {}, state.works);
  CHECK(look.pressure.empty());
  CHECK(look.shear.empty());
  const SeriesTriangles triangles = surfaces.triangles();
  REQUIRE(std::ssize(look.impact_work) == triangles.count());
  int touched = 0;
  for (std::size_t t = 0; t < look.impact_work.size(); ++t) {
    Vec3 corner[3], lowest = look.position[static_cast<std::size_t>(triangles.corners[3 * t])],
                    highest = lowest;
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = look.position[static_cast<std::size_t>(triangles.corners[3 * t + k])];
      lowest = {std::min(lowest.x, corner[k].x), std::min(lowest.y, corner[k].y), 0};
      highest = {std::max(highest.x, corner[k].x), std::max(highest.y, corner[k].y), 0};
    }
    const Real area = norm(cross(corner[1] - corner[0], corner[2] - corner[0])) / 2;
    CHECK(near(look.wear_depth[t] * area, 2e-12 / 0.1 * look.sliding_work[t], {.relative = 1e-12}));
    if (look.impact_work[t] == 0) continue;
    ++touched;
    const Particle& ball = state.particles.at(0);
    CHECK(near(look.impact_work[t] + look.sliding_work[t], ball.contact_loss, {.relative = 1e-12}));
    CHECK(near(look.sliding_work[t], ball.friction_loss, {.relative = 1e-12}));
    CHECK(ball.friction_loss > 0);
    CHECK(corner[0].z == 0.05);
    CHECK(corner[1].z == 0.05);
    CHECK((lowest.x < 0.19 && highest.x > 0.19 && lowest.y < -0.053 && highest.y > -0.053));
  }
  CHECK(touched == 1);
}

}  // namespace scree
