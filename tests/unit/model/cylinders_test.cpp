// Cylinders built from a deck: a line of free length, a motor on it, and limits.
#include "model/checks/memory.hpp"
#include "model/derived/connections.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

const std::string kDeck = kSmallDeck + R"(
[[bodies]]
name = "boom"
count = 2
spacing = [0.5, 0.0]
mass = 1.0
inertia = 0.1
position = [0.1, 0.2]
)";
const std::string kOne =
    "[[cylinders]]\nname = \"c\"\nbodies = [\"ground\", \"boom.0\"]\npoints = [[0.1, -0.3], [0.1, 0.1]]\n";
const std::string kForce = "type = \"force\"\nforce = 5.0\n";

std::string refusal(const std::string& tables) { return model_error(kDeck + tables); }

}  // namespace

TEST_CASE("a length of 0 or less, of a cylinder or a driver, is a warning with its time") {
  const auto warnings = [](const std::string& tables) {
    std::vector<std::string> all = model_warnings(kDeck + tables);
    std::erase_if(all, [](const std::string& text) { return !contains(text, "asks for a length"); });
    return all;
  };
  const auto cylinder = [&](const std::string& length) {
    return warnings(kOne + "type = \"length\"\nposition_gain = 9.0\nlength = " + length + "\n");
  };
  CHECK(cylinder("0.4").empty());
  CHECK(cylinder("0.0").size() == 1);
  const auto step = [](const std::string& last) {
    return "{ kind = \"step\", value = 0.4, end_value = " + last + ", start = 0.0, end = 0.01 }";
  };
  CHECK(cylinder(step("0.1")).empty());
  const std::vector<std::string> negative = cylinder(step("-0.2"));
  REQUIRE(negative.size() == 1);
  CHECK(contains(negative[0], "cylinder 'c' asks for a length of -0.2 m at t = 0.01 s"));
  const auto driver = [&](const std::string& last) {
    return warnings(
        "[[joints]]\nname = \"rod\"\ntype = \"distance\"\nbodies = [\"ground\", \"boom.0\"]\n"
        "points = [[0.1, -0.3], [0.1, 0.1]]\n[[drivers]]\nname = \"stroke\"\njoint = \"rod\"\nmotion = " +
        step(last) + "\n");
  };
  CHECK(driver("0.5").empty());
  REQUIRE(driver("-0.2").size() == 1);
  CHECK(contains(driver("-0.2")[0], "driver 'stroke' asks for a length of -0.2 m"));
}

TEST_CASE("a cylinder is a joint without rows, a motor on its length, and a stop") {
  const Model model = model_of(kDeck + kOne +
                               "type = \"speed\"\nspeed = 0.2\ngain = 3.0\nintegral_gain = 7.0\n"
                               "limit = 9.0\nmin_length = 0.3\nmax_length = 0.7\n"
                               "stop_stiffness = 1e4\nstop_damping = 2.0\n");
  REQUIRE(model.joints.size() == 1);
  CHECK(model.joints[0].telescopes);
  CHECK(near(model.joints[0].distance, 0.4, {.relative = 1e-14}));
  CHECK(constraint_count(model) == 0);
  CHECK(rowless_joints(model) == std::vector{true});
  REQUIRE(model.motors.size() == 1);
  CHECK(model.motors[0].name == "c");
  CHECK(model.motors[0].kind == MotorKind::speed);
  CHECK(model.motors[0].integral_gain == 7);
  CHECK(model.motors[0].limit == 9);
  CHECK(memory_count(model) == 1);
  REQUIRE(model.joint_limits.size() == 1);
  CHECK(model.joint_limits[0].name == "c.stops");
  CHECK(model.joint_limits[0].lower == 0.3);
  CHECK(model.joint_limits[0].upper == 0.7);
  CHECK(model.joint_limits[0].stiffness == 1e4);
  CHECK(connected_bodies(model).empty());
  CHECK(held_bodies(model) == std::vector{true, false});
}

TEST_CASE("cylinders connect the bodies of a row, and take springs and friction") {
  const std::string row =
      "[[cylinders]]\nname = \"c\"\neach = \"boom\"\nlocal_points = [[0.0, -1.0], [0.0, 0.0]]\n" + kForce;
  const Model model =
      model_of(kDeck + row +
               "[[joint_frictions]]\nname = \"seal\"\njoint = \"c\"\neffort = 2.0\nstiffness = "
               "1e5\n[[joint_springs]]\nname = \"gas\"\njoint = \"c.1\"\nstiffness = 30.0\n");
  CHECK(model.joints.size() == 2);
  CHECK(model.motors[1].name == "c.1");
  CHECK(model.joint_frictions.size() == 2);
  CHECK(model.joint_springs[0].joint == 1);
  const Deck deck = parse_deck(kDeck + row, "deck.toml", {});
  CHECK(bodies_and_joints(deck.root).links == 4);
}

TEST_CASE("keys that a cylinder must not have") {
  CHECK(contains(refusal(kOne + kForce + "min_length = 0.3\n"), "cylinders.c.stop_stiffness: missing"));
  CHECK(
      contains(refusal(kOne + kForce + "stop_damping = 0.3\n"), "not used without min_length or max_length"));
  CHECK(contains(refusal(kOne + kForce + "min_length = 0.5\nstop_stiffness = 1.0\n"),
                 "the two points are 0.4 m apart at t = 0, outside the stroke"));
  CHECK(contains(refusal(kOne + kForce + "min_length = 0.3\nmax_length = 0.2\nstop_stiffness = 1.0\n"),
                 "must be above min_length = 0.3"));
  CHECK(contains(refusal(kOne + kForce + "gain = 1.0\n"),
                 "not used with type = \"force\", only with \"speed\""));
  CHECK(contains(
      refusal(kOne + kForce + "[[motors]]\nname = \"c\"\njoint = \"c\"\ntype = \"effort\"\neffort = 1.0\n"),
      "motors.c.name = \"c\""));
  CHECK(contains(refusal(kOne + kForce +
                         "[[joint_frictions]]\nname = \"f\"\njoint = \"c\"\nfriction_coefficient = "
                         "0.1\nstiffness = 1.0\n"),
                 "carries no force across its line"));
  CHECK(contains(refusal(kOne + kForce + "[[drivers]]\nname = \"d\"\njoint = \"c\"\nmotion = 1.0\n"),
                 "there is no joint named \"c\""));
  CHECK(contains(
      refusal("[[cylinders]]\nname = \"c\"\nbodies = [\"boom.0\", \"boom.1\"]\npoints = [[0.0, 0.0], "
              "[0.0, 0.0]]\n" +
              kForce),
      "must not coincide"));
  CHECK(contains(
      refusal(kOne + "type = \"length\"\nposition_gain = 1.0\nlength = { kind = \"table\", times = [0, "
                     "1], values = [0.4, 0.5], interpolation = \"linear\" }\n"),
      "must not jump"));
}

TEST_CASE("torques of applied forces have one name in the plane and in space") {
  const std::string force = "[[applied_forces]]\nname = \"f\"\nbody = \"boom.0\"\n";
  CHECK(model_of(kDeck + force + "torque_z = 3.0\n").applied_forces[0].torque.value == 3);
  CHECK(contains(refusal(force + "torque = 3.0\n"), "unknown key; did you mean \"torque_z\"?"));
  CHECK(contains(refusal(force + "torque_x = 3.0\n"), "must be 0: the body is planar"));
}

}  // namespace scree
