// Bodies of meshes on planes, which touch the corners of the meshes: rest, sliding, tilting, impact, moving
// walls.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "mesh/hull_corners.hpp"
#include "physics/spatial_rotation.hpp"
#include "support/bits.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"

namespace scree {

namespace {

constexpr Real kGravity = 9.81, kMass = 4, kSide = 0.2, kStiffness = 1e5;

// Settings of a run of adaptive implicit steps, and of explicit ones.
const std::vector<std::vector<std::string>> kSteps = {
    {"integrator.particles=hht"},
    {"integrator.particles=velocity-verlet", "time.control=fixed", "time.step=1e-4"}};

const std::string kFloor = "[[walls]]\nname = \"floor\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n";

// A cube of 4 kg over a floor, its lower side at z = 0.
std::string crate(const std::string& pair = "restitution = 0.5", const std::string& more = kFloor,
                  const std::string& mesh = "") {
  return "gravity = [0, 0, -9.81]\n[space]\ndimension = 3\nmin = [-2, -2, -2]\nmax = [2, 2, 2]\n[time]\nend "
         "= "
         "0.5\n[[contact.pairs]]\nstiffness = 1e5\n" +
         pair + "\n[[meshes]]\nname = \"crate\"\nkind = \"box\"\nsize = [0.2, 0.2, 0.2]\n" + mesh +
         "[[bodies]]\nname = \"crate\"\nkind = \"spatial\"\nposition = [0, 0, 0.1]\nsolids = [{ kind = "
         "\"mesh\", mesh = \"crate\", density = 500.0 }]\nmeshes = [{ mesh = \"crate\" }]\n" +
         "[output]\nhistory_contacts = [\"crate\"]\nhistory_interval = 0.01\n" + more;
}

std::vector<std::string> with(std::vector<std::string> overrides, const std::vector<std::string>& more) {
  overrides.insert(overrides.end(), more.begin(), more.end());
  return overrides;
}

BodyMotion motion_of(const SimulationRun& run) { return run.multibody().motion(run.bodies())[0]; }

Vec3 axis_z(const BodyMotion& motion) { return transposed(rotation_matrix(motion.orientation)).z; }

// Force of the planes on the corners of a box at these positions, frictionless and without damping [N].
Vec3 force_at(const std::vector<Vec3>& positions, Vec3 point, Vec3 normal) {
  Vec3 force;
  for (const Vec3 place : positions)
    force += kStiffness * std::max(-dot(normal, place - point), Real(0)) * normal;
  return force;
}

}  // namespace

TEST_CASE("a crate comes to rest on four corners, however its faces are divided") {
  for (const std::vector<std::string>& steps : kSteps)
    for (const std::string mesh : {"", "refine = 0.05\n"}) {
      CAPTURE(steps, mesh);
      const Model model = model_of(crate("restitution = 0.5", kFloor, mesh),
                                   with(steps, {"bodies.crate.position=[0, 0, 0.101]"}));
      SimulationRun run(model);
      run.run();
      const BodyMotion end = motion_of(run);
      CHECK(near(0.1 - end.position.z, kMass * kGravity / (4 * kStiffness), {.relative = 1e-4}));
      CHECK(norm(end.velocity) < 1e-7);
      const std::vector<Real> contact = run.contact_values();
      CHECK(near(contact[2], kMass * kGravity, {.relative = 1e-4}));
      CHECK(contact[6] == 4);
      CHECK(run.ledger().dissipated_contacts > 0);
      CHECK(run.balance_error() < 1e-3 * run.exchanged());
    }
}

// The sides of the domain are the same planes.
TEST_CASE("a crate on a side of the space that is a wall has the bits of one on a plane there") {
  std::vector<Vec3> ends;
  for (const std::string more :
       {"", "[[walls]]\nname = \"floor\"\npoint = [0, 0, -2]\nnormal = [0, 0, 1]\n"}) {
    std::vector<std::string> overrides = {"bodies.crate.position=[0, 0, -1.89]",
                                          "bodies.crate.velocity=[0.3, 0, 0]"};
    if (more.empty()) overrides.push_back("space.z_min=wall");
    SimulationRun run(model_of(crate("restitution = 0.5\nfriction = 0.3", more), overrides));
    run.run();
    ends.push_back(motion_of(run).position);
  }
  CHECK(ends[0].z > -1.91);
  CHECK(same_bits(ends[0], ends[1]));
}

TEST_CASE("a crate slides v^2 / (2 mu g) far") {
  for (const std::vector<std::string>& steps : kSteps) {
    CAPTURE(steps);
    const Real overlap = kMass * kGravity / (4 * kStiffness);
    const Model model =
        model_of(crate("restitution = 0.5\nfriction = 0.3\ntangential_damping_ratio = 0.2"),
                 with(steps, {fmt::format("bodies.crate.position=[0, 0, {:.17g}]", 0.1 - overlap),
                              "bodies.crate.velocity=[1, 0, 0]"}));
    SimulationRun run(model);
    run.run();
    const BodyMotion end = motion_of(run);
    CHECK(near(end.position.x, 1 / (2 * 0.3 * kGravity), {.relative = 2e-3}));
    CHECK(norm(end.velocity) < 1e-4);
    CHECK(std::abs(end.position.y) < 1e-12);
    CHECK(run.balance_error() < 1e-2 * run.exchanged());
  }
}

TEST_CASE("corners do not roll: laws against rolling and twisting change nothing of a crate") {
  std::vector<BodyMotion> ends;
  for (const std::string rolling : {"", "\nrolling_friction = 0.5\ntwisting_friction = 0.5"}) {
    SimulationRun run(model_of(
        crate("restitution = 0.5\nfriction = 0.3" + rolling),
        with(kSteps[1],
             {"bodies.crate.velocity=[1, 0.5, -0.2]", "bodies.crate.quaternion=[0.8, 0.36, 0.48, 0]",
              "bodies.crate.body_angular_velocity=[1, 0, 3]", "bodies.crate.position=[0, 0, 0.2]"})));
    run.run();
    ends.push_back(motion_of(run));
  }
  CHECK(norm(ends[0].position - Vec3{0, 0, 0.2}) > 0.05);
  CHECK(near(ends[1].position, ends[0].position, {.relative = 1e-12}));
  CHECK(near(ends[1].spin, ends[0].spin, {.relative = 1e-9}));
}

// Beyond tan(angle) = width / height.
TEST_CASE("a high crate on a slope is stable, and tilts where the slope is steep enough") {
  for (const std::vector<std::string>& steps : kSteps)
    for (const Real slope : {0.44, 0.53}) {
      CAPTURE(steps, slope);
      const Real angle = std::atan(slope), height = 0.4;
      std::vector<std::string> overrides =
          with(steps, {fmt::format("meshes.crate.size=[0.2, 0.2, {}]", height), "time.end=0.8",
                       fmt::format("gravity=[{:.17g}, 0, {:.17g}]", kGravity * std::sin(angle),
                                   -kGravity * std::cos(angle)),
                       "bodies.crate.position=[0, 0, 0.2]"});
      SimulationRun run(
          model_of(crate("restitution = 0.1\nfriction = 2.0\ntangential_damping_ratio = 0.2"), overrides));
      run.run();
      const Real tilt = std::acos(axis_z(motion_of(run)).z);
      if (slope < 0.5)
        CHECK(tilt < 0.02);
      else
        CHECK(tilt > 0.2);
    }
}

// The impulse at restitution 1 without friction: P = 2 v / (1/m + (r x n) J^-1 (r x n)), in the limit of a
// stiff corner.
TEST_CASE("a crate that falls on a corner rebounds by the impulse, and keeps its energy") {
  Real errors[2];
  for (const int k : {0, 1}) {
    const Real stiffness = k == 0 ? 1e6 : 1e8, step = k == 0 ? 2e-5 : 2e-6, v = 2;
    const Quaternion pose = normalized({0.9, 0.2, 0.35, 0.1});
    const Mat3 axes = rotation_matrix(pose);
    Vec3 lowest;
    for (int c = 0; c < 8; ++c) {
      const Vec3 corner = axes * Vec3{c & 1 ? 0.1 : -0.1, c & 2 ? 0.1 : -0.1, c & 4 ? 0.1 : -0.1};
      if (corner.z < lowest.z) lowest = corner;
    }
    const Model model =
        model_of(crate(""), {"gravity=[0, 0, 0]", fmt::format("contact.pairs.0.stiffness={}", stiffness),
                             fmt::format("bodies.crate.position=[0, 0, {:.17g}]", -lowest.z + 0.002),
                             fmt::format("bodies.crate.quaternion=[{:.17g}, {:.17g}, {:.17g}, {:.17g}]",
                                         pose.w, pose.x, pose.y, pose.z),
                             fmt::format("bodies.crate.velocity=[0.3, 0, -{}]", v), "time.end=0.01",
                             "time.control=fixed", fmt::format("time.step={}", step)});
    SimulationRun run(model);
    const Real before = run.ledger().kinetic;
    run.run();
    const Body& body = model.bodies[0];
    const Vec3 lever = cross(lowest, Vec3{0, 0, 1});
    const Real inertia = body.inertia_tensor.xx;  // of a cube about any axis
    const Real impulse = 2 * v / (1 / body.mass + dot(lever, lever) / inertia);
    const BodyMotion end = motion_of(run);
    const Vec3 spin = rotation_matrix(end.orientation) * end.spin;
    CHECK(near(end.velocity.x, 0.3, {.relative = 1e-12}));
    CHECK(std::abs(spin.z) < 1e-9);
    errors[k] = std::abs(end.velocity.z + v - impulse / body.mass) / v +
                norm(spin - (impulse / inertia) * lever) / norm(spin);
    CHECK(near(run.ledger().kinetic, before, {.relative = 1e-3}));
    CHECK(run.contact_values()[6] == 0);
  }
  CAPTURE(errors[0], errors[1]);
  CHECK(errors[0] < 0.1);
  CHECK(errors[1] < errors[0] / 8);
}

TEST_CASE("a floor that moves takes a crate along: mu g t, then with it") {
  const std::string floor =
      kFloor +
      "[[walls.motions]]\ntype = \"translation\"\ndirection = [1, 0, 0]\ndisplacement = { "
      "kind = \"ramp\", rate = 0.5 }\n";
  for (const std::vector<std::string>& steps : kSteps) {
    CAPTURE(steps);
    const Real overlap = kMass * kGravity / (4 * kStiffness);
    SimulationRun run(
        model_of(crate("restitution = 0.5\nfriction = 0.2", floor),
                 with(steps, {fmt::format("bodies.crate.position=[0, 0, {:.17g}]", 0.1 - overlap)})));
    run.run_until(0.1);
    CHECK(near(motion_of(run).velocity.x, 0.2 * kGravity * run.time(), {.relative = 5e-3}));
    run.run();
    CHECK(near(motion_of(run).velocity.x, 0.5, {.relative = 2e-2}));
  }
}

TEST_CASE("a floor that rises lifts a crate") {
  const std::string floor =
      kFloor +
      "[[walls.motions]]\ntype = \"translation\"\ndirection = [0, 0, 1]\ndisplacement = { "
      "kind = \"ramp\", rate = 0.1 }\n";
  for (const std::vector<std::string>& steps : kSteps) {
    CAPTURE(steps);
    SimulationRun run(model_of(crate("restitution = 0.5", floor), steps));
    run.run();
    const Real overlap = kMass * kGravity / (4 * kStiffness);
    CHECK(near(motion_of(run).position.z, 0.1 + 0.1 * 0.5 - overlap, {.absolute = 1e-7}));
    CHECK(near(motion_of(run).velocity.z, 0.1, {.relative = 1e-4}));
  }
}

TEST_CASE("forces of corners on planes are those of all vertices of the box that are past them") {
  const Quaternion poses[] = {normalized({0.9, 0.2, 0.35, 0.1}), normalized({0.3, -0.8, 0.1, 0.4}),
                              normalized({0.5, 0.1, 0.9, -0.3})};
  for (const Quaternion& pose : poses)
    for (const Real height : {0.05, 0.1, 0.14}) {
      const Model model = model_of(
          crate("", kFloor + "[[walls]]\nname = \"slope\"\npoint = [0.1, 0, 0]\nnormal = [-1, 0.2, 0.5]\n",
                "refine = 0.06\n"),
          {"contact.max_start_overlap=1", fmt::format("bodies.crate.position=[0.02, 0.01, {}]", height),
           fmt::format("bodies.crate.quaternion=[{:.17g}, {:.17g}, {:.17g}, {:.17g}]", pose.w, pose.x, pose.y,
                       pose.z)});
      SimulationRun run(model);
      std::vector<Vec3> positions;
      for (int c = 0; c < 8; ++c)
        positions.push_back(Vec3{0.02, 0.01, height} + rotation_matrix(pose) * Vec3{c & 1 ? 0.1 : -0.1,
                                                                                    c & 2 ? 0.1 : -0.1,
                                                                                    c & 4 ? 0.1 : -0.1});
      const Vec3 slope = (1 / std::sqrt(Real(1.29))) * Vec3{-1, 0.2, 0.5};
      const Vec3 expected = force_at(positions, {}, {0, 0, 1}) + force_at(positions, {0.1, 0, 0}, slope);
      const std::vector<Real> found = run.contact_values();
      CHECK(near(Vec3{found[0], found[1], found[2]}, expected, {.relative = 1e-12}));
    }
}

// The radius is that of the sphere with the crate's surface area.
TEST_CASE("by Hertz's law a corner is a sphere as large as the mesh") {
  const std::string pair = "[[materials]]\nname = \"default\"\nyoung_modulus = 1e8\npoisson_ratio = 0.25\n";
  std::string deck = crate("restitution = 0.3") + pair;
  deck.erase(deck.find("stiffness = 1e5\n"), std::string("stiffness = 1e5\n").size());
  SimulationRun run(model_of(deck, {"bodies.crate.position=[0, 0, 0.1001]", "time.end=0.6"}));
  run.run();
  const Real modulus = 1e8 / (1 - 0.25 * 0.25) / 2;
  const Real radius = std::sqrt(6 * kSide * kSide / (4 * std::numbers::pi_v<Real>));
  const Real overlap =
      std::pow(kMass * kGravity / 4 / (Real(4) / 3 * modulus * std::sqrt(radius)), Real(2) / 3);
  CHECK(near(0.1 - motion_of(run).position.z, overlap, {.relative = 1e-3}));
}

TEST_CASE("a closed line comes to rest on two corners in the plane") {
  const std::string deck =
      "gravity = [0, -9.81]\n[space]\ndimension = 2\nmin = [-1, 0]\nmax = [1, 1]\ny_min = "
      "\"wall\"\n[time]\nend "
      "= 0.5\n[[contact.pairs]]\nstiffness = 1e5\nrestitution = 0.4\nfriction = 0.5\n[[meshes]]\nname = "
      "\"plank\"\nkind = \"line\"\npoints = [[-0.1, -0.05], [0, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, "
      "0.05]]\nclosed = true\n[[bodies]]\nname = \"plank\"\nposition = [0, 0.06]\nsolids = [{ kind = "
      "\"mesh\", "
      "mesh = \"plank\", density = 200.0 }]\nmeshes = [{ mesh = \"plank\" }]\n";
  for (const std::vector<std::string>& steps : kSteps) {
    CAPTURE(steps);
    const Model model = model_of(deck, steps);
    SimulationRun run(model);
    run.run();
    CHECK(near(model.bodies[0].mass, 4, {.relative = 1e-12}));
    CHECK(near(0.05 - motion_of(run).position.y, 4 * kGravity / (2 * kStiffness), {.relative = 1e-3}));
  }
}

TEST_CASE("spheres of a body and corners of its mesh have contacts, visual-only geometry has none") {
  const std::string sphere = "bodies.crate.shapes=[{radius = 0.1}]";
  for (const auto& [overrides, contacts] : std::vector<std::pair<std::vector<std::string>, Real>>{
           {{sphere}, 5}, {{sphere, "bodies.crate.meshes.0.collides=false"}, 1}, {{}, 4}}) {
    SimulationRun run(
        model_of(crate("restitution = 0.5"), with(overrides, {"bodies.crate.position=[0, 0, 0.09999]"})));
    CHECK(run.contact_values()[6] == contacts);
  }
  SimulationRun run(model_of(crate("restitution = 0.5"), {"bodies.crate.meshes.0.collides=false"}));
  run.run();
  CHECK(motion_of(run).position.z < -0.5);
}

// Beside particles, with materials of their own: without a law for both, nothing stops the crate.
TEST_CASE("meshes touch planes where the deck has a law for their materials") {
  const auto deck = [](const std::string& pairs) {
    return "gravity = [0, 0, -9.81]\n[space]\ndimension = 3\nmin = [-1, -1, -1]\nmax = [1, 1, "
           "1]\n[time]\nend = "
           "0.4\n[[materials]]\nname = \"wood\"\n[[materials]]\nname = "
           "\"stone\"\n[[contact.pairs]]\nmaterials = "
           "[\"wood\", \"wood\"]\nstiffness = 1e5\nrestitution = 0.5\n[[contact.pairs]]\nmaterials = "
           "[\"stone\", \"stone\"]\nstiffness = 1e5\nrestitution = 0.5\n" +
           pairs +
           "[[meshes]]\nname = \"crate\"\nkind = \"box\"\nsize = [0.2, 0.2, 0.2]\n[[walls]]\nname = "
           "\"floor\"\npoint = [0, 0, -0.3]\nnormal = [0, 0, 1]\nmaterial = \"stone\"\n[[bodies]]\nname = "
           "\"crate\"\nkind = \"spatial\"\nposition = [0, 0, 0]\nsolids = [{ kind = \"mesh\", mesh = "
           "\"crate\", "
           "density = 500.0 }]\nmeshes = [{ mesh = \"crate\", material = \"wood\" }]\n[[particles]]\nkind = "
           "\"list\"\npositions = [[0.7, 0.7, -0.26], [0.6, 0.7, -0.26]]\nradius = 0.039\ndensity = "
           "2000.0\nmaterial = \"stone\"\n";
  };
  const std::string law =
      "[[contact.pairs]]\nmaterials = [\"wood\", \"stone\"]\nstiffness = 1e5\nrestitution = 0.5\n";
  for (const bool is_given : {true, false}) {
    // Particles of stone can touch a crate of wood: the pair is required.
    const std::string nothing = "[[contact.pairs]]\nmaterials = [\"wood\", \"stone\"]\nstiffness = 0\n";
    SimulationRun run(model_of(deck(is_given ? law : nothing)));
    run.run();
    if (is_given)
      CHECK(near(motion_of(run).position.z, -0.2, {.absolute = 0.03}));
    else
      CHECK(motion_of(run).position.z < -0.5);
  }
}

}  // namespace scree
