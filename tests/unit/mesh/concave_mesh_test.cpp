// Corners and bends: one contact for each touched position, and a force without jumps.
#include <cmath>
#include <vector>

#include "mesh/mesh_contacts.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/test_meshes.hpp"

namespace scree {

namespace {

constexpr Real kRadius = 1;  // of the particle [m]
constexpr Real kDegree = M_PI / 180;

// Two walls of 5 m that rise from the y axis with this angle between them, open upwards.
TriangleMesh valley(Real angle) {
  const Vec3 left{-5 * std::sin(angle / 2), 0, 5 * std::cos(angle / 2)};
  return strip({left, {0, 0, 0}, {-left.x, 0, left.z}}, 4, 3);
}

// Walls 3 m high on both sides of a floor.
TriangleMesh slot(Real width) { return strip({{0, 0, 3}, {0, 0, 0}, {width, 0, 0}, {width, 0, 3}}, 4, 3); }

// Two walls that a half cylinder of this radius joins at their feet.
TriangleMesh bend(Real radius, int facets) {
  std::vector<Vec3> line{{-radius, 0, 3}};
  for (int i = 0; i <= facets; ++i) {
    const Real angle = M_PI * i / facets;
    line.push_back({-radius * std::cos(angle), 0, -radius * std::sin(angle)});
  }
  line.push_back({radius, 0, 3});
  return strip(line, 4, 2);
}

constexpr Real kCore = 2, kOuter = 5, kPitch = 4;  // of the screw [m]

// One and a half revolutions of a flight on its core, with this number of segments per revolution.
TriangleMesh screw(int steps) {
  const int count = 3 * steps / 2;
  const TriangleMesh flat = strip({{kCore, 0, 2}, {kCore, 0, 0}, {kOuter, 0, 0}}, 1, count);
  return mapped(flat, [&](Vec3 v) {
    const Real angle = 3 * M_PI * v.y;
    return Vec3{v.x * std::cos(angle), v.x * std::sin(angle), v.z + kPitch * angle / (2 * M_PI)};
  });
}

struct Touch {
  Vec3 force;        // over k [m]
  Real overlap = 0;  // sum of all contacts [m]
  Real most = 0;     // the largest
};

Touch touch_at(const SurfaceMesh& mesh, Vec3 c) {
  Touch touch;
  for (const MeshContact& contact : contacts_at(mesh, c, kRadius)) {
    const Real overlap = kRadius - contact.distance;
    touch.force += overlap * contact.normal;
    touch.overlap += overlap;
    touch.most = std::max(touch.most, overlap);
  }
  return touch;
}

struct Jumps {
  Real force = 0, overlap = 0;  // the largest change per displacement [m/m]
  int positions = 0;            // positions compared
};

// Along short random lines in a box, where no overlap is more than a tenth of the radius.
Jumps jumps_in(const SurfaceMesh& mesh, Vec3 min, Vec3 max, unsigned seed) {
  constexpr Real kStep = 2e-4;
  constexpr int kLines = 10000, kSteps = 5;
  MeshRandom random(seed);
  Jumps jumps;
  for (int line = 0; line < kLines; ++line) {
    Vec3 c = random.in(min, max);
    const Vec3 step = kStep * random.direction();
    Touch last = touch_at(mesh, c);
    for (int i = 0; i < kSteps && last.most < 0.1 * kRadius; ++i) {
      c += step;
      const Touch touch = touch_at(mesh, c);
      if (touch.most > 0 && touch.most < 0.1 * kRadius) {
        jumps.force = std::max(jumps.force, norm(touch.force - last.force) / kStep);
        jumps.overlap = std::max(jumps.overlap, std::abs(touch.overlap - last.overlap) / kStep);
        ++jumps.positions;
      }
      last = touch;
    }
  }
  return jumps;
}

}  // namespace

TEST_CASE("in a valley both walls are touched where both are near") {
  for (const Real degrees : {60, 75, 90, 105, 120, 135, 145}) {
    const SurfaceMesh mesh = sheet_mesh(valley(degrees * kDegree));
    const Real half = degrees * kDegree / 2, apex = 0.95 / std::sin(half);
    const auto both = contacts_at(mesh, {0, 2, apex}, kRadius);
    REQUIRE(both.size() == 2);
    CHECK(near(both[0].distance, 0.95, {.absolute = 1e-14}));
    CHECK(near(push_on(mesh, {0, 2, apex}, kRadius), {0, 0, 2 * 0.05 * std::sin(half)}, {.absolute = 1e-14}));
    // Up along a wall, away from the other.
    const Vec3 along{std::sin(half), 0, std::cos(half)};
    CHECK(contacts_at(mesh, Vec3{0, 2, apex} + 1.5 * along, kRadius).size() == 1);
    CHECK(contacts_at(mesh, {0, 2, 1.01 / std::sin(half)}, kRadius).empty());
    CHECK(contacts_at(mesh, {0, 2, -0.95}, kRadius).size() == 1);
  }
}

TEST_CASE("a valley with an angle below the feature angle is a curve") {
  const SurfaceMesh mesh = sheet_mesh(valley(155 * kDegree));
  CHECK(contacts_at(mesh, {0, 2, 0.95 / std::sin(77.5 * kDegree)}, kRadius).size() == 1);
}

TEST_CASE("in a slot there are as many contacts as sides near") {
  const SurfaceMesh narrow = sheet_mesh(slot(1.9)), wide = sheet_mesh(slot(2.1));
  CHECK(contacts_at(narrow, {0.95, 2, 0.95}, kRadius).size() == 3);
  CHECK(contacts_at(narrow, {0.95, 2, 1.5}, kRadius).size() == 2);
  CHECK(near(push_on(narrow, {0.95, 2, 1.5}, kRadius), {0, 0, 0}, {.absolute = 1e-15}));
  CHECK(contacts_at(wide, {1.05, 2, 0.95}, kRadius).size() == 1);
  CHECK(contacts_at(wide, {0.95, 2, 0.95}, kRadius).size() == 2);
  CHECK(contacts_at(wide, {0.95, 2, 1.5}, kRadius).size() == 1);
  CHECK(contacts_at(wide, {1.05, 2, 1.5}, kRadius).empty());
}

TEST_CASE("in a bend the bottom is touched once, both walls apart") {
  const SurfaceMesh wide = sheet_mesh(bend(1.5, 36)), narrow = sheet_mesh(bend(0.95, 36));
  CHECK(contacts_at(wide, {0, 2, -0.55}, kRadius).size() == 1);
  CHECK(contacts_at(wide, {0, 2, 1}, kRadius).empty());
  CHECK(contacts_at(wide, {0.55, 2, 1}, kRadius).size() == 1);
  const auto walls = contacts_at(narrow, {0, 2, 1}, kRadius);
  REQUIRE(walls.size() == 2);
  CHECK(near(walls[0].normal, -walls[1].normal, {.absolute = 1e-15}));
}

TEST_CASE("on a screw flight and core are touched apart, and both in their corner") {
  const SurfaceMesh mesh = sheet_mesh(screw(200));
  // Above the middle of the flight's face; a height along the axis exceeds the distance from the flight.
  const auto position = [](Real from_core, Real above_flight) {
    const Real angle = 1.5 * M_PI, radius = kCore + from_core;
    const Real slope = std::atan(kPitch / (2 * M_PI * radius));
    return Vec3{radius * std::cos(angle), radius * std::sin(angle),
                kPitch * angle / (2 * M_PI) + above_flight / std::cos(slope)};
  };
  CHECK(contacts_at(mesh, position(0.95, 0.95), kRadius).size() == 2);
  CHECK(contacts_at(mesh, position(1.5, 0.95), kRadius).size() == 1);
  CHECK(contacts_at(mesh, position(0.95, 1.2), kRadius).size() == 1);
  CHECK(contacts_at(mesh, position(1.5, 1.2), kRadius).empty());
  // Inside the core, behind its wall.
  CHECK(contacts_at(mesh, position(-0.95, 0.5), kRadius).size() == 1);
}

TEST_CASE("between flat sides the force changes no faster than the sphere moves, for each contact") {
  int seed = 20;
  for (const Real degrees : {60, 90, 120, 145}) {
    const Jumps jumps = jumps_in(sheet_mesh(valley(degrees * kDegree)), {-3, 0.5, -1}, {3, 3.5, 3}, seed++);
    CHECK(jumps.positions > 1000);
    CHECK(jumps.force < 2 + 1e-6);
  }
  const Jumps in_slot = jumps_in(sheet_mesh(slot(1.95)), {0.9, 0.5, 0.9}, {1.05, 3.5, 3}, seed++);
  CHECK(in_slot.positions > 1000);
  CHECK(in_slot.force < 3 + 1e-6);
  const Jumps at_block =
      jumps_in(closed_mesh(block({0, 0, 0}, {2, 2, 2}, 3)), {-1, -1, -1}, {3, 3, 3}, seed++);
  CHECK(at_block.positions > 1000);
  CHECK(at_block.force < 1 + 1e-6);
}

TEST_CASE("on curved surfaces the overlap changes no faster than the sphere moves") {
  const Jumps in_bend = jumps_in(sheet_mesh(bend(1.2, 36)), {-0.3, 0.5, -0.3}, {0.3, 3.5, 1}, 30);
  CHECK(in_bend.positions > 1000);
  CHECK(in_bend.overlap < 2 + 1e-6);
  const Jumps on_screw = jumps_in(sheet_mesh(screw(100)), {-5, -5, 0.5}, {5, 5, 6}, 31);
  CHECK(on_screw.positions > 1000);
  CHECK(on_screw.overlap < 3 + 1e-6);
  const Jumps in_drum = jumps_in(sheet_mesh(drum_shell(144, 10, 4, 1)), {-3, 0.5, -9.2}, {3, 3.5, -8.4}, 32);
  CHECK(in_drum.positions > 1000);
  CHECK(in_drum.overlap < 1 + 1e-6);
  const Jumps in_sphere = jumps_in(closed_mesh(flipped(icosphere(3, 5))), {-2, -2, 3}, {2, 2, 4}, 33);
  CHECK(in_sphere.positions > 1000);
  CHECK(in_sphere.overlap < 1 + 1e-6);
}

}  // namespace scree
