// Bodies given by frames off their centres of mass, by solids and by two axes; markers, and the joints and
// forces that refer to them.
#include <fmt/format.h>

#include <numbers>
#include <string>

#include "model/derived/connections.hpp"
#include "physics/spatial_rotation.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 4e-16;

const std::string kSpace =
    "[space]\ndimension = 3\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\n[time]\nend = 1.0\nstep = 1e-3\ncontrol = "
    "\"fixed\"\n";
const std::string kMass = "mass = 2.0\ninertia_tensor = [0.2, 0.3, 0.4, 0.0, 0.0, 0.0]\n";
// By a quarter revolution about z.
const std::string kQuarter = "rotation_axis = [0, 0, 1]\nrotation_angle = 1.5707963267948966\n";

std::string body(const std::string& name, const std::string& keys) {
  return fmt::format("[[bodies]]\nname = \"{}\"\nkind = \"spatial\"\nposition = [0.1, 0.2, 0.3]\n{}", name,
                     keys);
}
std::string marker(const std::string& name, const std::string& on, const std::string& keys) {
  return fmt::format("[[markers]]\nname = \"{}\"\nbody = \"{}\"\n{}", name, on, keys);
}
std::string joint(const std::string& type, const std::string& keys = "markers = [\"m\", \"n\"]\n") {
  return fmt::format("[[joints]]\nname = \"j\"\ntype = \"{}\"\n{}", type, keys);
}
// Body a, and b rotated by a quarter revolution, both with their origins at one point; a marker m on a, n on
// b.
std::string marked(const std::string& on_a, const std::string& on_b) {
  return kSpace + body("a", kMass) + body("b", kMass + kQuarter + "center_of_mass = [0.0, 0.1, 0.0]\n") +
         marker("m", "a", on_a) + marker("n", "b", on_b);
}

}  // namespace

TEST_CASE("position and velocity of the deck are those of the frame's origin") {
  const Model model = model_of(
      kSpace +
      body("a", kMass + kQuarter +
                    "center_of_mass = [0.5, 0.0, 0.25]\nvelocity = [1.0, 0.0, 0.0]\n"
                    "body_angular_velocity = [0.0, 0.0, 4.0]\nshapes = [{ radius = 0.01, offset = [0.5, "
                    "0.125, 0.25] }]\n"));
  const Body& a = model.bodies[0];
  CHECK(norm(a.position - Vec3{0.1, 0.7, 0.55}) < kRoundOff);
  CHECK(norm(a.velocity - Vec3{-1, 0, 0}) < 1e-15);  // 1 - 4 * 0.5
  CHECK((a.shapes[0].offset == Vec3{0, 0.125, 0}));
  CHECK(norm(to_global_point(model, 0, a.shapes[0].offset) - Vec3{-0.025, 0.7, 0.55}) < kRoundOff);
}

TEST_CASE("planar bodies have a frame beside their centre of mass, too") {
  const std::string disc =
      "[[bodies]]\nname = \"d\"\nmass = 1.0\ninertia = 0.1\nposition = [0.1, 0.2]\nangle = "
      "1.5707963267948966\nangular_velocity = 2.0\ncenter_of_mass = [0.5, 0.0]\n";
  const Model model = model_of(kSmallDeck + disc +
                               "[[joints]]\nname = \"j\"\ntype = \"revolute\"\nbodies = [\"ground\", "
                               "\"d\"]\nlocal_points = [[0.1, 0.2], [0.0, 0.0]]\n");
  CHECK(norm(model.bodies[0].position - Vec3{0.1, 0.7, 0}) < kRoundOff);
  CHECK(norm(model.bodies[0].velocity - Vec3{-1, 0, 0}) < kRoundOff);
  CHECK((model.joints[0].point[1] == Vec3{-0.5, 0, 0}));
}

TEST_CASE("the inertia's own axes") {
  const Model model =
      model_of(kSpace + body("a", kMass + "inertia_rotation_axis = [0, 0, 1]\ninertia_rotation_angle = "
                                          "0.78539816339744831\n"));
  const Sym3& j = model.bodies[0].inertia_tensor;  // of 0.2 and 0.3 along the diagonals
  CHECK(near(j.xx, 0.25, {.absolute = kRoundOff}));
  CHECK(near(j.yy, 0.25, {.absolute = kRoundOff}));
  CHECK(near(j.xy, -0.05, {.absolute = kRoundOff}));
  CHECK(near(j.zz, 0.4, {.absolute = kRoundOff}));
}

TEST_CASE("two axes make an orientation") {
  const auto axes = [](const std::string& keys) {
    return rotation_matrix(model_of(kSpace + body("a", kMass + keys)).bodies[0].orientation);
  };
  const Mat3 both = axes("x_axis = [0.0, 2.0, 0.0]\nz_axis = [3.0, 0.0, 0.0]\n");
  CHECK(norm(both * Vec3{1, 0, 0} - Vec3{0, 1, 0}) < kRoundOff);
  CHECK(norm(both * Vec3{0, 0, 1} - Vec3{1, 0, 0}) < kRoundOff);
  // z is kept where the axes are not quite perpendicular.
  const Mat3 nearly = axes("x_axis = [1.0, 0.0, 5e-7]\nz_axis = [0.0, 0.0, 1.0]\n");
  CHECK(norm(nearly * Vec3{0, 0, 1} - Vec3{0, 0, 1}) < kRoundOff);
  CHECK(norm(nearly * Vec3{1, 0, 0} - Vec3{1, 0, 0}) < kRoundOff);
  const Mat3 alone = axes("z_axis = [0.0, 3.0, 4.0]\n");
  CHECK(norm(alone * Vec3{0, 0, 1} - Vec3{0, 0.6, 0.8}) < kRoundOff);
  CHECK(
      contains(model_error(kSpace + body("a", kMass + "x_axis = [1, 0, 2e-6]\nz_axis = [0, 0, 1]\n")),
               "bodies.a.x_axis = [1, 0, 2e-6]: must be perpendicular to z_axis; the cosine between them is "
               "2e-06, allowed is 1e-06"));
  CHECK(contains(model_error(kSpace + body("a", kMass + "x_axis = [1, 0, 0]\n")), "needs z_axis too"));
  CHECK(contains(model_error(kSpace + body("a", kMass + "z_axis = [0, 0, 0]\n")), "must not be 0"));
  CHECK(contains(model_error(kSpace + body("a", kMass + "z_axis = [0, 0, 1]\nquaternion = [1, 0, 0, 0]\n")),
                 "z_axis = [0, 0, 1]: not used together with quaternion"));
}

TEST_CASE("mass, centre and inertia from solids") {
  // A plate of 12 kg, edges 1, 2, 3, and a rod of 12 kg along x, radius 2 and length 3, at x = 4.
  const std::string solids =
      "solids = [{ kind = \"box\", size = [1.0, 2.0, 3.0], density = 2.0 }, { kind = \"cylinder\", radius = "
      "2.0, "
      "length = 3.0, density = 0.31830988618379067, offset = [4.0, 0.0, 0.0], z_axis = [1.0, 0.0, 0.0] }]\n";
  const Body a = model_of(kSpace + body("a", solids)).bodies[0];
  CHECK(near(a.mass, 24, {.relative = 1e-15}));
  CHECK(norm(a.center_of_mass - Vec3{2, 0, 0}) < 1e-15);
  CHECK(norm(a.position - Vec3{2.1, 0.2, 0.3}) < 1e-15);
  CHECK(near(a.inertia_tensor.xx, 13 + 24, {.relative = 1e-14}));
  CHECK(near(a.inertia_tensor.yy, 10 + 21 + 24 * 4, {.relative = 1e-14}));
  CHECK(near(a.inertia_tensor.zz, 5 + 21 + 24 * 4, {.relative = 1e-14}));
  // A planar body has the moment about z alone; in 2D a disc is a cylinder.
  const Body disc =
      model_of(
          kSmallDeck +
          "[[bodies]]\nname = \"d\"\nposition = [0.0, 0.0]\nsolids = [{ kind = \"cylinder\", radius = 0.5, "
          "length = 0.1, density = 1000.0, offset = [0.25, 0.0] }]\n")
          .bodies[0];
  const Real mass = 25 * std::numbers::pi_v<Real>;
  CHECK(near(disc.mass, mass, {.relative = 1e-15}));
  CHECK(near(disc.inertia, mass / 8, {.relative = 1e-15}));
  CHECK(disc.position.x == 0.25);
}

TEST_CASE("a solid's density may be its material's") {
  const std::string ball = "solids = [{ kind = \"sphere\", radius = 1.0 }]\n";
  const Body a =
      model_of(kSpace + "[[materials]]\nname = \"oak\"\ndensity = 750.0\n" + body("a", ball)).bodies[0];
  CHECK(near(a.mass, 1000 * std::numbers::pi_v<Real>, {.relative = 1e-15}));
  CHECK(contains(model_error(kSpace + body("a", ball)),
                 "bodies.a.solids.0.density: missing; the material has none, either"));
}

TEST_CASE("mass properties come from solids or from keys, not from both and not from neither") {
  const std::string solids = "solids = [{ kind = \"sphere\", radius = 1.0, density = 1.0 }]\n";
  CHECK(
      contains(model_error(kSpace + body("a", solids + "mass = 1.0\n")), "mass = 1.0: follows from solids"));
  CHECK(contains(model_error(kSpace + body("a", solids + "center_of_mass = [0, 0, 0]\n")),
                 "center_of_mass = [0, 0, 0]: follows from solids"));
  CHECK(contains(model_error(kSpace + body("a", solids + "inertia_z_axis = [0, 0, 1]\n")),
                 "follows from solids"));
  CHECK(contains(model_error(kSpace + body("a", "")), "bodies.a.mass: missing; without solids"));
  CHECK(contains(model_error(kSpace + body("a", "mass = 1.0\n")), "bodies.a.inertia_tensor: missing"));
  CHECK(contains(
      model_error(kSpace + body("a", "solids = [{ kind = \"box\", size = [1, 0, 1], density = 1.0 }]\n")),
      "above 0"));
  CHECK(contains(
      model_error(kSpace + body("a", "solids = [{ kind = \"sphere\", radius = 1e-200, density = 1.0 }]\n")),
      "solids.0.kind"));
}

TEST_CASE("a joint's ends are its markers") {
  const Model model = model_of(marked("local_point = [0.0, 0.0, 0.5]\nz_axis = [1.0, 0.0, 0.0]\n",
                                      "local_point = [0.0, 0.0, 0.5]\nz_axis = [0.0, -1.0, 0.0]\n") +
                               joint("revolute"));
  const Joint& j = model.joints[0];
  CHECK((j.body[0] == 0 && j.body[1] == 1));
  CHECK((j.point[0] == Vec3{0, 0, 0.5}));
  CHECK((j.point[1] == Vec3{0, -0.1, 0.5}));
  for (const int side : {0, 1})
    CHECK(norm(to_global_direction(model, side, rotated(j.marker[side], {0, 0, 1})) - Vec3{1, 0, 0}) <
          kRoundOff);
}

TEST_CASE("markers that do not coincide are refused with their distance") {
  const std::string along_x = "z_axis = [1, 0, 0]\n", same = "z_axis = [0, -1, 0]\n";
  CHECK(contains(model_error(marked(along_x + "local_point = [0, 0, 0.5]\n", same) + joint("revolute")),
                 "joints.j.markers = [\"m\", \"n\"]: the two sides of joint \"j\" do not meet"));
  // Parallel, but opposite: the rows of Phi would be satisfied.
  CHECK(contains(model_error(marked(along_x, "z_axis = [0, 1, 0]\n") + joint("cylindrical")),
                 "must point in the same direction at t = 0; they are off by 180 degrees, allowed are "
                 "5.7e-05 degrees; turn "
                 "one of them by half a turn"));
  CHECK(contains(model_error(marked(along_x, "z_axis = [0, -1, 0.01]\n") + joint("revolute")),
                 "they are off by 0.572939 degrees"));
  CHECK(contains(model_error(marked(along_x, "z_axis = [0, 1, 0]\n") +
                             joint("screw", "markers = [\"m\", \"n\"]\nlead = 0.1\n")),
                 "must point in the same direction"));
  CHECK(contains(model_error(marked("", "") + joint("fixed")),
                 "axes of the two markers must be the same at t = 0; "
                 "they are off by 90 degrees"));
  CHECK(contains(model_error(marked("", "") + joint("perpendicular")),
                 "must be perpendicular at t = 0; they are off by 90 degrees"));
  CHECK(contains(model_error(marked("", "z_axis = [0, 0, -1]\n") + joint("constant-velocity")),
                 "must not point against each other"));
  CHECK(contains(model_error(marked("", "") + joint("universal")), "the first marker's x axis must be"));
  CHECK(model_error(marked(along_x, "") + joint("spherical")).empty());
  CHECK(model_error(marked(along_x, same) + joint("planar")).empty());
}

TEST_CASE("axes of markers that are a little off are made exact") {
  const Model model = model_of(marked("", "z_axis = [0, 0, 1]\nx_axis = [1e-7, -1, 0]\n") + joint("fixed"));
  const Joint& j = model.joints[0];
  for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}})
    CHECK(norm(to_global_direction(model, 0, rotated(j.marker[0], axis)) -
               to_global_direction(model, 1, rotated(j.marker[1], axis))) < kRoundOff);
}

TEST_CASE("markers on rows, and where they cannot be") {
  const std::string links = kSpace +
                            "[[bodies]]\nname = \"link\"\nkind = \"spatial\"\ncount = 3\nspacing = [0.2, 0, "
                            "0]\nposition = [0, 0, 0]\n" +
                            kMass + marker("wall", "ground", "") + marker("tail", "link", "") +
                            marker("tip", "link", "local_point = [0.2, 0, 0]\n");
  const Model model =
      model_of(links + joint("spherical", "chain = \"link\"\nmarkers = [\"tip\", \"tail\"]\n"));
  REQUIRE(model.joints.size() == 2);
  CHECK((model.joints[1].body[0] == 1 && model.joints[1].body[1] == 2));
  CHECK((model.joints[1].point[0] == Vec3{0.2, 0, 0}));
  CHECK(contains(model_error(links + joint("spherical", "markers = [\"wall\", \"tail\"]\n")),
                 "\"tail\" is on each body of a row"));
  CHECK(
      contains(model_error(links + joint("spherical", "chain = \"link\"\nmarkers = [\"wall\", \"tail\"]\n")),
               "\"wall\" must be on the row here"));
  CHECK(contains(model_error(links + joint("spherical", "each = \"link\"\nmarkers = [\"tip\", \"tail\"]\n")),
                 "\"tip\" must be on the ground here"));
  CHECK(contains(model_error(links + joint("spherical", "chain = \"link\"\nmarkers = [\"tip\", \"tale\"]\n")),
                 "there is no marker named \"tale\""));
  CHECK(contains(model_error(links + joint("spherical", "markers = [\"wall\", \"wall\"]\n")),
                 "must be on two different bodies"));
  CHECK(contains(model_error(links + marker("wall", "ground", "")), "repeated"));
  CHECK(contains(model_error(links + marker("x", "lunk", "")),
                 "there is no body or row of bodies named \"lunk\""));
  CHECK(contains(model_error(links + marker("x", "Ground", "")), "did you mean \"ground\"?"));
}

TEST_CASE("keys redundant to markers are refused beside them") {
  const std::string deck = marked("", "");
  CHECK(contains(model_error(deck + joint("spherical", "markers = [\"m\", \"n\"]\npoint = [0, 0, 0]\n")),
                 "point = [0, 0, 0]: not used together with markers"));
  CHECK(contains(model_error(deck + joint("revolute", "markers = [\"m\", \"n\"]\naxis = [0, 0, 1]\n")),
                 "axis = [0, 0, 1]: not used together with markers"));
  CHECK(
      contains(model_error(deck + joint("spherical", "markers = [\"m\", \"n\"]\nbodies = [\"a\", \"b\"]\n")),
               "exactly one of the keys bodies, markers, chain and each"));
  CHECK(contains(
      model_error(deck + "[[bodies]]\nname = \"p\"\nmass = 1.0\ninertia = 1.0\nposition = [0, 0, 0]\n" +
                  marker("q", "p", "")),
      "markers.q.body = \"p\": must be spatial"));
}

TEST_CASE("springs and forces at markers") {
  const Model model =
      model_of(marked("local_point = [0, 0, 0.5]\nz_axis = [1, 0, 0]\n", "local_point = [0, 0, 0.1]\n") +
               "[[spring_dampers]]\nname = \"s\"\nmarkers = [\"m\", \"n\"]\nstiffness = "
               "2.0\n[[applied_forces]]\nname = "
               "\"f\"\nmarker = \"m\"\nfz = 3.0\nfollows_body = true\n");
  CHECK((model.spring_dampers[0].point[1] == Vec3{0, -0.1, 0.1}));
  CHECK(near(model.spring_dampers[0].free_length, 0.4, {.relative = 1e-15}));
  CHECK((model.applied_forces[0].point == Vec3{0, 0, 0.5}));
  CHECK(norm(rotated(model.applied_forces[0].axes, {0, 0, 1}) - Vec3{1, 0, 0}) < kRoundOff);
  CHECK(contains(model_error(marked("", "") + marker("g", "ground", "") +
                             "[[applied_forces]]\nname = \"f\"\nmarker = \"g\"\nfz = 3.0\n"),
                 "this one is on the ground"));
  CHECK(contains(model_error(marked("", "") + "[[applied_forces]]\nname = \"f\"\nfz = 3.0\n"),
                 "exactly one of the keys body and marker"));
}

}  // namespace scree
