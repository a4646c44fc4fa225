// A mesh after many rotations or far displacements: contacts as before, to the rounding of its pose.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"
#include "support/test_meshes.hpp"

namespace scree {

namespace {

constexpr Real kStep = 1e-3, kStiffness = 1e4, kRadius = 0.02, kMass = 1;
constexpr std::size_t kSpheres = 40;
constexpr Real kReach = 0.35;  // of the block from its centre, and a sphere [m]

std::string text(Vec3 v) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x, v.y, v.z); }

// Random positions around a block, over its faces, edges and corners, and separated from each other.
std::vector<Vec3> positions_around(Vec3 half) {
  MeshRandom random(3);
  std::vector<Vec3> positions;
  for (int i = 0; positions.size() < kSpheres; ++i) {
    const int outside = i % 7 + 1;  // along which axes, by bits
    const auto along = [&](Real h, bool out) {
      if (!out) return random.in(-h, h);
      return (random.in(-1, 1) > 0 ? 1 : -1) * (h + random.in(0.2, 0.5) * kRadius);
    };
    const Real x = along(half.x, outside & 1), y = along(half.y, outside & 2), z = along(half.z, outside & 4);
    const Vec3 position{x, y, z};
    if (std::all_of(positions.begin(), positions.end(),
                    [&](Vec3 other) { return norm(position - other) > 3 * kRadius; }))
      positions.push_back(position);
  }
  return positions;
}

// One step of resting spheres that overlap a block at the pose that it has at the end of the step.
std::string pressed_spheres(Vec3 centre, const std::string& wall) {
  const Vec3 half{0.2, 0.15, 0.1};
  std::string positions;
  for (const Vec3 position : positions_around(half))
    positions += (positions.empty() ? "" : ", ") + text(centre + position);
  const Vec3 far{1, 1, 1};
  return "[space]\ndimension = 3\nmin = " + text(centre - far) + "\nmax = " + text(centre + far) +
         fmt::format("\n[time]\nend = {0}\nstep = {0}\ncontrol = \"fixed\"\n", kStep) +
         fmt::format(
             "[integrator]\nparticles = \"velocity-verlet\"\n[contact]\nmax_start_overlap = "
             "1.0\n[[contact.pairs]]\nstiffness = {}\n",
             kStiffness) +
         "[[meshes]]\nname = \"block\"\nkind = \"box\"\nsize = " + text(2 * half) +
         "\n[[walls]]\nname = \"block\"\nmesh = \"block\"\n" + wall +
         fmt::format(
             "[[particles]]\nname = \"spheres\"\nkind = \"list\"\npositions = [{}]\nradius = {}\nmass = {}\n",
             positions, kRadius, kMass);
}

// Forces at the end of the step [N].
std::vector<Vec3> forces(const std::string& deck) {
  SimulationRun run(model_of(deck));
  run.run();
  std::vector<Vec3> out;
  for (const Particle& p : run.particles()) out.push_back(p.mass * p.acceleration);
  return out;
}

Real largest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  REQUIRE(a.size() == b.size());
  Real most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, norm(a[i] - b[i]));
  return most;
}

// The wall's motion in that step.
std::string motion(const std::string& what, const std::string& coordinate, Real change) {
  return fmt::format("motions = [{{ {}, {} = {{ kind = \"ramp\", rate = {:.17g} }} }}]\n", what, coordinate,
                     change / kStep);
}
std::string spheres_where_it_comes_to(Vec3 position) {
  return pressed_spheres(position, motion("type = \"translation\", direction = " + text(position),
                                          "displacement", norm(position)));
}

}  // namespace

// An angle or a position is rounded to its last bit, which the distance or the stiffness converts to a
// force.
TEST_CASE(
    "a block that went round up to a million times is touched as it was, to the rounding of the angle") {
  const std::vector<Vec3> at_rest = forces(pressed_spheres({}, ""));
  for (const Vec3 force : at_rest) REQUIRE(norm(force) > 0.2 * kStiffness * kRadius);
  for (const Real turns : {1.0, 90.0, -90.0, 1e6}) {
    const Real angle = 2 * M_PI * turns;
    const std::string rotation = "type = \"rotation\", axis = [1, -1, 2], point = [0, 0, 0]";
    const Real difference =
        largest_difference(forces(pressed_spheres({}, motion(rotation, "angle", angle))), at_rest);
    CAPTURE(turns, difference);
    CHECK(difference < 2 * kStiffness * kReach * std::abs(angle) * kUlp);
  }
}

TEST_CASE("contacts of a block after 100 km are those after 2 m, to the rounding of the position") {
  const std::vector<Vec3> near_by = forces(spheres_where_it_comes_to({2, 0, 0}));
  for (const Vec3 force : near_by) REQUIRE(norm(force) > 0.2 * kStiffness * kRadius);
  for (const Vec3 far : {Vec3{1e5, 0, 0}, Vec3{-3e4, 8e4, 5e4}}) {
    const Real difference = largest_difference(forces(spheres_where_it_comes_to(far)), near_by);
    CAPTURE(far.x, difference);
    CHECK(difference < 2 * kStiffness * norm(far) * kUlp);
  }
}

}  // namespace scree
