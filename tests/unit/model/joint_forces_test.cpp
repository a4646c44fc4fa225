// Motors, springs and limits on joints, and couplers, built from a deck.
#include "model/checks/memory.hpp"
#include "model/derived/connections.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

const std::string kDeck = kSmallDeck + R"(
[[bodies]]
name = "link"
count = 3
spacing = [0.2, 0.0]
mass = 1.0
inertia = 0.1
position = [0.0, 0.0]
angle = 0.3
[[bodies]]
name = "sled"
mass = 1.0
inertia = 0.1
position = [0.1, 0.7]
[[joints]]
name = "hinge"
type = "revolute"
each = "link"
[[joints]]
name = "rail"
type = "translational"
bodies = ["ground", "sled"]
local_points = [[0.0, 0.5], [0.0, 0.0]]
axis = [0.1, 0.2]
[[joints]]
name = "weld"
type = "fixed"
bodies = ["link.0", "link.1"]
)";

std::string refusal(const std::string& table) {
  return input_error([&] { model_of(kDeck + table); });
}

std::string coupler(const std::string& rest) { return "[[couplers]]\nname = \"c\"\n" + rest; }

}  // namespace

TEST_CASE("an effort on a row of joints is one on each") {
  const std::string springs =
      "[[joint_springs]]\nname = \"s\"\njoint = \"hinge\"\nstiffness = 2.0\n"
      "[[joint_springs]]\nname = \"coil\"\njoint = \"rail\"\nstiffness = 3.0\n"
      "[[motors]]\nname = \"m\"\njoint = \"hinge.1\"\ntype = \"effort\"\neffort = 1.0\n";
  const Model model = model_of(kDeck + springs);
  REQUIRE(model.joint_springs.size() == 4);
  CHECK(model.joint_springs[2].name == "s.2");
  CHECK(model.joint_springs[2].joint == 2);
  CHECK(!model.joint_springs[2].free.has_value());
  CHECK(model.joint_springs[3].name == "coil");
  CHECK(model.motors[0].joint == 1);
  CHECK(bodies_and_joints(parse_deck(kDeck + springs, "deck.toml", {}).root).links == 5 + 3 + 1 + 1);
}

TEST_CASE("friction on joints has the lever of its surfaces") {
  const auto friction = [](const std::string& rest) {
    return "[[joint_frictions]]\nname = \"f\"\nstiffness = 100.0\n" + rest;
  };
  const Model model =
      model_of(kDeck + friction("joint = \"hinge\"\nfriction_coefficient = 0.2\nradius = 0.05\n"
                                "static_ratio = 1.2\nstribeck_rate = 0.1\n"));
  REQUIRE(model.joint_frictions.size() == 3);
  CHECK(model.joint_frictions[1].name == "f.1");
  CHECK(near(model.joint_frictions[1].lever, 0.01, {.relative = 1e-15}));
  CHECK(memory_count(model) == 3);
  const std::string slide = "joint = \"rail\"\n", pin = "joint = \"hinge.0\"\n";
  CHECK(model_of(kDeck + friction(slide + "friction_coefficient = 0.2\neffort = 3.0\n"))
            .joint_frictions[0]
            .lever == 0.2);
  const auto refused = [&](const std::string& rest, const std::string& key, const std::string& text) {
    const std::string message = refusal(friction(rest));
    INFO(message);
    CHECK(contains(message, "joint_frictions.f." + key));
    CHECK(contains(message, text));
  };
  refused(slide, "name", "friction needs effort or friction_coefficient, above 0");
  refused(pin + "friction_coefficient = 0.2\n", "radius",
          "missing; the coordinate of joint \"hinge.0\" is an angle");
  refused(pin + "effort = 1.0\nradius = 0.1\n", "radius", "not used without friction_coefficient");
  refused(slide + "friction_coefficient = 0.2\nradius = 0.1\n", "radius", "not used; joint \"rail\" slides");
  refused(slide + "effort = 1.0\nstatic_ratio = 1.5\n", "stribeck_rate", "belong together");
  refused(slide + "effort = 1.0\nstribeck_rate = 1.5\n", "stribeck_rate", "belong together");
  refused(slide + "effort = 1.0\nstatic_ratio = 0.5\n", "static_ratio", "at least 1");
  refused(slide + "effort = -1.0\n", "effort", "at least 0");
  refused(slide + "effort = 1.0\ndamping = -1.0\n", "damping", "at least 0");
  refused("joint = \"weld\"\neffort = 1.0\n", "joint", "it must be revolute or translational");
  CHECK(contains(refusal("[[joint_frictions]]\nname = \"f\"\neffort = 1.0\n" + slide),
                 "joint_frictions.f.stiffness"));
  CHECK(contains(refusal("[[joint_frictions]]\nname = \"f\"\neffort = 1.0\nstiffness = 0.0\n" + slide),
                 "above 0"));
}

TEST_CASE("couplers of every type have their coefficients") {
  const auto coefficients = [](const std::string& rest) {
    return model_of(kDeck + coupler(rest)).couplers.at(0).coefficients;
  };
  const std::string hinges = "joints = [\"hinge.0\", \"hinge.1\"]\n";
  CHECK(coefficients("type = \"gear\"\nradii = [2, 6]\n" + hinges) == std::vector<Real>{1, 3});
  CHECK(coefficients("type = \"gear\"\nradii = [2, 6]\ninternal = true\n" + hinges) ==
        std::vector<Real>{1, -3});
  CHECK(coefficients("type = \"belt\"\nradii = [2, 6]\n" + hinges) == std::vector<Real>{1, -3});
  CHECK(coefficients("type = \"rack-and-pinion\"\nradius = 0.2\njoints = [\"hinge.0\", \"rail\"]\n") ==
        std::vector<Real>{-0.2, 1});
  CHECK(coefficients("type = \"differential\"\njoints = [\"hinge.0\", \"hinge.1\", \"hinge.2\"]\n") ==
        std::vector<Real>{1, 1, -2});
  CHECK(coefficients("type = \"sum\"\ncoefficients = [2, -0.5]\njoints = [\"rail\", \"hinge.1\"]\n") ==
        std::vector<Real>{2, -0.5});
}

TEST_CASE("a joint without a coordinate is refused with its name and kind") {
  CHECK(contains(refusal("[[motors]]\nname = \"m\"\njoint = \"weld\"\ntype = \"effort\"\neffort = 1.0\n"),
                 "joint \"weld\" is a fixed joint; it must be revolute or translational"));
  CHECK(contains(refusal("[[joint_limits]]\nname = \"m\"\njoint = \"rail\"\nstiffness = 1.0\n"),
                 "a limit needs lower, upper or both"));
  CHECK(
      contains(refusal(coupler("type = \"sum\"\ncoefficients = [1, 0]\njoints = [\"rail\", \"hinge.0\"]\n")),
               "must not be 0"));
  CHECK(
      contains(refusal(coupler("type = \"rack-and-pinion\"\nradius = 1\njoints = [\"rail\", \"hinge.0\"]\n")),
               "joint \"rail\" must be revolute here"));
  const std::string two = "name = \"s\"\njoint = \"rail\"\n";
  CHECK(contains(refusal("[[joint_springs]]\n" + two + "[[joint_springs]]\n" + two), "\"s\""));
}

}  // namespace scree
