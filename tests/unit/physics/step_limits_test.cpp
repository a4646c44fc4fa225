// The step limits against the oscillators for which they are derived.
#include "physics/step_limits.hpp"

#include <algorithm>
#include <numbers>
#include <vector>

#include "physics/contact_law.hpp"
#include "physics/time_stepping.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 4 * kUlp;

// Largest |x| that velocity Verlet reaches from x = 1 on a damped oscillator, damping on the predicted
// velocity.
Real largest_swing(Real stiffness, Real damping, Real mass, Real h) {
  const auto acceleration = [&](Vec3 x, Vec3 v) { return (-1 / mass) * (stiffness * x + damping * v); };
  Vec3 x{1, 0, 0}, v, a = acceleration(x, v);
  Real largest = 1;
  for (int step = 0; step < 2000; ++step) {
    x += verlet_displacement(h, v, a);
    const Vec3 predicted = verlet_predicted_velocity(h, v, a);
    const Vec3 a1 = acceleration(x, predicted);
    v = verlet_velocity(h, predicted, a, a1), a = a1;
    largest = std::max(largest, std::abs(x.x));
  }
  return largest;
}

}  // namespace

TEST_CASE("velocity Verlet is stable below its limit and not above") {
  const Real stiffness = 1e4, mass = 0.5;
  const Real frequency = contact_frequency(stiffness, mass);
  for (const Real damping : {0.0, 5.0, 40.0, 200.0}) {
    CAPTURE(damping);
    const Real limit = verlet_step_limit(frequency, stiffness, damping);
    CHECK(largest_swing(stiffness, damping, mass, 0.99 * limit) < 10);
    CHECK(largest_swing(stiffness, damping, mass, 1.01 * limit) > 1e6);
  }
  CHECK(near(verlet_step_limit(frequency, stiffness, 0), 2 / frequency, {.relative = kRoundOff}));
  CHECK(near(verlet_step_limit(frequency, stiffness, 1e12), mass / 1e12, {.relative = kRoundOff}));
}

namespace {

// Directions to the neighbours of a disc in the triangular lattice or a sphere in the face-centred cubic
// one, and whether the neighbour belongs to the next layer.
struct Neighbor {
  Vec3 direction;
  bool next_layer;
};

std::vector<Neighbor> densest_lattice(int dimension) {
  const Real a = std::sqrt(0.5), b = std::sqrt(0.75);
  std::vector<Neighbor> out;
  for (const Real s : {-1.0, 1.0}) {
    if (dimension == 2) out.push_back({{s, 0, 0}, false});
    for (const Real t : {-1.0, 1.0}) {
      if (dimension == 2) {
        out.push_back({{s / 2, t * b, 0}, true});
        continue;
      }
      out.push_back({{s * a, t * a, 0}, false});
      out.push_back({{s * a, 0, t * a}, true});
      out.push_back({{0, s * a, t * a}, true});
    }
  }
  return out;
}

// Force and torque on a particle of radius and mass 1 whose contacts, of nearly zero overlap, are changed by
// a small motion of it and of its neighbours.
ContactLoadOf<Real, Vec3> lattice_load(int dimension, Real slip_stiffness, Vec3 displacement, Vec3 turn) {
  ContactLoadOf<Real, Vec3> sum{};
  constexpr Real kOverlap = 1e-3;
  const ContactLaw<LinearLaw, LinearSlider> law{LinearLaw(1, 0, false), {slip_stiffness, 1e9, 0}};
  for (const Neighbor& neighbor : densest_lattice(dimension)) {
    const Vec3 other = neighbor.next_layer ? -displacement : displacement;
    const ContactGeometry geometry =
        sphere_pair(-(2 - kOverlap) * neighbor.direction + (displacement - other), Real(2));
    const MovingPair pair{{geometry, {}, {1, 1, 1, 1}},
                          sphere_motion(geometry, displacement - other, {turn, 1, 1}, {turn, 1, 1}, 1)};
    const ContactOutcome out = law.respond(pair, {});
    sum.force += out.load.force, sum.torque_i += out.load.torque_i;
  }
  return sum;
}

}  // namespace

TEST_CASE("the highest modes of the densest lattices of particles with friction") {
  constexpr Real kSmall = 1e-6, kNearly = 5e-3;  // size of the overlap, and of the displacement
  for (const int dimension : {2, 3})
    for (const Real slip : {0.0, 0.2, 0.8}) {
      CAPTURE(dimension, slip);
      const Vec3 across = dimension == 2 ? Vec3{0, kSmall, 0} : Vec3{0, 0, kSmall}, about{0, 0, kSmall};
      const Real moving = norm(lattice_load(dimension, slip, across, {}).force) / kSmall;
      const Real spinning = norm(lattice_load(dimension, slip, {}, about).torque_i) / kSmall;
      for (const Real share : {0.4, 0.5, 1.0}) {
        const Real frequency = dense_friction_frequency(1, slip, 1, share, dimension);
        CHECK(near(frequency * frequency, std::max(moving, spinning / share), {.relative = kNearly}));
      }
    }
  CHECK(dense_friction_frequency(2, 0, 1, 0.4, 3) == dense_frequency(2, 1, 3));
  CHECK(dense_friction_frequency(6, 0, 1, 0.5, 2) == dense_frequency(6, 1, 2));
}

TEST_CASE("steps of particles that rotate are stable below their limit and not above") {
  const Real stiffness = 1e4, mass = 0.5;
  for (const Real damping : {0.0, 5.0, 40.0, 200.0}) {
    CAPTURE(damping);
    const auto largest = [&](Real h) {
      Real x = 0, v = 1e-3 / h, most = 0;  // of the half step
      for (int step = 0; step < 2000; ++step) {
        x += h * v;
        v -= h * (stiffness * x + damping * v) / mass;
        most = std::max(most, std::abs(x));
      }
      return most;
    };
    const Real limit = leapfrog_step_limit(contact_frequency(stiffness, mass), damping / mass);
    CHECK(largest(0.99 * limit) < 1);
    CHECK(largest(1.01 * limit) > 1e6);
  }
  CHECK(near(leapfrog_step_limit(contact_frequency(stiffness, mass), 1e12 / mass), 2 * mass / 1e12,
             {.relative = kRoundOff}));
}

TEST_CASE("the stiffness that friction adds to contacts") {
  constexpr Real kSphere = 0.4, kDisc = 0.5;  // I / (m R^2)
  CHECK(near(wall_friction_frequency(7, 2, 1, kSphere), std::sqrt(7), {.relative = kRoundOff}));
  CHECK(near(wall_friction_frequency(1, 1, 1, kSphere), std::sqrt(3.5), {.relative = kRoundOff}));
  CHECK(near(wall_friction_frequency(1, 1, 1, kDisc), std::sqrt(3), {.relative = kRoundOff}));
  constexpr PairSize kSize{0.02, 0.02, 1, 1};
  CHECK(typical_slip_stiffness({.friction = 0.3, .stiffness = 5e3}, kSize) == 5e3);
  CHECK(typical_slip_stiffness({.friction = 0, .stiffness = 5e3}, kSize) == 0);
  CHECK(near(typical_slip_stiffness({.friction = 0.3, .shear_modulus = 1e6}, kSize),
             8e6 * std::sqrt(0.01 * 0.01 * 0.02), {.relative = kRoundOff}));
}

TEST_CASE("contact time and typical stiffness") {
  CHECK(reduced_mass(2, 2) == 1);
  CHECK(near(reduced_mass(1, 1e12), 1 - 1e-12, {.relative = kRoundOff}));
  CHECK(near(contact_time(100, 1), std::numbers::pi / 10, {.relative = kRoundOff}));
  constexpr PairSize kSize{0.02, 0.01, 1, 1};
  CHECK(typical_stiffness({5e3, 0, 1, false}, kSize) == 5e3);
  CHECK(near(typical_stiffness({5e3, 0, 1.5, false}, kSize), 5e3 * 1.5 * 0.01, {.relative = kRoundOff}));
  CHECK(dense_frequency(6, 1, 2) == 6);
  CHECK(dense_frequency(2, 1, 3) == 4);
}

}  // namespace scree
