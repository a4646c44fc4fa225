// Decks whose values are each allowed but contradict each other.
#include "support/catch.hpp"
#include "support/models.hpp"

namespace scree {

namespace {

const std::string kPair = "[[contact.pairs]]\nstiffness = 1e6\n";
const std::string kBodies = R"([[bodies]]
name = "a"
mass = 1.0
inertia = 0.1
position = [0.0, 0.0]
[[bodies]]
name = "row"
count = 3
spacing = [0.2, 0.0]
mass = 1.0
inertia = 0.1
position = [0.0, 0.5]
)";

std::string particles_at(const std::string& positions) {
  return "[[particles]]\nkind = \"list\"\npositions = " + positions + "\nradius = 0.05\nmass = 1.0\n";
}

std::string joint_with(const std::string& keys) { return "[[joints]]\nname = \"pin\"\n" + keys; }

}  // namespace

TEST_CASE("unknown names of materials, bodies and joints") {
  const std::string materials = "[[materials]]\nname = \"glass\"\n[[materials]]\nname = \"steel\"\n";
  CHECK(model_error(kSmallDeck + materials + particles_at("[[0, 0]]") + "material = \"glas\"\n") ==
        "deck.toml:19:12: particles.0.material = \"glas\": there is no material named \"glas\"; did you mean "
        "\"glass\"?");
  CHECK(contains(model_error(kSmallDeck + materials + particles_at("[[0, 0]]")),
                 "particles.0.material: missing; it must name a material, as the deck has more than one"));
  const std::string joint = joint_with("type = \"revolute\"\nbodies = [\"ground\", \"b\"]\n");
  CHECK(model_error(kSmallDeck + kBodies + joint) ==
        "deck.toml:25:10: joints.pin.bodies = [\"ground\", \"b\"]: there is no body named \"b\"; known: "
        "ground, a, row.0, row.1, row.2");
  for (const std::string ground : {"Ground", "GROUND", "grund"})
    CHECK(contains(model_error(kSmallDeck + kBodies +
                               joint_with("type = \"revolute\"\nbodies = [\"" + ground + "\", \"a\"]\n")),
                   "there is no body named \"" + ground + "\"; did you mean \"ground\"?"));
  CHECK(contains(
      model_error(kSmallDeck + kBodies + joint_with("type = \"revolute\"\nbodies = [\"a\", \"row\"]\n")),
      "\"row\" is a row; name one of its bodies, \"row.0\" to \"row.2\""));
  CHECK(
      contains(model_error(kSmallDeck + kBodies + joint_with("type = \"revolute\"\nchain = \"rwo\"\n")),
               "joints.pin.chain = \"rwo\": there is no body or row of bodies named \"rwo\"; did you mean"));
  CHECK(contains(model_error(kSmallDeck + "[[drivers]]\nname = \"d\"\njoint = \"pin\"\nmotion = 0.0\n"),
                 "drivers.d.joint = \"pin\": there is no joint named \"pin\""));
  CHECK(contains(model_error(kSmallDeck + "[output]\nhistory_bodies = [\"c\"]\n"),
                 "output.history_bodies = [\"c\"]"));
  CHECK(contains(model_error(kSmallDeck + "[output]\nhistory_particles = [0]\n"), "there is no particle 0"));
}

TEST_CASE("names of what a history records the contacts of") {
  const std::string walls = "[[walls]]\nname = \"floor\"\npoint = [0, 0]\nnormal = [0, 1]\n" + kPair;
  const auto recording = [&](const std::string& names) {
    return kSmallDeck + kBodies + walls + "[output]\nhistory_contacts = [" + names + "]\n";
  };
  const Model model = model_of(recording("\"row\", \"row.2\", \"floor\", \"x_max\""), {"space.x_max=wall"});
  const std::vector<ContactTarget>& targets = model.output.history_contacts;
  REQUIRE(targets.size() == 4);
  CHECK((targets[0].row && targets[0].bodies == std::vector<int>{1, 2, 3}));
  CHECK((!targets[1].row && targets[1].bodies == std::vector<int>{3} && targets[1].wall == -1));
  CHECK(model.walls[static_cast<std::size_t>(targets[2].wall)].name == "floor");
  CHECK(model.walls[static_cast<std::size_t>(targets[3].wall)].name == "x_max");
  CHECK(contains(model_error(recording("\"flor\"")),
                 "there is no body, row of bodies, mesh of a body, wall or side that is a wall named "
                 "\"flor\"; did you mean \"floor\"?"));
  CHECK(contains(model_error(recording("\"y_min\"")),
                 "the side y_min is no wall; space.y_min = \"wall\" makes it one"));
  CHECK(contains(model_error(recording("\"a\", \"floor\", \"a\"")),
                 "\"a\" is repeated; every entry must be another one"));
  CHECK(contains(model_error(recording("\"a\""), {"walls.0.name=a"}),
                 "\"a\" is the name of body \"a\" and of wall \"a\"; it must be that of one"));
}

TEST_CASE("planes across periodic axes are refused, and so are their rotations there") {
  const std::vector<std::string> periodic{"space.x_min=periodic", "space.x_max=periodic"};
  const auto deck = [](const std::string& normal, const std::string& motions) {
    return kSmallDeck + "[[walls]]\nname = \"floor\"\npoint = [0, 0]\nnormal = " + normal + "\n" + motions +
           kPair;
  };
  const std::string slope = "[0.1, 1]",
                    turns = "motions = [{ type = \"rotation\", point = [0, 0], angle = 1.0 }]\n";
  CHECK(contains(model_error(deck(slope, ""), periodic),
                 "walls.floor.normal = [0.1, 1]: has a part along x, which is periodic"));
  CHECK(
      contains(model_error(deck("[0, 1]", turns), periodic), "turns the plane across x, which is periodic"));
  CHECK(model_of(deck("[0, 1]", ""), periodic).walls.size() == 1);
  CHECK(model_of(deck(slope, turns)).walls.size() == 1);
}

TEST_CASE("an unknown body of a row is refused with the bodies that there are") {
  const auto error = [](const std::string& body) {
    return model_error(kSmallDeck + kBodies +
                       joint_with("type = \"fixed\"\nbodies = [\"ground\", \"" + body + "\"]\n"));
  };
  for (const std::string body : {"row.3", "row.-1", "row.x", "row."})
    CHECK(contains(error(body), "there is no body named \"" + body + "\"; \"row\" has row.0 to row.2"));
  CHECK(contains(error("rwo.1"), "did you mean \"row.1\"?"));
}

TEST_CASE("repeated entries of the history's lists are refused") {
  const auto error = [](const std::string& entries) {
    return model_error(kSmallDeck + kPair + kBodies + particles_at("[[0.5, 0], [-0.5, 0]]") + "[output]\n" +
                       entries);
  };
  CHECK(contains(error("history_bodies = [\"a\", \"row\", \"a\"]\n"),
                 "body \"a\" is repeated; every entry must"));
  CHECK(contains(error("history_bodies = [\"row\", \"row.1\"]\n"), "body \"row.1\" is repeated"));
  CHECK(contains(error("history_particles = [1, 0, 1]\n"),
                 "history_particles = [1, 0, 1]: particle 1 is repeated"));
  CHECK(error("history_bodies = [\"row.1\", \"a\"]\nhistory_particles = [1, 0]\n").empty());
}

TEST_CASE("a shape that a body has twice") {
  const auto error = [](const std::string& shapes) {
    return model_error(kSmallDeck +
                       "[[bodies]]\nname = \"b\"\nmass = 1\ninertia = 1\nposition = [0, 0]\nshapes = [" +
                       shapes + "]\n[[contact.pairs]]\nstiffness = 0\n");
  };
  const std::string shape = "{ radius = 0.1, offset = [0.2, 0.0] }";
  CHECK(contains(error(shape + ", { radius = 0.1 }, " + shape),
                 "bodies.b.shapes.2.radius = 0.1: the body has a shape of this offset and radius already"));
  CHECK(error(shape + ", { radius = 0.1 }, { radius = 0.2 }").empty());
}

TEST_CASE("names shared by joints and drivers, or by walls and sides, are refused") {
  const std::string joint = joint_with("type = \"revolute\"\nbodies = [\"ground\", \"a\"]\n");
  const std::string driver = "[[drivers]]\njoint = \"pin\"\nmotion = 0.0\nname = ";
  CHECK(contains(model_error(kSmallDeck + kBodies + joint + driver + "\"pin\"\n"),
                 "the name \"pin\" is repeated"));
  CHECK(model_error(kSmallDeck + kBodies + joint + driver + "\"d\"\n").empty());
  const std::string wall = kSmallDeck + "[[walls]]\nname = \"x_min\"\npoint = [0, 0]\nnormal = [1, 0]\n";
  CHECK(
      contains(model_error(wall, {"space.x_min=wall"}), "is the name of a side of the space that is a wall"));
  CHECK(model_error(wall).empty());
}

TEST_CASE("names repeated by a row are refused") {
  const std::string clash = "[[bodies]]\nname = \"row.1\"\nmass = 1\ninertia = 1\nposition = [0, 0]\n";
  CHECK(contains(model_error(kSmallDeck + kBodies + clash), "the name \"row.1\" is repeated"));
}

TEST_CASE("joints whose two sides do not meet") {
  const std::string message = model_error(
      kSmallDeck + kBodies +
      joint_with(
          "type = \"revolute\"\nbodies = [\"a\", \"row.0\"]\nlocal_points = [[0.0, 0.0], [0.0, -0.4]]\n"));
  CHECK(contains(message, "deck.toml:26:16: joints.pin.local_points = [[0.0, 0.0], [0.0, -0.4]]"));
  CHECK(contains(message, "the two sides of joint \"pin\" do not meet"));
  CHECK(contains(message, "off by 0.1 m"));
  CHECK(
      contains(model_error(kSmallDeck + kBodies +
                           joint_with("type = \"distance\"\nbodies = [\"a\", \"row.0\"]\ndistance = 0.4\n")),
               "joints.pin.distance = 0.4: the two sides of joint \"pin\" do not meet"));
  CHECK(
      contains(model_error(kSmallDeck + kBodies +
                           joint_with("type = \"translational\"\nbodies = [\"a\", \"row.0\"]\naxis = [1, 0]\n"
                                      "local_points = [[0, 0], [0, -0.45]]\n")),
               "off by 0.05 m"));
}

TEST_CASE("joints between the wrong things") {
  CHECK(contains(
      model_error(kSmallDeck + kBodies + joint_with("type = \"revolute\"\nbodies = [\"a\", \"a\"]\n")),
      "must be two different bodies"));
  CHECK(contains(model_error(kSmallDeck + kBodies + joint_with("type = \"revolute\"\n")),
                 "exactly one of the keys bodies, markers, chain and each"));
  CHECK(contains(model_error(kSmallDeck + kBodies + joint_with("type = \"revolute\"\nchain = \"a\"\n")),
                 "must name a row of two bodies or more"));
  CHECK(contains(model_error(kSmallDeck + kBodies +
                             joint_with("type = \"revolute\"\nchain = \"row\"\npoint = [0, 0]\n")),
                 "not used with chain or each"));
  CHECK(contains(
      model_error(kSmallDeck + kBodies + joint_with("type = \"fixed\"\nbodies = [\"ground\", \"a\"]\n") +
                  "[[drivers]]\nname = \"d\"\njoint = \"pin\"\nmotion = 0.0\n"),
      "drivers.d.joint = \"pin\": a fixed joint cannot be driven"));
  CHECK(contains(
      model_error(kSmallDeck + kBodies + joint_with("type = \"distance\"\nbodies = [\"ground\", \"a\"]\n")),
      "the ground has no centre"));
}

TEST_CASE("tables of time functions must increase") {
  const std::string force =
      "[[applied_forces]]\nname = \"f\"\nbody = \"a\"\nfx = { kind = \"table\", times = ";
  CHECK(contains(model_error(kSmallDeck + kBodies + force + "[0, 1, 1], values = [0, 0, 0] }\n"),
                 "applied_forces.f.fx.times = [0, 1, 1]: must increase; entry 2 is 1 after 1"));
  CHECK(contains(model_error(kSmallDeck + kBodies + force + "[0, 1], values = [0] }\n"),
                 "must have 2 entries, as times"));
  CHECK(
      contains(model_error(kSmallDeck + kBodies + force + "[0], values = [0] }\n"), "two entries at least"));
}

TEST_CASE(
    "motions without a jump of velocity, end rates of clamped tables, and steps that end after they begin") {
  const auto driver = [&](const std::string& motion) {
    return model_error(kSmallDeck + kBodies +
                       joint_with("type = \"revolute\"\nbodies = [\"ground\", \"a\"]\n") +
                       "[[drivers]]\nname = \"d\"\njoint = \"pin\"\nmotion = { " + motion + " }\n");
  };
  const std::string points = "kind = \"table\", times = [0, 1], values = [0, 1]";
  CHECK(driver(points + ", interpolation = \"monotone\"").empty());
  CHECK(
      contains(driver(points + ", interpolation = \"linear\""),
               "drivers.d.motion.interpolation = \"linear\": the velocity of a motion must not jump; allowed "
               "for a driver: natural, clamped, monotone"));
  CHECK(contains(driver(points + ", end_rates = [0, 1]"),
                 "drivers.d.motion.end_rates = [0, 1]: used only with interpolation = \"clamped\""));
  CHECK(contains(driver(points + ", interpolation = \"clamped\", end_rates = [0]"), "a list of 2 numbers"));
  CHECK(contains(driver(points + ", interpolation = \"smooth\""), "\"natural\", \"clamped\", \"monotone\""));
  CHECK(contains(driver("kind = \"step\", end_value = 1, start = 0.5, end = 0.5"),
                 "drivers.d.motion.end = 0.5: must be above start = 0.5"));
  CHECK(contains(driver("kind = \"step\", end_value = 1, start = 0.5"), "drivers.d.motion.end"));
  CHECK(driver("kind = \"ramp\", rate = 2, end = 0.5").empty());
  CHECK(contains(driver("kind = \"ramp\", rate = 2, start = 0.5, end = 0.25"),
                 "drivers.d.motion.end = 0.25: must be above start = 0.5"));
  CHECK(contains(driver("kind = \"ramp\", rate = 2, start = 0.5"),
                 "drivers.d.motion.start = 0.5: needs end, the time from which on the slope is rate"));
  CHECK(contains(model_error(kSmallDeck + "velocities = \"found\"\n"), "velocities"));
}

TEST_CASE("the space") {
  CHECK(model_error(kSmallDeck, {"space.max=[1, -1]"}) ==
        "--set space.max=[1, -1]: must be larger than space.min in every component");
  CHECK(contains(model_error(kSmallDeck, {"space.x_min=periodic"}), "x_max must be \"periodic\" too"));
  CHECK(contains(model_error(kSmallDeck, {"space.z_min=wall"}), "a space of dimension 2 has no z sides"));
  const std::string narrow = kSmallDeck + kPair + particles_at("[[0, 0]]");
  const std::vector<std::string> periodic = {"space.x_min=periodic", "space.x_max=periodic",
                                             "particles.0.radius=0.5"};
  CHECK(contains(model_error(narrow, periodic), "the periodic space must be at least 2.2 m long in x"));
  CHECK(contains(model_error(kSmallDeck + "[[walls]]\nname = \"w\"\npoint = [0, 0]\nnormal = [0, 0]\n"),
                 "walls.w.normal = [0, 0]: must not be 0"));
}

TEST_CASE("start positions outside the space") {
  const std::string message = model_error(kSmallDeck + kPair + particles_at("[[0, 0], [0, 1.5]]"));
  CHECK(contains(message,
                 ": particles.0: particle 1 starts at (0, 1.5), outside the space from (-1, -1) to (1, 1), "
                 "beyond y_max"));
  const std::string body =
      "[[bodies]]\nname = \"b\"\nmass = 1.0\ninertia = 1.0\nposition = [-2.0, 0.0]\n"
      "shapes = [{ radius = 0.1 }]\n";
  CHECK(contains(
      model_error(kSmallDeck + body),
      "bodies.b.position = [-2.0, 0.0]: a shape of body \"b\" starts at (-2, 0), outside the space from "
      "(-1, -1) to (1, 1), beyond x_min"));
}

TEST_CASE("every pair of materials that can meet needs a law") {
  CHECK(contains(model_error(kSmallDeck + particles_at("[[0, 0], [0, 0.5]]")),
                 "contact.pairs = []: no pair with materials = [\"default\", \"default\"], which can meet"));
  CHECK(model_error(kSmallDeck + particles_at("[[0, 0]]")).empty());
  CHECK(contains(model_error(kSmallDeck + kPair + kPair), "every pair of materials must be given once"));
  CHECK(contains(model_error(kSmallDeck + "[[contact.pairs]]\nstiffness = 0\ndamping = 1\n"),
                 "must be 0 where"));
}

TEST_CASE("time and integrator") {
  CHECK(contains(model_error(kSmallDeck, {"time.min_step=1"}), "must be at most time.step = 0.001"));
  CHECK(contains(model_error(kSmallDeck, {"time.control=adaptive", "time.max_step=1e-4"}),
                 "must be at least time.step = 0.001"));
  CHECK(contains(model_error(kSmallDeck, {"integrator.substeps=2"}), "must be 1, unless"));
  CHECK(contains(model_error(kSmallDeck, {"integrator.particles=velocity-verlet", "time.control=adaptive"}),
                 "the explicit method has no error estimate"));
  CHECK(contains(model_error(kSmallDeck, {"integrator.precision=mixed"}),
                 "--set integrator.precision=mixed: must be \"double\", unless integrator.particles = "
                 "\"velocity-verlet\""));
  CHECK(contains(model_error(kSmallDeck + "[integrator]\nprecision = \"mixed\"\n"),
                 "integrator.precision = \"mixed\": must be \"double\", unless"));
  CHECK(contains(model_error(kSmallDeck, {"integrator.precision=single"}), "must be one of"));
}

TEST_CASE("precision of the particles") {
  const std::string verlet = "integrator.particles=velocity-verlet";
  CHECK(model_of(kSmallDeck).integrator.precision == Precision::full);
  CHECK(model_of(kSmallDeck, {verlet}).integrator.precision == Precision::full);
  CHECK(model_of(kSmallDeck, {verlet, "integrator.precision=mixed"}).integrator.precision ==
        Precision::mixed);
}

}  // namespace scree
