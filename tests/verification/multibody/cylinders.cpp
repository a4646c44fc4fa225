// Cylinders that lift a boom, in the plane and in space: equilibrium, speed, joint limits, force limit,
// energy balance.
#include <cmath>
#include <string>

#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/multibody_run.hpp"
#include "support/near.hpp"

using namespace scree;

namespace {

constexpr Real kMass = 20, kArm = 0.5;  // of the boom, which begins horizontal [kg, m]
constexpr Real kFoot[2] = {0.2, -0.4}, kEye = 0.4;

// A boom on a revolute joint at the origin; a cylinder from the ground to a point on it.
std::string boom(bool spatial, const std::string& cylinder) {
  const std::string z = spatial ? ", 0.0]" : "]";
  std::string deck = "gravity = [0.0, -9.8066" + z + "\n[space]\ndimension = " + (spatial ? "3" : "2") +
                     "\nmin = [-2.0, -2.0" + (spatial ? ", -1.0]" : "]") + "\nmax = [2.0, 2.0" +
                     (spatial ? ", 1.0]" : "]") + "\n[time]\nend = 20.0\nstep = 1e-3\n";
  deck += "[integrator]\nhht_alpha = -0.05\n[[bodies]]\nname = \"boom\"\nposition = [0.5, 0.0" + z +
          "\nmass = 20.0\n";
  deck +=
      spatial ? "kind = \"spatial\"\ninertia_tensor = [0.1, 1.7, 1.7, 0.0, 0.0, 0.0]\n" : "inertia = 1.7\n";
  deck +=
      "[[joints]]\nname = \"hinge\"\ntype = \"revolute\"\nbodies = [\"ground\", \"boom\"]\npoint = [0.0, "
      "0.0" +
      z + "\n";
  if (spatial) deck += "axis = [0.0, 0.0, 1.0]\n";
  return deck + "[[cylinders]]\nname = \"lift\"\nbodies = [\"ground\", \"boom\"]\npoints = [[0.2, -0.4" + z +
         ", [0.4, 0.0" + z + "]\n" + cylinder;
}

const std::string kServo =
    "type = \"length\"\nlength = 0.447213595499958\nposition_gain = 2e5\nrate_gain = 2e4\n";
const std::string kPump =
    "type = \"speed\"\nspeed = 0.05\ngain = 2e4\nintegral_gain = 4e5\nlimit = 2000.0\n"
    "min_length = 0.4\nmax_length = 0.5\nstop_stiffness = 1e6\nstop_damping = 1e4\n";

struct Lift {
  explicit Lift(const std::string& deck) : model(model_of(deck)), run(model, 1e-11) { start = balance(); }

  JointEffortSample cylinder() const { return run.multibody.joint_efforts(run.state, run.time).at(0); }
  Vec3 force() const { return run.multibody.reactions(run.state, run.time).at(1).force; }
  // Angle of the boom, from its centre of mass.
  Real angle() const {
    const BodyMotion motion = run.multibody.motion(run.state).at(0);
    return std::atan2(motion.position.y, motion.position.x);
  }
  // Force of the cylinder that holds the boom at this angle [N].
  Real holding() const {
    const Real c = std::cos(angle()), s = std::sin(angle());
    const Real eye[2] = {kEye * c, kEye * s}, way[2] = {eye[0] - kFoot[0], eye[1] - kFoot[1]};
    const Real lever = (eye[0] * way[1] - eye[1] * way[0]) / std::hypot(way[0], way[1]);
    return kMass * kGravity * kArm * c / lever;
  }
  Real balance() const {
    const MultibodyEnergies e = run.multibody.energies(run.state, run.time);
    return e.kinetic + e.gravitational + e.elastic + run.state.dissipated + run.state.integrator_loss -
           run.state.driver_work;
  }
  void steps(int n, Real h) {
    for (int k = 0; k < n; ++k) {
      run.steps(1, h);
      worst = std::max(worst, std::abs(balance() - start));
    }
  }

  Model model;
  MultibodyRun run;
  Real start = 0, worst = 0;
};

}  // namespace

TEST_CASE("a cylinder with a prescribed length holds a boom, shorter by the load over its gain") {
  for (const bool spatial : {false, true}) {
    INFO("spatial " << spatial);
    Lift lift(boom(spatial, kServo));
    lift.steps(2000, 2e-3);
    const JointEffortSample held = lift.cylinder();
    CHECK(held.name == "lift");
    CHECK(near(held.effort, lift.holding(), {.relative = 1e-7}));
    CHECK(near(held.coordinate, 0.447213595499958 - held.effort / 2e5, {.relative = 1e-10}));
    // It pushes the boom up along its line, and the revolute joint carries the rest.
    const Vec3 force = lift.force();
    CHECK(near(norm(force), held.effort, {.relative = 1e-12}));
    CHECK(force.y > 0);
    CHECK(near(lift.run.multibody.reactions(lift.run.state, lift.run.time).at(0).force + force,
               {0, kMass * kGravity, 0}, {.absolute = 1e-4}));
    CHECK(lift.worst < 1e-4);
  }
}

TEST_CASE(
    "a cylinder with a prescribed speed lifts a boom up to its limit, and presses there with its force "
    "limit") {
  for (const bool spatial : {false, true}) {
    INFO("spatial " << spatial);
    Lift lift(boom(spatial, kPump));
    lift.steps(450, 2e-3);
    CHECK(near(lift.cylinder().rate, 0.05, {.relative = 5e-3}));
    CHECK(near(lift.cylinder().effort, lift.holding(), {.relative = 1e-2}));
    // At the joint limit the integral grows until the force limit is reached.
    lift.steps(2000, 2e-3);
    const auto efforts = lift.run.multibody.joint_efforts(lift.run.state, lift.run.time);
    CHECK(near(efforts[0].effort, 2000, {.relative = 1e-12}));
    CHECK(efforts[1].name == "lift.stops");
    CHECK(near(efforts[0].effort + efforts[1].effort, lift.holding(), {.relative = 1e-6}));
    CHECK(near(lift.cylinder().coordinate, 0.5 + (2000 - lift.holding()) / 1e6, {.relative = 1e-8}));
    CHECK(near(norm(lift.force()), lift.holding(), {.relative = 1e-6}));
    CHECK(lift.worst < 0.02);
  }
}

TEST_CASE("a cylinder whose limit is too small sinks onto its stop") {
  for (const bool spatial : {false, true}) {
    INFO("spatial " << spatial);
    Lift lift(boom(spatial,
                   "type = \"force\"\nforce = 1000.0\nlimit = 150.0\nmin_length = 0.35\nmax_length = 0.6\n"
                   "stop_stiffness = 1e6\nstop_damping = 2e4\n"));
    CHECK(lift.cylinder().effort == 150);
    CHECK(lift.holding() > 200);
    lift.steps(1500, 2e-3);
    CHECK(lift.cylinder().effort == 150);
    CHECK(near(lift.cylinder().coordinate, 0.35 - (lift.holding() - 150) / 1e6, {.relative = 1e-6}));
  }
}

TEST_CASE("cylinders in the plane and in space have the same motion") {
  Lift planar(boom(false, kPump)), spatial(boom(true, kPump));
  planar.steps(400, 2e-3), spatial.steps(400, 2e-3);
  CHECK(near(planar.angle(), spatial.angle(), {.absolute = 1e-6}));
  CHECK(near(planar.cylinder().effort, spatial.cylinder().effort, {.relative = 1e-4}));
}
