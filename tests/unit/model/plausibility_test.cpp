// Decks that can be computed but are hardly intended, one after the other; and numbers that cannot be
// computed with.
#include "model/checks/plausibility.hpp"

#include "support/catch.hpp"
#include "support/models.hpp"

namespace scree {

namespace {

const std::string kPair = "[[contact.pairs]]\nstiffness = 1e5\ndamping = 1.0\n";
const std::string kDisc =
    "[[particles]]\nname = \"d\"\nkind = \"list\"\npositions = [[0, 0]]\nradius = 0.05\nmass = 1.0\n";
const std::string kBody =
    "[[bodies]]\nname = \"b\"\nmass = 1.0\ninertia = 0.01\nposition = [0.5, 0.5]\nshapes = [{ radius = 0.1 "
    "}]\n";
const std::string kFloor = "space.y_min=wall", kGravity = "gravity=[0, -10]";
const std::string kMeshOnBody =
    "bodies=[{name=\"b\",kind=\"spatial\",mass=1.0,inertia_tensor=[0.1,0.1,0.1,0,0,0],position=[0,0,0.6],"
    "meshes=[{mesh=\"m\"}]}]";
const std::string kHinge =
    "joints=[{name=\"hinge\",type=\"revolute\",bodies=[\"ground\",\"b\"],point=[0,0,0.6],axis=[0,0,1]}]";
const std::string kPlane = "walls=[{name=\"w\",point=[0,0,-0.4],normal=[0,0,1]}]";
const std::string kMetalCrate =
    "bodies=[{name=\"b\",kind=\"spatial\",mass=1.0,inertia_tensor=[0.1,0.1,0.1,0,0,0],position=[0,0,0.6],"
    "meshes=[{mesh=\"m\",material=\"iron\"}]}]";
const std::string kFourSides =
    "space={dimension=3,min=[-1,-1,-1],max=[1,1,1],x_min=\"wall\",x_max=\"wall\",y_min=\"wall\","
    "y_max=\"wall\",wall_material=\"lead\"}";
const std::string kSpheres = R"([space]
dimension = 3
min = [-1, -1, -1]
max = [1, 1, 1]
[time]
end = 1.0
step = 1e-4
control = "fixed"
)";
// A box of iron, and walls that may be of lead.
const std::string kTwoMetals = R"(
[[materials]]
name = "iron"
[[materials]]
name = "lead"
[[contact.pairs]]
materials = ["iron", "iron"]
stiffness = 1e5
[[contact.pairs]]
materials = ["lead", "lead"]
stiffness = 1e5
[[meshes]]
name = "m"
kind = "box"
size = [0.2, 0.2, 0.2]
)";
const std::string kSphere =
    "[[particles]]\nname = \"d\"\nkind = \"list\"\npositions = [[0, 0, 0]]\nradius = 0.05\nmass = 1.0\n";

struct Case {
  std::string deck;
  std::vector<std::string> overrides;
  std::string warning;  // a part of it; empty: there must be none
};

}  // namespace

TEST_CASE("one warning for each finding, none for what is just below it") {
  const std::string all = kSmallDeck + kPair + kDisc + kBody, spheres = kSpheres + kPair + kSphere;
  const auto group = [](const std::string& name, const std::string& corners) {
    return "[[particles]]\nname = \"" + name +
           "\"\nkind = \"random\"\ncount = 3\nradius = 0.05\nmass = 1.0\n" + corners;
  };
  const std::string random = kSmallDeck + kPair + group("a", "min = [-0.9, -0.9]\nmax = [-0.1, -0.1]\n") +
                             group("c", "min = [0.1, 0.1]\nmax = [0.9, 0.9]\n");
  const std::string moved =
      kSmallDeck + kPair + kDisc +
      "[[walls]]\nname = \"w\"\npoint = [0, -1]\nnormal = [0, 1]\n[[walls.motions]]\ntype = "
      "\"translation\"\ndirection = [0, 1]\ndisplacement = { kind = \"table\", times = [0, 0.5, 1], values = "
      "[0, 0.02, 0.02], interpolation = \"monotone\" }\n";
  const std::string sheet =
      spheres +
      "[[meshes]]\nname = \"m\"\nkind = \"rectangle\"\nsize = [0.5, 0.5]\noffset = [0, 0, "
      "-0.4]\n[[walls]]\nname = \"w\"\nmesh = \"m\"\n";
  // Particles, and a floor of another material.
  const std::string two_materials =
      kSmallDeck +
      "[[materials]]\nname = \"grain\"\n[[materials]]\nname = \"ground\"\n[[contact.pairs]]\nmaterials = "
      "[\"grain\", \"grain\"]\nstiffness = 3e3\n[[contact.pairs]]\nmaterials = [\"grain\", "
      "\"ground\"]\nstiffness = 1e6\n" +
      group("d", "min = [-0.9, -0.9]\nmax = [0.9, 0.9]\n") + "material = \"grain\"\n";
  const std::string two_metals = kSpheres + kTwoMetals;
  const std::vector<Case> cases = {
      {all, {kFloor, kGravity, "time.step=1e-4"}, ""},
      {spheres, {"gravity=[0, 0, -10]"}, ""},
      {kSmallDeck, {}, "the deck has no particles and no bodies: nothing will move"},
      {kSmallDeck + kBody, {}, ""},
      {kSmallDeck + kPair + kBody,
       {},
       "no particles, and yet contact.pairs has a law for \"default\" on \"default\""},
      {kSmallDeck + kBody,
       {"integrator.particles=velocity-verlet", "time.control=fixed"},
       "no particles, and yet integrator.particles = \"velocity-verlet\""},
      {kSmallDeck + kPair + kBody,
       {kFloor, "integrator.particles=velocity-verlet", "time.control=fixed"},
       ""},
      {kSmallDeck + kPair + kDisc,
       {"particles.d.positions=[]"},
       "particles.d.positions = []: the group has no particles"},
      {spheres + kBody,
       {"gravity=[0, 0, -10]", "bodies.b.position=[0.5, 0.5, 0]"},
       "gravity has -10 m/s^2 along z: planar bodies move in the x-y plane only"},
      {spheres,
       {"particles.d.radius=1.1", "particles.d.mass=5e3"},
       "a particle of radius 1.1 m is larger than the space, 2 m long in x"},
      {all,
       {"bodies.b.shapes=[{ radius = 1.01 }]", "contact.max_start_overlap=1", "bodies.b.position=[0.9, 0.9]",
        "particles.d.positions=[[-0.9, -0.9]]"},
       "a shape of body \"b\" of radius 1.01 m is larger than the space, 2 m long in x"},
      {all, {"bodies.b.inertia=0.0399"}, ""},
      {all,
       {"bodies.b.inertia=0.0401"},
       "body \"b\": inertia 0.0401 kg m^2 and mass 1 kg make a radius of gyration of 0.2002 m, while its "
       "shapes and "
       "joints reach 0.1 m"},
      {all + "[[joints]]\nname = \"pin\"\ntype = \"revolute\"\nbodies = [\"ground\", \"b\"]\npoint = [0.5, "
             "0.9]\n",
       {"bodies.b.inertia=0.0401"},
       ""},
      {all, {"contact.pairs.0.damping=400", "time.step=1e-4"}, ""},  // critical: 2 sqrt(1e5 x 0.5) = 447
      {all,
       {"contact.pairs.0.damping=460", "time.step=1e-4"},
       "contact \"default\" on \"default\": a damping of 460 N s/m is 1.03 times the critical one of its "
       "lightest "
       "pair, 447 N s/m: nothing rebounds"},
      {all,
       {kFloor, kGravity, "contact.pairs.0.stiffness=100", "contact.pairs.0.damping=0"},
       "too soft for the weight on it: 1 particles on top of each other weigh 10 N, an overlap of 0.1 m"},
      {all,
       {"contact.pairs.0.stiffness=1e3", "particles.d.velocity=[2, 0]", "contact.pairs.0.damping=0"},
       ""},
      {all,
       {"contact.pairs.0.stiffness=1e3", "particles.d.velocity=[3, 0]", "contact.pairs.0.damping=0"},
       "the stiffness is too low for impacts at 3 m/s (speeds at t = 0, and a fall through the space): an "
       "overlap of "
       "0.0671 m at a radius of 0.05 m"},
      {all,
       {"contact.pairs.0.stiffness=3e3", kFloor, kGravity, "contact.pairs.0.damping=0"},
       "the stiffness is too low for impacts at 6.32 m/s"},
      {two_materials,
       {kFloor, kGravity, "space.wall_material=ground"},
       "contact \"grain\" on \"grain\": the stiffness is too low for impacts at 6.32 m/s"},
      {two_materials, {kGravity}, ""},  // all fall together
      {sheet,
       {"contact.pairs.0.stiffness=1e3", "particles.d.velocity=[4, 0, 0]", "contact.pairs.0.damping=0"},
       ""},
      {sheet,
       {"contact.pairs.0.stiffness=1e3", "particles.d.velocity=[5, 0, 0]", "contact.pairs.0.damping=0"},
       "an overlap of 0.112 m at a radius of 0.05 m, and things pass through each other"},
      {sheet,
       {"contact.pairs.0.stiffness=1e3", "particles.d.velocity=[4, 0, 0]", "contact.pairs.0.damping=0",
        "space.z_min=wall"},
       "an overlap of 0.0894 m at a radius of 0.05 m, and things pass through each other"},
      {all, {"bodies.b.shapes=[{ radius = 0.1 }, { radius = 1.1e-6 }]"}, ""},
      {all, {"bodies.b.shapes=[{ radius = 0.1 }, { radius = 0.9e-6 }]"}, "radii from 9e-07 to 0.1 m"},
      {spheres,
       {"particles.d.mass=20"},
       "their masses and radii make a density of 3.82e+04 kg/m^3, which no material has"},
      {spheres, {"particles.d.mass=1e-5"}, "their masses and radii make a density of 0.0191 kg/m^3"},
      {kSmallDeck + kPair + kDisc + "[[materials]]\nname = \"m\"\ndensity = 2.5e5\n",
       {},
       "materials.m.density: no material has 2.5e+05 kg/m^3"},
      {all, {"time.end=1e5", "time.step=1e-4", "time.control=fixed"}, ""},
      {all,
       {"time.end=1e5", "time.step=0.9e-4", "time.control=fixed"},
       "time.end / time.step = 1.11e+09 steps"},
      {random, {}, "particles.c: the same count, seed and size of the box as particles.a: "},
      {random, {"particles.c.seed=2"}, ""},
      {random, {"particles.c.max=[0.5, 0.9]"}, ""},
      {moved, {}, ""},
      {sheet, {"walls.w.surface_velocity=[1, 0, 0]", "contact.pairs.0.friction=0.1"}, ""},
      {sheet,
       {"walls.w.surface_velocity=[1, 0, 0]"},
       "wall \"w\": its surface_velocity has no effect: no pair in contact.pairs has friction"},
      {sheet, {"particles=[]", kMeshOnBody}, "bodies have meshes, and the deck has nothing that these touch"},
      {sheet,
       {kMeshOnBody},
       "body \"b\": no joint holds it, and it has meshes and no discs or spheres: meshes do not touch walls "
       "that are meshes: it passes through \"w\"; shapes"},
      {sheet, {kMeshOnBody, "bodies.b.shapes=[{ radius = 0.1 }]"}, ""},
      {sheet, {kMeshOnBody, kHinge}, ""},
      {sheet,
       {kMeshOnBody, "bodies.b.count=3", "bodies.b.spacing=[0, 0, 0.1]"},
       "it passes through \"w\", and so do 2 other bodies"},
      {sheet, {kMeshOnBody, kPlane}, ""},
      {sheet, {kMeshOnBody, "walls=[]", "space.z_min=wall"}, ""},
      {two_metals,
       {kMetalCrate, kFourSides},
       "body \"b\": no joint holds it, and contact.pairs has no law for its meshes there: they touch planes "
       "where there is one: it passes through \"x_min\", \"x_max\", \"y_min\" and 1 more; a pair of the two"},
      {sheet, {kMeshOnBody, "walls=[]"}, ""},
      {moved,
       {"walls.w.motions.0.displacement.interpolation=natural"},
       "walls.w.motions.0.displacement: between 0.5 s and 1 s the natural spline overshoots the values "
       "there, to "},
      {all,
       {"time.end=1e5", "time.control=adaptive", "time.max_step=1e-5", "time.step=1e-6"},
       "time.end / time.max_step = 1e+10 steps at least"},
  };
  for (const Case& one : cases) {
    CAPTURE(one.deck, one.overrides, one.warning);
    std::vector<std::string> warnings = model_warnings(one.deck, one.overrides);
    // Steps against contact times are covered by another file.
    std::erase_if(warnings, [](const std::string& text) {
      return text.starts_with("time.") && !contains(text, "end /");
    });
    CAPTURE(warnings);
    if (one.warning.empty()) {
      CHECK(warnings.empty());
    } else {
      CHECK(std::count_if(warnings.begin(), warnings.end(),
                          [&](const std::string& text) { return contains(text, one.warning); }) == 1);
    }
  }
}

TEST_CASE("no warning for loose meshes that planes stop, or must let through") {
  const std::string deck = kSpheres + kTwoMetals;
  const auto warned = [&](const std::string& more, const std::vector<std::string>& overrides) {
    return std::ranges::any_of(model_warnings(deck + more, overrides),
                               [](const std::string& text) { return contains(text, "no joint holds it"); });
  };
  CHECK(warned("", {kMetalCrate, kFourSides}));
  for (const std::string stiffness : {"0", "2e5"})
    CHECK(!warned("[[contact.pairs]]\nmaterials = [\"lead\", \"iron\"]\nstiffness = " + stiffness + "\n",
                  {kMetalCrate, kFourSides}));
  CHECK(!warned("", {kMetalCrate, "space.z_min=wall", "space.wall_material=iron"}));
}

TEST_CASE("numbers that cannot be computed with") {
  const std::string all = kSmallDeck + kPair + kDisc + kBody;
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"bodies.b.mass=1e-310", "1e-310 is too small; must be at least 2.23e-308"},
      {"bodies.b.inertia=1e-310", "1e-310 is too small"},
      {"bodies.b.shapes.0.radius=1e-310", "1e-310 is too small"},
      {"particles.d.mass=1e-310", "--set particles.d.mass=1e-310: 1e-310 is too small"},
      {"particles.d.radius=1e-310", "--set particles.d.radius=1e-310: 1e-310 is too small"},
      {"integrator.residual_tolerance=1.5", "must be a number above 0 and at most 1"},
      {"integrator.correction_tolerance=1.5", "must be a number above 0 and at most 1"},
      {"contact.pairs.0.stiffness=1e-320", "1e-320 is too small; must be at least 2.23e-308"},
  };
  for (const auto& [override, message] : cases) {
    CAPTURE(override, model_error(all, {override}));
    CHECK(contains(model_error(all, {override}), message));
  }
  CHECK(contains(model_error(all, {"time.control=adaptive", "time.tolerance=1.5"}),
                 "must be a number above 0 and at most 1"));
}

}  // namespace scree
