// A plate on a revolute joint with spheres off its centre, hit by a particle: a spatial body moves as a
// planar one does, and identically after a rotation of everything in space.
#include <fmt/format.h>

#include <cmath>
#include <string>

#include "physics/spatial_rotation.hpp"
#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"

using namespace scree;

namespace {

constexpr Real kIterated = 1e-8;  // of the residual of the implicit step's iteration, and round-off

std::string text(Vec3 v) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x, v.y, v.z); }

// frame: of the whole scene. Without it the plate is planar.
std::string deck(const std::string& particles, const Quaternion* frame) {
  const Mat3 a = frame == nullptr ? identity3() : rotation_matrix(*frame);
  const auto turned = [&](Vec3 v) { return text(a * v); };
  const std::string kind = frame == nullptr
                               ? "inertia = 0.01\n"
                               : fmt::format(
                                     "kind = \"spatial\"\ninertia_tensor = [0.02, 0.02, 0.01, 0.0, 0.0, "
                                     "0.0]\nquaternion = [{:.17g}, {:.17g}, {:.17g}, {:.17g}]\n",
                                     frame->w, frame->x, frame->y, frame->z);
  const std::string axis = frame == nullptr ? "" : "axis = " + turned({0, 0, 1}) + "\n";
  return "gravity = " + turned({0, -9.81, 0}) +
         "\n[space]\ndimension = 3\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\n[time]\nend = 0.05\nstep = "
         "1e-4\ncontrol = "
         "\"fixed\"\n[integrator]\nparticles = \"" +
         particles +
         "\"\n[[contact.pairs]]\nstiffness = 1e5\ndamping = 5.0\nfriction = 0.3\n[[bodies]]\nname = "
         "\"plate\"\nmass = "
         "1.0\nposition = [0.0, 0.0, 0.0]\nshapes = [{ radius = 0.05, offset = [-0.1, 0.0, 0.0] }, { radius "
         "= 0.05, "
         "offset = [0.1, 0.0, 0.0] }]\n" +
         kind + "[[joints]]\nname = \"hinge\"\ntype = \"revolute\"\nbodies = [\"ground\", \"plate\"]\n" +
         axis + "[[particles]]\nname = \"grain\"\nkind = \"list\"\npositions = [" + turned({0.11, 0.08, 0}) +
         "]\nvelocity = " + turned({0, -2, 0}) +
         "\nradius = 0.02\ndensity = 2000.0\n[output]\nhistory_interval = 0.01\n";
}

struct Outcome {
  Real spin;      // of the plate about the revolute joint [rad/s]
  Vec3 velocity;  // of the particle, in the scene's frame [m/s]
  Vec3 particle_spin;
  Real dissipated;
};

Outcome outcome(const std::string& particles, const Quaternion* frame) {
  const Model model = model_of(deck(particles, frame));
  SimulationRun run(model);
  run.run();
  const Mat3 a = frame == nullptr ? identity3() : rotation_matrix(*frame);
  const BodyMotion plate = run.multibody().motion(run.bodies())[0];
  const Particle grain = run.particles()[0];
  return {frame == nullptr ? plate.angular_velocity : plate.spin.z, transposed_times(a, grain.velocity),
          transposed_times(a, grain.angular_velocity), run.ledger().dissipated_contacts};
}

void check_same(const Outcome& one, const Outcome& other, Real bound) {
  const Within allowed{.relative = bound};
  CHECK(measured("plate/motion", "", near(one.spin, other.spin, allowed)));
  CHECK(measured("plate/motion", "", near(one.velocity, other.velocity, allowed)));
  CHECK(measured("plate/motion", "", near(one.particle_spin, other.particle_spin, allowed)));
  CHECK(measured("plate/motion", "", near(one.dissipated, other.dissipated, allowed)));
}

}  // namespace

TEST_CASE("spheres on a spatial body collide with particles as those on a planar one do, in any frame") {
  for (const std::string particles : {"hht", "velocity-verlet"}) {
    CAPTURE(particles);
    const Outcome planar = outcome(particles, nullptr);
    CHECK(std::abs(planar.spin) > 2);
    CHECK(norm(planar.particle_spin) > 1);
    const Quaternion aligned, turned = normalized({0.4, 0.5, -0.2, 0.7});
    check_same(outcome(particles, &aligned), planar, kIterated);
    check_same(outcome(particles, &turned), planar, kIterated);
  }
}

TEST_CASE("a spatial run continues from its state with the same bits") {
  const Quaternion turned = normalized({0.4, 0.5, -0.2, 0.7});
  const Model model = model_of(deck("hht", &turned));
  SimulationRun whole(model), first(model);
  whole.run();
  first.run_until(0.02);
  SimulationRun second(model, first.complete_state());
  second.run();
  CHECK(second.bodies().position == whole.bodies().position);
  CHECK(second.bodies().velocity == whole.bodies().velocity);
  CHECK(second.bodies().multipliers == whole.bodies().multipliers);
}
