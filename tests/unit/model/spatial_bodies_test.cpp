// Spatial bodies and their joints from the deck.
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "model/derived/connections.hpp"
#include "physics/spatial_rotation.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 4e-16;

const std::string kSpace =
    "[space]\ndimension = 3\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\n[time]\nend = 1.0\nstep = 1e-3\ncontrol = "
    "\"fixed\"\n";

// Two bodies: a, rotated, and b.
std::string two_bodies(const std::string& more = "") {
  return kSpace +
         "[[bodies]]\nname = \"a\"\nkind = \"spatial\"\nmass = 1.0\ninertia_tensor = [0.2, 0.3, 0.4, 0.01, "
         "0.0, "
         "0.0]\nposition = [0.1, 0.2, 0.3]\n" +
         more +
         "[[bodies]]\nname = \"b\"\nkind = \"spatial\"\nmass = 1.0\ninertia_tensor = [0.2, 0.3, 0.4, 0.0, "
         "0.0, "
         "0.0]\nposition = [0.5, 0.2, 0.3]\n";
}

std::string joint(const std::string& keys) { return "[[joints]]\nname = \"j\"\n" + keys; }

}  // namespace

TEST_CASE("a spatial body's orientation and angular velocity by either keys") {
  const Model axis =
      model_of(two_bodies("rotation_axis = [0.0, 0.0, 2.0]\nrotation_angle = "
                          "1.5707963267948966\nglobal_angular_velocity = [1.0, 0.0, "
                          "3.0]\n"));
  const Body& a = axis.bodies[0];
  CHECK(a.kind == BodyKind::spatial);
  CHECK(norm(rotation_matrix(a.orientation) * Vec3{1, 0, 0} - Vec3{0, 1, 0}) < kRoundOff);
  CHECK(norm(a.spin - Vec3{0, -1, 3}) < kRoundOff);
  const Model quaternion =
      model_of(two_bodies("quaternion = [0.6, 0.0, 0.8, 0.0]\nbody_angular_velocity = [1.0, 2.0, 3.0]\n"));
  CHECK(quaternion.bodies[0].orientation.y == 0.8);
  CHECK((quaternion.bodies[0].spin == Vec3{1, 2, 3}));
  CHECK(quaternion.bodies[0].inertia < 0.2);  // the least principal moment
}

TEST_CASE("errors of spatial bodies are refused with the reason") {
  const auto error = [](const std::string& from, const std::string& to) {
    std::string deck = two_bodies();
    deck.replace(deck.find(from), from.size(), to);
    return model_error(deck);
  };
  CHECK(contains(error("[0.2, 0.3, 0.4, 0.01", "[0.2, 0.3, 0.4, 0.3"), "all must be positive"));
  CHECK(contains(error("[0.2, 0.3, 0.4, 0.01", "[0.1, 0.1, 0.4, 0.0"), "sum of the other two"));
  CHECK(contains(error("dimension = 3\nmin = [-1, -1, -1]\nmax = [1, 1, 1]",
                       "dimension = 2\nmin = [-1, -1]\nmax = [1, 1]"),
                 "position"));
  CHECK(contains(error("mass = 1.0\n", "mass = 1.0\nquaternion = [1.0, 1.0, 0.0, 0.0]\n"), "length 1"));
  CHECK(contains(error("mass = 1.0\n", "mass = 1.0\nrotation_angle = 1.0\n"), "go together"));
  CHECK(contains(error("mass = 1.0\n", "mass = 1.0\nrotation_angle = 1.0\nrotation_axis = [0.0, 0.0, 0.0]\n"),
                 "must not be 0"));
  CHECK(contains(error("mass = 1.0\n", "mass = 1.0\nangle = 1.0\n"), "kind"));
}

TEST_CASE("a joint's axis becomes its frames' z axis on either body") {
  const std::string turned = "quaternion = [0.6, 0.0, 0.8, 0.0]\n";
  const Model model =
      model_of(two_bodies(turned) +
               joint("type = \"revolute\"\nbodies = [\"a\", \"b\"]\npoint = [0.2, 0.2, 0.3]\naxis = "
                     "[0.0, 3.0, 4.0]\n"));
  for (const int side : {0, 1}) {
    const Vec3 own = rotation_matrix(model.joints[0].marker[side]) * Vec3{0, 0, 1};
    CHECK(norm(to_global_direction(model, side, own) - Vec3{0, 0.6, 0.8}) < kRoundOff);
    CHECK(norm(to_global_point(model, side, model.joints[0].point[side]) - Vec3{0.2, 0.2, 0.3}) < kRoundOff);
  }
}

TEST_CASE("joints that spatial and planar bodies cannot have are refused") {
  const std::string ends = "bodies = [\"a\", \"b\"]\n";
  CHECK(contains(model_error(two_bodies() + joint("type = \"revolute\"\n" + ends)), "axis"));
  CHECK(contains(
      model_error(two_bodies() + joint("type = \"universal\"\naxis = [1.0, 0.0, 0.0]\nsecond_axis = [1.0, "
                                       "1.0, 0.0]\n" +
                                       ends)),
      "perpendicular to axis"));
  const std::string planar =
      "[[bodies]]\nname = \"p\"\nmass = 1.0\ninertia = 0.1\nposition = [0.0, 0.0, 0.0]\n";
  CHECK(contains(model_error(two_bodies() + planar + joint("type = \"fixed\"\nbodies = [\"a\", \"p\"]\n")),
                 "a planar and a spatial body"));
  CHECK(contains(model_error(kSpace + planar + joint("type = \"spherical\"\nbodies = [\"ground\", \"p\"]\n")),
                 "is for spatial bodies"));
  CHECK(contains(
      model_error(two_bodies() + "[[torsional_spring_dampers]]\nname = \"t\"\nbodies = [\"a\", \"b\"]\n"),
      "these are spatial"));
  CHECK(contains(model_error(kSpace + planar + "[[applied_forces]]\nname = \"f\"\nbody = \"p\"\nfz = 1.0\n"),
                 "the body is planar"));
}

TEST_CASE("which coordinate of a joint in space is meant") {
  const std::string ends = "bodies = [\"a\", \"b\"]\naxis = [0.0, 3.0, 4.0]\n";
  const auto deck = [&](const std::string& type, const std::string& element) {
    return two_bodies() + joint("type = \"" + type + "\"\n" + ends) + element;
  };
  const std::string head = "name = \"e\"\njoint = \"j\"\n", drive = "[[drivers]]\n" + head + "motion = 0.0\n",
                    motor = "[[motors]]\n" + head + "type = \"effort\"\neffort = 1.0\n",
                    spring = "[[joint_springs]]\n" + head,
                    limit = "[[joint_limits]]\n" + head + "upper = 1.0\nstiffness = 1.0\n",
                    turn = "coordinate = \"angle\"\n", slide = "coordinate = \"displacement\"\n",
                    length = "coordinate = \"length\"\n",
                    cross = "universal\"\nsecond_axis = [1.0, 0.0, 0.0]#", screw = "screw\"\nlead = \"0.1";
  CHECK(model_of(deck("revolute", drive)).drivers[0].coordinate == JointCoordinate::angle);
  CHECK(model_of(deck("translational", drive)).drivers[0].coordinate == JointCoordinate::displacement);
  for (const std::string& element : {drive, motor, spring, limit}) {
    CHECK(contains(
        model_error(deck("cylindrical", element)),
        "coordinate: missing; joint \"j\" is a cylindrical joint and has an angle and a displacement"));
    CHECK(model_error(deck("cylindrical", element + turn)).empty());
    CHECK(model_error(deck("cylindrical", element + slide)).empty());
    CHECK(contains(model_error(deck("revolute", element + slide)),
                   "joint \"j\" is a revolute joint and has no displacement, but an angle"));
    CHECK(contains(model_error(deck("cylindrical", element + length)), "has no length"));
    CHECK(contains(model_error(deck(cross, element)),
                   "is a universal joint and has an angle_1 and an angle_2: name one of them"));
    CHECK(model_error(deck(cross, element + "coordinate = \"angle_2\"\n")).empty());
    CHECK(contains(model_error(deck("revolute", element + "coordinate = \"angle_2\"\n")),
                   "has no angle_2, but an angle"));
    CHECK(contains(model_error(deck("planar", element)), "a planar joint"));
    CHECK(contains(model_error(deck("planar", element)), "cylindrical"));
  }
  const Model cylinder = model_of(deck("cylindrical", motor + slide));
  CHECK(cylinder.motors[0].coordinate == JointCoordinate::displacement);
}

TEST_CASE("a screw has a lead, and begins where its points and frames are") {
  const std::string thread = "type = \"screw\"\nbodies = [\"a\", \"b\"]\naxis = [2.0, 0.0, 0.0]\n";
  CHECK(contains(model_error(two_bodies() + joint(thread)), "lead"));
  CHECK(contains(model_error(two_bodies() + joint(thread + "lead = 0.0\n")), "must not be 0"));
  const Model model = model_of(two_bodies() +
                               joint(thread + "lead = -0.02\nlocal_points = [[0.1, 0.0, 0.0], "
                                              "[0.0, 0.0, 0.0]]\n") +
                               "[[motors]]\nname = \"m\"\njoint = \"j\"\ntype = \"effort\"\neffort = 1.0\n");
  CHECK(model.joints[0].lead == -0.02);
  CHECK(std::abs(model.joints[0].advance - 0.3) < kRoundOff);
  CHECK(model.motors[0].coordinate == JointCoordinate::angle);
}

TEST_CASE("couplers between joints in space take the coordinates that they are about") {
  const auto joint_of = [](const std::string& name, const std::string& type, const std::string& body) {
    return "[[joints]]\nname = \"" + name + "\"\ntype = \"" + type + "\"\nbodies = [\"ground\", \"" + body +
           "\"]\naxis = [1.0, 0.0, 0.0]\n";
  };
  const std::string hinges =
      two_bodies() + joint_of("one", "cylindrical", "a") + joint_of("two", "translational", "b");
  const auto coupler = [&](const std::string& rest) {
    return hinges + "[[couplers]]\nname = \"c\"\njoints = [\"one\", \"two\"]\n" + rest;
  };
  using enum JointCoordinate;
  CHECK(model_of(coupler("type = \"rack-and-pinion\"\nradius = 0.1\n")).couplers[0].coordinates ==
        std::vector{angle, displacement});
  CHECK(contains(model_error(coupler("type = \"belt\"\nradii = [0.1, 0.2]\n")),
                 "joint \"two\" must be revolute, cylindrical or screw here"));
  const std::string sum = "type = \"sum\"\ncoefficients = [1.0, 2.0]\n";
  CHECK(contains(model_error(coupler(sum)), "coordinates: missing; joint \"one\" is a cylindrical joint"));
  CHECK(model_of(coupler(sum + "coordinates = [\"displacement\", \"displacement\"]\n"))
            .couplers[0]
            .coordinates == std::vector{displacement, displacement});
  CHECK(contains(model_error(coupler(sum + "coordinates = [\"angle\", \"angle\"]\n")),
                 "joint \"two\" is a translational joint and has no angle"));
  CHECK(
      contains(model_error(coupler(sum + "coordinates = [\"angle\"]\n")), "must have 2 entries, as joints"));
  CHECK(contains(model_error(coupler(sum + "coordinates = [\"angle\", \"turn\"]\n")), "\"turn\" must be"));
}

TEST_CASE("joints in space without numerical damping are warned of") {
  const std::string deck = two_bodies() + joint("type = \"spherical\"\nbodies = [\"a\", \"b\"]\n");
  const auto warned = [&](const std::string& alpha) {
    for (const std::string& warning : model_warnings(deck, {"integrator.hht_alpha=" + alpha}))
      if (contains(warning, "hht_alpha = 0 does not damp")) return true;
    return false;
  };
  CHECK(warned("0.0"));
  CHECK_FALSE(warned("-0.02"));
}

}  // namespace scree
