// Surfaces on bodies: position of a sphere relative to them, and the sums of their contacts.
#include "dem/surfaces/surfaces.hpp"

#include <array>
#include <vector>

#include "dem/surfaces/surface_sums.hpp"
#include "model/derived/random.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 1e-14;

SurfacePose placed(SurfaceKind kind, Real radius, Vec3 normal) {
  SurfacePose s{};
  s.kind = kind, s.radius = radius, s.normal = normal;
  s.point = {1, 2, 0}, s.arm = {0.5, 0, 0};
  s.velocity = {0, 0, 3}, s.spin = {0, 0, 2};
  return s;
}

Vec3 random_vector(RandomNumbers& random) {
  const Real x = random.normal(), y = random.normal();
  return {x, y, random.normal()};
}

SurfaceStep random_contact(RandomNumbers& random) {
  SurfaceStep c{};
  c.touches = true;
  const Vec3 n = random_vector(random);
  c.contact = {{random.normal(), random.uniform(), random.uniform()}, random.normal(), (1 / norm(n)) * n, {}};
  c.arm = random_vector(random);
  return c;
}

}  // namespace

TEST_CASE("a sphere and a sphere on a body touch on the line of their centres") {
  const SurfacePose s = placed(SurfaceKind::sphere, 0.5, {});
  const SurfacePair pair = surface_pair(s, {10, 0, 0}, {11, 3, 0, 0.75});
  CHECK(pair.geometry.overlap == 0.25);
  CHECK(pair.geometry.normal() == Vec3{0, 1, 0});
  CHECK(pair.contact == Vec3{0, 0.5, 0});
  CHECK(s.velocity_at(pair.contact) == Vec3{-1, 1, 3});
}

TEST_CASE("a sphere and a plane on a body touch at its radius below its centre") {
  const SurfacePose s = placed(SurfaceKind::plane, 0, {0, 1, 0});
  const SurfacePair pair = surface_pair(s, {0, 10, 0}, {4, 12.5, 1, 0.75});
  CHECK(pair.geometry.overlap == 0.25);
  CHECK(pair.geometry.normal() == Vec3{0, 1, 0});
  CHECK(pair.contact == Vec3{3, -0.25, 1});
  CHECK(s.velocity_at(pair.contact) == Vec3{0.5, 7, 3});
}

TEST_CASE("a contact pushes its body back at the point of contact") {
  SurfaceLoad c{};
  c.touches = true, c.load.force = {1, 2, 3}, c.load.torque_j = {0, 0, 10}, c.arm = {2, 0, 0};
  InstantSums sums;
  sums.add_contact(c);
  CHECK(sums.contacts == 1);
  CHECK(sums.wrench().force == Vec3{-1, -2, -3});
  CHECK(sums.wrench().torque == Vec3{0, 6, 6});
}

TEST_CASE("the blocks of a contact are its stiffness along the motion of the point where it is") {
  RandomNumbers random(1);
  for (int trial = 0; trial < 20; ++trial) {
    const SurfaceStep c = random_contact(random);
    StepSums sums;
    sums.add_contact(c);
    const Vec3 n = c.contact.normal, moment = cross(c.arm, n);
    CHECK(norm(sums.wrench().force + c.contact.end_force * n) <= kRoundOff);
    CHECK(norm(sums.wrench(kWrenchTerms).torque + c.contact.step.force * moment) <= kRoundOff);
    const std::array<Real, 6> along{n.x, n.y, n.z, moment.x, moment.y, moment.z};
    for (int row = 0; row < 6; ++row)
      for (int column = row; column < 6; ++column) {
        const Real product = along[row] * along[column];
        const int slot = 2 * kWrenchTerms + packed6(row, column);
        CHECK(sums.sum[slot].value() == c.contact.step.stiffness * along[row] * along[column]);
        CHECK(std::abs(sums.sum[slot + kBlockTerms].value() - c.contact.step.damping * product) <=
              kRoundOff * std::abs(product));
      }
  }
}

TEST_CASE("sums over contacts are the same bits in any order and in any parts") {
  RandomNumbers random(2);
  std::vector<SurfaceStep> contacts;
  for (int k = 0; k < 100; ++k) contacts.push_back(random_contact(random));
  StepSums forward, backward, parts[3], joined;
  for (const SurfaceStep& c : contacts) forward.add_contact(c);
  for (auto c = contacts.rbegin(); c != contacts.rend(); ++c) backward.add_contact(*c);
  for (std::size_t k = 0; k < contacts.size(); ++k) parts[k % 3].add_contact(contacts[k]);
  for (const int k : {2, 0, 1}) joined.add(parts[k]);
  for (int term = 0; term < kStepTerms; ++term) {
    CHECK(forward.sum[term].value() == backward.sum[term].value());
    CHECK(forward.sum[term].value() == joined.sum[term].value());
  }
  CHECK(joined.contacts == 100);
}

TEST_CASE("the inverse effective mass of a body beside its mass is that of its free motions") {
  const Sym3 inertia{2, 0.1, -0.2, 3, 0.3, 4};
  const Vec3 n{0.6, 0, 0.8}, arm{0.3, -0.2, 0.1};
  const FreeShape spatial{arm, {{5, 5, 5}, inertia}}, planar{arm, {{5, 5, 0}, {0, 0, 0, 0, 0, 4}}};
  CHECK(spatial.beside_mass(n) == spatial.body.rotation(arm, n));
  CHECK(near(5 + planar.beside_mass(n), planar.body.translation(n) + planar.body.rotation(arm, n),
             {.relative = 1e-8}));
  // Partners that nothing can move have no effective mass, and laws need a number.
  CHECK(5 + planar.body.held({0, 0, 1}) > 0);
}

}  // namespace scree
