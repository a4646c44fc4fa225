// Speeds of driven surfaces, and the resulting stiffness and step.
#include "model/derived/surface_speeds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/checks/body_load.hpp"
#include "model/checks/impact_speed.hpp"
#include "model/checks/limits.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kPi = std::numbers::pi_v<Real>;

const std::string kSpheres = R"(
[space]
dimension = 3
min = [-1.0, -1.0, -1.0]
max = [1.0, 1.0, 1.0]
leaving = "ballistic"
[time]
end = 0.5
[integrator]
particles = "hht"
[[contact.pairs]]
stiffness = 2e4
restitution = 0.5
[[particles]]
kind = "list"
positions = [[-0.5, 0.0123, 0.0045]]
radius = 0.01
density = 2000.0
)";
const std::string kPlate =
    "[[meshes]]\nname = \"m\"\nkind = \"rectangle\"\nsize = [0.4, 0.2]\nz_axis = [1.0, 0.0, 0.0]\n"
    "x_axis = [0.0, 1.0, 0.0]\noffset = [-0.1, 0.0, 0.0]\n[[walls]]\nname = \"w\"\nmesh = \"m\"\nmotions = [";
const std::string kPlane =
    "[[walls]]\nname = \"w\"\npoint = [0.0, 0.0, -0.5]\nnormal = [0.0, 0.0, 1.0]\nmotions = [";

std::string along(const std::string& direction, const std::string& displacement) {
  return "{ type = \"translation\", direction = " + direction + ", displacement = " + displacement + " },";
}
std::string about(const std::string& axis, const std::string& point, const std::string& angle) {
  return "{ type = \"rotation\", axis = " + axis + ", point = " + point + ", angle = " + angle + " },";
}

Real speed_of(const std::string& more, const std::vector<std::string>& overrides = {}) {
  const Model model = model_of(kSpheres + more, overrides);
  return surface_speeds(model)[0];
}

}  // namespace

TEST_CASE("walls count with the fastest that they move along their normals") {
  const std::string x = "[1, 0, 0]", y = "[0, 1, 0]", z = "[0, 0, 1]",
                    ramp = "{ kind = \"ramp\", rate = 6.0 }";
  const Real round_off = 1e-12;
  const auto is = [&](const std::string& wall, Real speed, Real tolerance) {
    CAPTURE(wall);
    CHECK(near(speed_of(wall + "]\n"), speed, {.relative = tolerance, .absolute = 1e-12}));
  };
  is(kPlate + along(x, ramp), 6, round_off);
  is(kPlate + along("[-1, 0, 0]", ramp), 6, round_off);
  // A plate that moves in its plane has edges that hit particles in their path.
  is(kPlate + along(y, ramp), 6, round_off);
  is(kPlane + along(y, ramp), 0, round_off);
  is(kPlane + along("[0, 3, 4]", ramp), 4.8, round_off);
  is(kPlate + along(x, "{ kind = \"sine\", amplitude = 0.02, frequency = 10.0, phase = 1.0 }"), 0.4 * kPi,
     round_off);
  // Less than a quarter of a period: fastest at the start.
  is(kPlate + along(x, "{ kind = \"sine\", amplitude = 0.02, frequency = 0.1 }"), 0.02 * 0.2 * kPi,
     round_off);
  is(kPlate + along(x, "{ kind = \"step\", value = 0.0, end_value = 0.1, start = 0.1, end = 0.2 }"), 1.875,
     round_off);
  is(kPlate + along(x,
                    "{ kind = \"table\", times = [0, 0.2, 0.5], values = [0, 0.1, 0.1], interpolation = "
                    "\"monotone\" }"),
     0.1 / 0.2 * 1.875, 0.35);
  // About its own edge at y = -0.2: the other edge is 0.4 m from it.
  is(kPlate + about(z, "[-0.1, -0.2, 0]", ramp), 2.4, round_off);
  is(kPlane + about(x, "[0, 0, -0.5]", ramp), 6 * std::sqrt(1 + 1.5 * 1.5), 0.2);
  // Combined motion: the plate swings while it is carried.
  is(kPlate + about(z, "[-0.1, -0.2, 0]", ramp) + along(x, ramp), 8.4, 0.01);
}

TEST_CASE("rotation about its own axis has no impact speed, an eccentric one has") {
  const auto drum = [](const std::string& lifters) {
    return "[[meshes]]\nname = \"m\"\nkind = \"drum\"\nradius = 0.2\nwall = 0.01\nlength = 0.3\nsegments = "
           "96\n" +
           lifters + "[[walls]]\nname = \"w\"\nmesh = \"m\"\nmotions = [" +
           about("[0, 0, 1]", "[0, 0, 0]", "{ kind = \"ramp\", rate = 10.0 }") + "]\n";
  };
  CHECK(speed_of(drum("")) < 10 * 0.21 * 0.05);
  const Real lifted = speed_of(drum("lifters = 4\nlifter_height = 0.05\nlifter_width = 0.02\n"));
  CHECK(lifted > 1.9);
  CHECK(lifted < 2.1 * 1.01);
  CHECK(
      speed_of(
          "[[walls]]\nname = \"b\"\npoint = [0, 0, -0.5]\nnormal = [0, 0, 1]\nsurface_velocity = [9, 0, 0]\n",
          {"contact.pairs.0.friction=0.1"}) == 0);
}

TEST_CASE("bodies that drivers and motors move count, and those fixed to them") {
  const std::string body =
      "[[bodies]]\nname = \"arm\"\nkind = \"spatial\"\nposition = [0.3, 0, 0]\nmass = 1.0\n"
      "inertia_tensor = [0.1, 0.1, 0.1, 0, 0, 0]\nshapes = [{ radius = 0.05, offset = [0.1, 0, 0] }]\n"
      "[[joints]]\nname = \"axle\"\ntype = \"revolute\"\nbodies = [\"ground\", \"arm\"]\npoint = [0, 0, 0]\n"
      "axis = [0, 0, 1]\n";
  const std::string
      driver =
          "[[drivers]]\nname = \"d\"\njoint = \"axle\"\nmotion = { kind = \"ramp\", rate = 20.0, "
          "start = 0.1, end = 0.2 }\n",
      motor =
          "[[motors]]\nname = \"d\"\njoint = \"axle\"\ntype = \"speed\"\nrate = { kind = \"ramp\", "
          "rate = 100.0 }\ngain = 1.0\n",
      no_load =
          "[[motors]]\nname = \"d\"\njoint = \"axle\"\ntype = \"line\"\nstall_effort = 2.0\nfree_rate = "
          "40.0\n"
          "command = 0.5\n",
      tip =
          "[[bodies]]\nname = \"tip\"\nkind = \"spatial\"\nposition = [0.8, 0, 0]\nmass = 1.0\n"
          "inertia_tensor = [0.1, 0.1, 0.1, 0, 0, 0]\nshapes = [{ radius = 0.02 }]\n"
          "[[joints]]\nname = \"weld\"\ntype = \"fixed\"\nbodies = [\"arm\", \"tip\"]\npoint = [0.5, 0, 0]\n";
  CHECK(speed_of(body) == 0);
  CHECK(near(speed_of(body + driver), 20 * 0.4, {.relative = 1e-12}));
  CHECK(near(speed_of(body + motor), 50 * 0.4, {.relative = 1e-12}));
  CHECK(near(speed_of(body + no_load), 0.5 * 40 * 0.4, {.relative = 1e-12}));
  CHECK(near(speed_of(body + tip + driver), 20 * 0.8, {.relative = 1e-12}));
}

TEST_CASE("a stiffness too low for a wall's speed is warned of, and a step in which it passes a radius") {
  const auto plate = [](Real speed) {
    return kSpheres + kPlate + along("[1, 0, 0]", fmt::format("{{ kind = \"ramp\", rate = {} }}", speed)) +
           "]\n";
  };
  const auto soft = [](const std::vector<std::string>& warnings) {
    return std::ranges::count_if(warnings,
                                 [](const std::string& w) { return contains(w, "stiffness is too low"); });
  };
  const std::vector<std::string> fast = model_warnings(plate(60));
  CHECK(soft(fast) == 1);
  CHECK(contains(fast.front(),
                 "impacts at 60 m/s (speeds at t = 0, and a fall through the space, and surfaces that "
                 "motions, drivers and motors move at up to 60 m/s)"));
  CHECK(soft(model_warnings(plate(20))) == 0);
  CHECK(soft(model_warnings(plate(60), {"contact.pairs.0.stiffness=1e6"})) == 0);
  // Half a radius in a step that adapts.
  CHECK(near(model_of(plate(60)).time.max_step, 0.005 / 60, {.relative = 1e-12}));
  const auto passes = [&](const char* step) {
    const auto warnings = model_warnings(
        plate(60), {"contact.pairs.0.stiffness=1e6", "time.control=fixed", std::string("time.step=") + step});
    return std::ranges::count_if(warnings, [](const std::string& w) {
      return contains(w, "may pass others unnoticed; it should be at most 8.3e-05 s");
    });
  };
  CHECK(passes("2e-4") == 1);
  CHECK(passes("1e-4") == 0);
}

// Whatever its mass, a driven body does not yield to contacts.
TEST_CASE("the mass of a body held by a driver or a fixed joint affects neither steps nor warnings") {
  const auto paddle = [](Real mass, const std::string& joint) {
    return kSpheres +
           fmt::format(
               "[[bodies]]\nname = \"arm\"\nkind = \"spatial\"\nposition = [0.3, 0, 0]\nmass = {0}\n"
               "inertia_tensor = [{0}, {0}, {0}, 0, 0, 0]\nshapes = [{{ radius = 0.05, offset = [0.1, 0, 0] "
               "}}]\n"
               "[[joints]]\nname = \"axle\"\nbodies = [\"ground\", \"arm\"]\npoint = [0, 0, 0]\n{1}",
               mass, joint);
  };
  const std::string driven =
      "type = \"revolute\"\naxis = [0, 0, 1]\n[[drivers]]\nname = \"d\"\njoint = \"axle\"\n"
      "motion = { kind = \"ramp\", rate = 150.0, start = 0.1, end = 0.2 }\n";
  const std::vector<std::string> is_explicit{"integrator.particles=velocity-verlet"};
  for (const std::string& joint : {driven, std::string("type = \"fixed\"\n")}) {
    const Model light = model_of(paddle(1e-5, joint), is_explicit),
                heavy = model_of(paddle(1e3, joint), is_explicit);
    CHECK(light.time.step == heavy.time.step);
    CHECK(body_step_limit(light).frequency == 0);
    CHECK(!shortest_loaded_step(light));
  }
  const auto soft = [&](Real mass) {
    return std::ranges::count_if(model_warnings(paddle(mass, driven)), [](const std::string& w) {
      return contains(w, "stiffness is too low for impacts at 60 m/s");
    });
  };
  CHECK(soft(1e-5) == 1);
  CHECK(soft(1e3) == 1);
  // A revolute joint alone fixes nothing.
  const std::string hinge = "type = \"revolute\"\naxis = [0, 0, 1]\n";
  CHECK(model_of(paddle(1e-5, hinge), is_explicit).time.step <
        model_of(paddle(1e3, hinge), is_explicit).time.step);
}

}  // namespace scree
