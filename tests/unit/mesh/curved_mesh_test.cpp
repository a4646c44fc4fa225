// Curved surfaces made of triangles: the error of the force is due to the facets' sag alone.
#include <cmath>
#include <vector>

#include "mesh/mesh_contacts.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"
#include "support/test_meshes.hpp"

namespace scree {

namespace {

constexpr Real kRadius = 1;  // of the particle [m]

// Root mean square of force / (k overlap) - 1 at random positions, at this overlap with the circumscribed
// sphere.
Real force_error(const SurfaceMesh& mesh, Real distance, Real overlap) {
  MeshRandom random(1);
  Real sum = 0;
  constexpr int kPositions = 3000;
  for (int i = 0; i < kPositions; ++i) {
    const Real error = norm(push_on(mesh, distance * random.direction(), kRadius)) / overlap - 1;
    sum += error * error;
  }
  return std::sqrt(sum / kPositions);
}

// A point mass of 1 kg on a linear spring, released without friction at the height of the drum's axis: the
// largest change of its energy over a swing and back, relative to the drop.
Real swing_energy_error(const SurfaceMesh& drum, Real drum_radius, int steps_per_contact) {
  constexpr Real kGravity = 1, kStiffness = 300, kPeriod = 22;
  const Real h = M_PI / std::sqrt(kStiffness) / steps_per_contact, drop = drum_radius - kRadius;
  Vec3 x{drop, 2, 0}, v;
  Real potential = 0, worst = 0;
  const auto acceleration = [&] {
    Vec3 a{0, 0, -kGravity};
    potential = kGravity * x.z;
    for (const MeshContact& contact : contacts_at(drum, x, kRadius)) {
      const Real overlap = kRadius - contact.distance;
      a += (kStiffness * overlap) * contact.normal;
      potential += kStiffness / 2 * overlap * overlap;
    }
    return a;
  };
  Vec3 a = acceleration();
  const Real start = potential;
  for (Real t = 0; t < kPeriod; t += h) {
    v += (h / 2) * a;
    x += h * v;
    a = acceleration();
    v += (h / 2) * a;
    worst = std::max(worst, std::abs(dot(v, v) / 2 + potential - start));
  }
  return worst / (kGravity * drop);
}

}  // namespace

TEST_CASE("the force of a faceted sphere errs by the sag, of second order") {
  constexpr Real kSphere = 5, kOverlap = 0.5;
  // At h/R = 0.30, 0.15, 0.075, 0.038.
  const Real expected[] = {0.12, 0.031, 0.0078, 0.0019};
  Real last = 0;
  for (int level = 2; level <= 5; ++level) {
    const TriangleMesh mesh = icosphere(level, kSphere);
    const Real inside = force_error(closed_mesh(flipped(mesh)), kSphere - kRadius + kOverlap, kOverlap);
    const Real outside = force_error(closed_mesh(mesh), kSphere + kRadius - kOverlap, kOverlap);
    CHECK(near(inside, expected[level - 2], {.relative = 0.03}));
    CHECK(outside < inside);
    if (last > 0) CHECK(near(std::log2(last / inside), 2, {.absolute = 0.1}));
    last = inside;
  }
}

TEST_CASE("in a drum of 144 facets the force is that of the facet's sag, and never doubled") {
  constexpr Real kDrum = 10, kOverlap = 0.01, kCenter = kDrum - kRadius + kOverlap;
  const SurfaceMesh drum = sheet_mesh(drum_shell(144, kDrum, 4, 3));
  MeshRandom random(2);
  Real least = kInfinity, most = 0;
  bool one = true;
  for (int i = 0; i < 20000; ++i) {
    const Real angle = random.in(0, 2 * M_PI);
    const Vec3 c{kCenter * std::sin(angle), random.in(0.1, 3.9), -kCenter * std::cos(angle)};
    one = one && contacts_at(drum, c, kRadius).size() == 1;
    const Real force = norm(push_on(drum, c, kRadius)) / kOverlap;
    least = std::min(least, force), most = std::max(most, force);
  }
  CHECK(one);
  // Sag in the middle of a facet: 10 (1 - cos(180/144 deg)) = 0.00238 m; over its ends the distance from the
  // axis is less by 1 - cos of that angle.
  CHECK(near(most, 1.238, {.absolute = 1e-3}));
  CHECK(near(least, 1.0235, {.absolute = 1e-3}));
}

TEST_CASE("a drum of n facets has force errors of second order") {
  Real last = 0;
  for (const int facets : {72, 144, 288, 576}) {
    const SurfaceMesh drum = sheet_mesh(drum_shell(facets, 10, 4, 1));
    MeshRandom random(5);
    Real sum = 0;
    constexpr int kPositions = 4000;
    for (int i = 0; i < kPositions; ++i) {
      const Real angle = random.in(0, 2 * M_PI);
      const Vec3 c{9.05 * std::sin(angle), 2, -9.05 * std::cos(angle)};
      const Real error = norm(push_on(drum, c, kRadius)) / 0.05 - 1;
      sum += error * error;
    }
    const Real error = std::sqrt(sum / kPositions);
    if (last > 0) CHECK(near(std::log2(last / error), 2, {.absolute = 0.1}));
    last = error;
  }
}

TEST_CASE("a swing in a drum of facets keeps its energy, the better the shorter the step") {
  const SurfaceMesh drum = sheet_mesh(drum_shell(144, 10, 4, 1));
  const Real coarse = swing_energy_error(drum, 10, 31), fine = swing_energy_error(drum, 10, 250);
  CAPTURE(coarse, fine);
  CHECK(fine <= 2e-4);
  CHECK(fine < coarse / 2);
  CHECK(coarse < 1e-3);
}

}  // namespace scree
