// A particle that hits a body of spheres off every axis: for increasingly stiff contacts its impulse, and
// the resulting motion, are those of two rigid bodies with an instantaneous impact.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "physics/spatial_rotation.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"

using namespace scree;

namespace {

constexpr Real kBodyMass = 3, kParticleRadius = 0.02, kDensity = 2500, kSpeed = 2, kSphereRadius = 0.05;
const Sym3 kInertia{.xx = 0.02, .xy = 0.003, .xz = -0.002, .yy = 0.035, .yz = 0.004, .zz = 0.028};
const Vec3 kOffset{0.15, -0.1, 0.08};  // of the sphere that is hit, in the body's frame
const Vec3 kRevolute{-0.2, 0.05, 0};   // in the body's frame
const Quaternion kPose = normalized({0.7, -0.3, 0.5, 0.4});
const Vec3 kAway =
    (1 / norm(Vec3{0.6, -0.5, 0.9})) * Vec3{0.6, -0.5, 0.9};  // from the sphere to the particle

Real particle_mass() {
  return kDensity * 4 / 3 * std::numbers::pi * kParticleRadius * kParticleRadius * kParticleRadius;
}
Vec3 global(Vec3 local) { return rotation_matrix(kPose) * local; }
std::string text(Vec3 v) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x, v.y, v.z); }

// The first touch is at the end of a step, but for round-off: nothing else acts there. The particle is in
// contact for half the duration of an impact on a wall, and is separated again after less than that time.
std::string deck(Real stiffness, const std::string& particles, const std::string& hinge) {
  const Real duration = std::numbers::pi * std::sqrt(particle_mass() / stiffness);
  const Vec3 grain = global(kOffset) + (kSphereRadius + kParticleRadius + kSpeed * duration / 2) * kAway;
  return fmt::format(
             "gravity = [0, 0, 0]\n[space]\ndimension = 3\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\n[time]\nend "
             "= "
             "{:.17g}\nstep = {:.17g}\ncontrol = \"fixed\"\n[integrator]\nparticles = \"{}\"\n"
             "[[contact.pairs]]\nstiffness = {}\n",
             3 * duration, duration / 200, particles, stiffness) +
         fmt::format(
             "[[bodies]]\nname = \"plate\"\nkind = \"spatial\"\nmass = {}\ninertia_tensor = [{}, {}, {}, {}, "
             "{}, "
             "{}]\nposition = [0.0, 0.0, 0.0]\nquaternion = [{:.17g}, {:.17g}, {:.17g}, {:.17g}]\nshapes = "
             "[{{ radius "
             "= {}, offset = {} }}]\n",
             kBodyMass, kInertia.xx, kInertia.yy, kInertia.zz, kInertia.xy, kInertia.xz, kInertia.yz, kPose.w,
             kPose.x, kPose.y, kPose.z, kSphereRadius, text(kOffset)) +
         hinge +
         fmt::format(
             "[[particles]]\nname = \"grain\"\nkind = \"list\"\npositions = [{}]\nvelocity = {}\nradius = "
             "{}\ndensity = {}\n[output]\nhistory_interval = 1.0\n",
             text(grain), text(-kSpeed * kAway), kParticleRadius, kDensity);
}

// Motion after the impact.
struct Motion {
  Vec3 velocity, spin;  // of the body: of its centre, and in its own frame
  Vec3 grain;
};

Motion simulated(const std::string& deck) {
  const Model model = model_of(deck);
  SimulationRun run(model);
  run.run();
  const BodyMotion body = run.multibody().motion(run.bodies())[0];
  const Ledger end = run.ledger();
  CHECK(near(end.kinetic, kSpeed * kSpeed * particle_mass() / 2, {.relative = 1e-4}));
  return {body.velocity, body.spin, run.particles()[0].velocity};
}

// An impulse P along the line of centres, elastic: P (1/m + response along the line) = 2 speed. turned: spin
// in the body's frame due to an impulse of 1 N s; moved: velocity of the centre due to it.
Motion closed_form(Vec3 turned, Vec3 moved) {
  const Vec3 push = transposed_times(rotation_matrix(kPose), -kAway);  // in the body's frame
  const Real response = 1 / particle_mass() + dot(push, moved + cross(turned, kOffset));
  const Real impulse = 2 * kSpeed / response;
  return {global(impulse * moved), impulse * turned, (impulse / particle_mass() - kSpeed) * kAway};
}

void check_converges(const std::string& hinge, const Motion& exact) {
  for (const std::string particles : {"hht", "velocity-verlet"}) {
    CAPTURE(particles);
    Real error[2];
    for (int i = 0; i < 2; ++i) {
      const Motion motion = simulated(deck(i == 0 ? 1e6 : 1e8, particles, hinge));
      error[i] = std::max({norm(motion.velocity - exact.velocity) / norm(exact.velocity),
                           norm(motion.spin - exact.spin) / norm(exact.spin),
                           norm(motion.grain - exact.grain) / kSpeed});
    }
    // The body rotates during the contact: an error proportional to the duration, a tenth at a hundred times
    // the stiffness.
    CAPTURE(error[0], error[1]);
    CHECK(error[0] < 0.02);
    CHECK(error[1] < 0.12 * error[0]);
  }
}

}  // namespace

TEST_CASE("the impulse of a particle on a free body in space") {
  const Vec3 push = transposed_times(rotation_matrix(kPose), -kAway);
  const Vec3 turned = inverse(kInertia) * cross(kOffset, push);
  check_converges("", closed_form(turned, (1 / kBodyMass) * push));
}

TEST_CASE("the impulse of a particle on a body that hangs on a spherical joint") {
  const Vec3 push = transposed_times(rotation_matrix(kPose), -kAway);
  const Vec3 centre = -kRevolute;  // from the joint
  Sym3 about_joint = kInertia;
  const Real square = kBodyMass * dot(centre, centre);
  about_joint += Sym3{.xx = square, .yy = square, .zz = square};
  about_joint += outer(-kBodyMass, centre);
  const Vec3 turned = inverse(about_joint) * cross(kOffset - kRevolute, push);
  check_converges(fmt::format("[[joints]]\nname = \"ball\"\ntype = \"spherical\"\nbodies = [\"ground\", "
                              "\"plate\"]\npoint = {}\n",
                              text(global(kRevolute))),
                  closed_form(turned, cross(turned, centre)));
}

TEST_CASE("the impulse of a particle on a plate on a revolute joint") {
  const Vec3 push = transposed_times(rotation_matrix(kPose), -kAway);
  const Vec3 axis = (1 / norm(Vec3{0.3, 0.9, -0.2})) * Vec3{0.3, 0.9, -0.2};  // in the body's frame
  const Vec3 centre = -kRevolute, across = cross(axis, centre);
  const Real inertia = dot(axis, kInertia * axis) + kBodyMass * dot(across, across);
  const Vec3 turned = (dot(axis, cross(kOffset - kRevolute, push)) / inertia) * axis;
  check_converges(fmt::format("[[joints]]\nname = \"hinge\"\ntype = \"revolute\"\nbodies = [\"ground\", "
                              "\"plate\"]\npoint = {}\naxis = {}\n",
                              text(global(kRevolute)), text(global(axis))),
                  closed_form(turned, cross(turned, centre)));
}
