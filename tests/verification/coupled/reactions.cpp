// Reactions in adaptive steps that an impact elsewhere shortens, at every step against closed forms.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "physics/spatial_rotation.hpp"
#include "support/catch.hpp"
#include "support/measured.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"

namespace scree {

namespace {

constexpr Real kGravity = 9.81, kMass = 1.5, kInertia = 0.02, kArm = 0.4;
constexpr Real kAbout = kInertia + kMass * kArm * kArm;                        // about a pivot [kg m^2]
constexpr Real kSwing = 0.6, kFrequency = 1.2, kTurn = 2 * M_PI * kFrequency;  // of the driver
constexpr Real kMu = 0.3, kPin = 0.05;

std::string start_of_deck(int dimension, const std::string& gravity, const std::string& corners,
                          const std::string& floor) {
  return "velocities = \"consistent\"\ngravity = " + gravity +
         "\n[space]\ndimension = " + std::to_string(dimension) + "\n" + corners + floor +
         " = \"wall\"\n[time]\nend = 0.6\n[integrator]\nredundant = "
         "\"minimum-norm\"\n[[contact.pairs]]\nstiffness "
         "= "
         "1e5\nrestitution = 0.7\n";
}

std::string ball(const std::string& position) {
  return "[[particles]]\nname = \"ball\"\nkind = \"list\"\npositions = [" + position +
         "]\nradius = 0.02\nmass = 0.01\n";
}

// A disc at the end of an arm, level at t = 0, on a pin.
std::string planar_arm(const std::string& name, int place) {
  const std::string x = std::to_string(place);
  return "[[bodies]]\nname = \"" + name + "\"\nposition = [" + x + ".4, 0]\nmass = 1.5\ninertia = 0.02\n" +
         "[[joints]]\nname = \"" + name + " pin\"\ntype = \"revolute\"\nbodies = [\"ground\", \"" + name +
         "\"]\npoint = [" + x + ".0, 0]\n";
}

// Three such arms: free, driven, with friction; and a disc that bounces. The spring of friction is so stiff
// that it slides also in the shortest step, in which the load within the steps rises after an impact.
std::string planar_deck() {
  return start_of_deck(2, "[0, -9.81]", "min = [-1, -1]\nmax = [6, 1]\n", "y_min") + planar_arm("free", 0) +
         planar_arm("driven", 2) + planar_arm("frictional", 4) +
         "[[drivers]]\nname = \"drive\"\njoint = \"driven pin\"\nmotion = { kind = \"sine\", amplitude = "
         "0.6, "
         "frequency = 1.2 }\n[[joint_frictions]]\nname = \"friction\"\njoint = \"frictional "
         "pin\"\nfriction_coefficient "
         "= 0.3\nradius = 0.05\nstiffness = 1e6\n" +
         ball("[5.8, -0.7]");
}

// A spinning body on a spherical joint; a body on two redundant revolute joints; and a sphere that bounces.
std::string spatial_deck() {
  const auto body = [](const std::string& name, const std::string& position, const std::string& more) {
    return "[[bodies]]\nname = \"" + name + "\"\nkind = \"spatial\"\nposition = " + position +
           "\nmass = 1.5\ninertia_tensor = [0.02, 0.02, 0.03, 0, 0, 0]\n" + more;
  };
  const auto joint = [](const std::string& name, const std::string& type, const std::string& of,
                        const std::string& point) {
    return "[[joints]]\nname = \"" + name + "\"\ntype = \"" + type + "\"\nbodies = [\"ground\", \"" + of +
           "\"]\npoint = " + point + "\n" + (type == "revolute" ? "axis = [0, 1, 0]\n" : "");
  };
  return start_of_deck(3, "[0, 0, -9.81]", "min = [-1, -1, -1]\nmax = [4, 1, 1]\n", "z_min") +
         body("top", "[0, 0, -0.4]", "body_angular_velocity = [6, 2, 20]\n") +
         joint("ball joint", "spherical", "top", "[0, 0, 0]") + body("gate", "[2.4, 0, 0]", "") +
         joint("one", "revolute", "gate", "[2, 0.3, 0]") + joint("two", "revolute", "gate", "[2, -0.3, 0]") +
         ball("[3.8, 0, -0.7]");
}

// Largest difference from the closed form, and largest size [N or N m].
struct Largest {
  Real error = 0, size = 0;
  void take(Vec3 found, Vec3 exact) {
    error = std::max(error, norm(found - exact)), size = std::max(size, norm(exact));
  }
  Real share() const { return error / size; }
};

// Reaction of the pin of an arm at the angle `turn` from level with this rate and acceleration.
Vec3 pin_force(Real turn, Real rate, Real acceleration) {
  const Vec3 along{std::cos(turn), std::sin(turn), 0}, across{-along.y, along.x, 0};
  return kMass * (kArm * (acceleration * across - rate * rate * along) + Vec3{0, kGravity, 0});
}

Real pin_acceleration(Real turn, Real torque) {
  return (torque - kMass * kGravity * kArm * std::cos(turn)) / kAbout;
}

// Reaction of the spherical joint of a body whose centre is at (0, 0, -arm) of its frame below the joint.
Vec3 ball_force(const BodyMotion& top) {
  const Mat3 axes = rotation_matrix(top.orientation);
  const Vec3 centre{0, 0, -kArm}, w = top.spin, weight{0, 0, -kMass * kGravity};
  const Vec3 momentum{kAbout * w.x, kAbout * w.y, 0.03 * w.z};
  const Vec3 torque = cross(centre, transposed(axes) * weight) - cross(w, momentum);
  const Vec3 turned{torque.x / kAbout, torque.y / kAbout, torque.z / 0.03};
  return kMass * (axes * (cross(turned, centre) + cross(w, cross(w, centre)))) - weight;
}

}  // namespace

TEST_CASE("reactions in the plane do not see that an impact elsewhere changes the steps") {
  const Model model = model_of(planar_deck());
  SimulationRun run(model);
  Largest multipliers, free, driven, drive, frictional, friction;
  run.run([&] {
    const std::vector<Real>&q = run.bodies().position, &v = run.bodies().velocity;
    const std::vector<Reaction> reactions = run.multibody().reactions(run.bodies(), run.time());
    const Vec3 force = pin_force(q[2], v[2], pin_acceleration(q[2], 0));
    free.take(reactions[0].force, force);
    const std::vector<Real>& lambda = run.bodies().multipliers;
    multipliers.take(-Vec3{lambda[0], lambda[1], 0}, force);

    const Real phase = kTurn * run.time(), turn = kSwing * std::sin(phase);
    const Real acceleration = -kTurn * kTurn * turn;
    driven.take(reactions[1].force, pin_force(turn, kSwing * kTurn * std::cos(phase), acceleration));
    const Real torque = kAbout * acceleration + kMass * kGravity * kArm * std::cos(turn);
    drive.take(reactions[3].torque, {0, 0, torque});

    const Real effort = run.multibody().joint_efforts(run.bodies(), run.time())[0].effort;
    frictional.take(reactions[2].force, pin_force(q[8], v[8], pin_acceleration(q[8], effort)));
    if (run.time() > 0.01)  // it slides
      friction.take({0, 0, effort}, {0, 0, std::copysign(kMu * kPin * norm(reactions[2].force), -v[8])});
  });
  CHECK(multipliers.share() > 0.2);  // of the steps: there is a significant oscillation
  for (const Largest& found : {free, frictional})
    CHECK(measured("reactions/adaptive", "", at_most(found.share(), 2e-5)));
  for (const Largest& found :
       {driven, drive, friction})  // fixed by the driver's motion, or the reaction itself
    CHECK(measured("reactions/driven", "", at_most(found.share(), 1e-12)));
}

TEST_CASE("nor do spatial reactions, minimum-norm ones of redundant revolute joints included") {
  const Model model = model_of(spatial_deck());
  SimulationRun run(model);
  Largest multipliers, top, revolute_joints;
  run.run([&] {
    const std::vector<BodyMotion> motion = run.multibody().motion(run.bodies());
    const std::vector<Reaction> reactions = run.multibody().reactions(run.bodies(), run.time());
    const Vec3 force = ball_force(motion[0]);
    top.take(reactions[0].force, force);
    const std::vector<Real>& lambda = run.bodies().multipliers;
    multipliers.take(-Vec3{lambda[0], lambda[1], lambda[2]}, force);
    // Rotated about y by -turn, it is an arm in the plane of x and z.
    const Vec3 centre = motion[1].position - Vec3{2, 0, 0};
    const Real turn = std::atan2(centre.z, centre.x);
    const Vec3 both = pin_force(turn, motion[1].spin.y, pin_acceleration(turn, 0));
    for (const std::size_t k : {1, 2})
      revolute_joints.take(reactions[k].force, Real(0.5) * Vec3{both.x, 0, both.y});
  });
  CHECK(multipliers.share() > 0.05);
  for (const Largest& found : {top, revolute_joints})
    CHECK(measured("reactions/adaptive", "", at_most(found.share(), 2e-5)));
}

}  // namespace scree
