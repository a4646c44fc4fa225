// Meshes on bodies against closed forms: impulse, momentum, and rotating meshes.
#include <fmt/format.h>

#include <cmath>
#include <string>

#include "physics/spatial_rotation.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"

namespace scree {

namespace {

// A free block and a particle that hits its upper side off its centre.
std::string block_and_particle(const std::string& method, Real step, const std::string& more = "") {
  return fmt::format(
      "[space]\ndimension = 3\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\n[time]\nend = 0.02\nstep = "
      "{:.17g}\ncontrol = "
      "\"fixed\"\n[integrator]\nparticles = \"{}\"\n[[contact.pairs]]\nstiffness = 1e5\n{}\n[[meshes]]\nname "
      "= "
      "\"block\"\nkind = \"box\"\nsize = [0.3, 0.2, 0.1]\n[[bodies]]\nname = \"block\"\nkind = "
      "\"spatial\"\nposition = "
      "[0, 0, 0]\nsolids = [{{ kind = \"mesh\", mesh = \"block\", density = 200.0 }}]\nmeshes = [{{ mesh = "
      "\"block\" "
      "}}]\n[[particles]]\nname = \"grain\"\nkind = \"list\"\npositions = [[0.1, 0.05, 0.0705]]\nvelocity = "
      "[0, 0, "
      "-2]\nradius = 0.02\nmass = 0.3\n[output]\nhistory_interval = 0.01\n",
      step, method, more);
}

struct Momenta {
  Vec3 linear, angular;
};
Momenta momenta(const SimulationRun& run, const Model& model) {
  Momenta out;
  for (const Particle& p : run.particles()) {
    out.linear += p.mass * p.velocity;
    out.angular += p.mass * cross(p.position, p.velocity) + p.moment_of_inertia * p.angular_velocity;
  }
  const std::vector<BodyMotion> motion = run.multibody().motion(run.bodies());
  for (std::size_t b = 0; b < motion.size(); ++b) {
    const Body& body = model.bodies[b];
    const Mat3 a = rotation_matrix(motion[b].orientation);
    out.linear += body.mass * motion[b].velocity;
    out.angular += body.mass * cross(motion[b].position, motion[b].velocity) +
                   a * (body.inertia_tensor * motion[b].spin);
  }
  return out;
}

}  // namespace

// A hard impact of restitution e: impulse P = (1 + e) v m*, 1/m* = 1/m + 1/M + (r x n) J^-1 (r x n).
TEST_CASE("a block of triangles hit off its centre moves by the impulse, better with stiffer contacts") {
  Real errors[2];
  for (const int k : {0, 1}) {
    const Real stiffness = k == 0 ? 1e5 : 1e7;
    const Model model = model_of(block_and_particle("velocity-verlet", k == 0 ? 4e-5 : 4e-6),
                                 {fmt::format("contact.pairs.0.stiffness={}", stiffness)});
    SimulationRun run(model);
    run.run();
    const Body& block = model.bodies[0];
    REQUIRE(near(block.mass, 0.3 * 0.2 * 0.1 * 200, {.relative = 1e-14}));
    const Vec3 lever = cross(Vec3{0.1, 0.05, 0.05}, Vec3{0, 0, 1});
    const Real softness = 1 / 0.3 + 1 / block.mass + dot(lever, inverse(block.inertia_tensor) * lever);
    const Real impulse = 2 * 2 / softness;
    const BodyMotion motion = run.multibody().motion(run.bodies())[0];
    // It precesses from then on: the angular momentum is conserved.
    const Mat3 a = rotation_matrix(motion.orientation);
    const Vec3 momentum = a * (block.inertia_tensor * motion.spin);
    errors[k] = norm(momentum + impulse * lever) / norm(impulse * lever);
    CHECK(near(run.particles()[0].velocity.z, -2 + impulse / 0.3, {.relative = 0.02}));
    CHECK(near(motion.velocity.z, -impulse / block.mass, {.relative = 0.02}));
  }
  CHECK(errors[0] < 0.05);
  CHECK(errors[1] < errors[0] / 3);
}

TEST_CASE(
    "a particle with friction on a block of triangles and the block keep their momenta to the method's "
    "order") {
  for (const std::string method : {"velocity-verlet", "hht"}) {
    Real drift[2];
    for (const int k : {0, 1}) {
      const Model model = model_of(
          block_and_particle(method, 1e-4 / (1 + k), "friction = 0.4\ntangential_damping_ratio = 0.1"),
          {"particles.grain.velocity=[1.5, -0.5, -2]"});
      SimulationRun run(model);
      const Momenta before = momenta(run, model);
      run.run();
      const Momenta after = momenta(run, model);
      drift[k] = norm(after.linear - before.linear) / norm(before.linear) +
                 norm(after.angular - before.angular) / norm(before.angular);
      CHECK(norm(run.particles()[0].angular_velocity) > 5);
    }
    CAPTURE(method, drift[0], drift[1]);
    CHECK(drift[0] < 1e-3);
    CHECK((drift[1] < drift[0] / 1.8 || drift[1] < 1e-12));
  }
}

// The block rotated in space, hit along its own axes.
TEST_CASE("a rotated and moved mesh has the same contact forces") {
  const Model upright = model_of(block_and_particle("velocity-verlet", 4e-5, "friction = 0.4"));
  Model turned = upright;
  const Quaternion frame = normalized({0.4, 0.5, -0.2, 0.7});
  const Mat3 a = rotation_matrix(frame);
  turned.bodies[0].orientation = frame;
  turned.particles.position[0] = a * turned.particles.position[0];
  turned.particles.velocity[0] = a * turned.particles.velocity[0];
  SimulationRun one(upright), other(turned);
  one.run(), other.run();
  const BodyMotion p = one.multibody().motion(one.bodies())[0],
                   q = other.multibody().motion(other.bodies())[0];
  CHECK(norm(p.spin) > 1);
  CHECK(near(q.spin, p.spin, {.relative = 1e-10}));
  CHECK(near(transposed_times(a, q.velocity), p.velocity, {.relative = 1e-10}));
  CHECK(near(transposed_times(a, other.particles()[0].velocity), one.particles()[0].velocity,
             {.relative = 1e-10}));
}

}  // namespace scree
