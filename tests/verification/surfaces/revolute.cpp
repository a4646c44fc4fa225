// A plate of triangles on a revolute joint, and a particle on it: the reported reaction against the forces
// on the plate.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "physics/spatial_rotation.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"
#include "support/simulation_run.hpp"

namespace scree {

namespace {

constexpr Real kGravity = 9.81, kStep = 1e-4, kEnd = 0.06, kMass = 0.3;
constexpr Real kReach = 0.3;  // of the plate from its joint [m]

// The revolute joint lies along one of the plate's edges; a particle falls on the plate off its middle.
std::string deck(const std::string& method, Real alpha) {
  return fmt::format(
      "gravity = [0, 0, -{}]\n[space]\ndimension = 3\nmin = [-1, -1, -1]\nmax = [1, 1, "
      "1]\n[time]\nend = {}\nstep = {}\ncontrol = \"fixed\"\n[integrator]\nparticles = \"{}\"\nhht_alpha = "
      "{}\n[[contact.pairs]]\nstiffness = 1e4\nrestitution = 0.5\nfriction = 0.4\n[[meshes]]\nname = "
      "\"plate\"\nkind = \"box\"\nsize = [0.3, 0.2, 0.02]\nrefine = 0.03\n[[bodies]]\nname = \"plate\"\nkind "
      "= "
      "\"spatial\"\nposition = [0.15, 0, -0.01]\nsolids = [{{ kind = \"mesh\", mesh = \"plate\", density = "
      "1000.0 }}]\nmeshes = [{{ mesh = \"plate\" }}]\n[[joints]]\nname = \"hinge\"\ntype = "
      "\"revolute\"\nbodies = "
      "[\"ground\", \"plate\"]\npoint = [0, 0, 0]\naxis = [0, 1, 0]\n[[particles]]\nname = \"grain\"\nkind = "
      "\"list\"\npositions = [[0.2, 0.03, 0.021]]\nvelocity = [0.5, 0.2, -1]\nradius = 0.02\nmass = "
      "{}\n[output]\nhistory_contacts = [\"plate\"]\n",
      kGravity, kEnd, kStep, method, alpha, kMass);
}

// Sums over the plate; torques about its centre.
struct Sums {
  Vec3 force, torque;      // of the joint, the particle and the weight
  Vec3 contact, recorded;  // force of the particle, as applied to the plate and as in the history [N]
};
Sums sums_of(SimulationRun& run, const Model& model) {
  const BodyMotion plate = run.multibody().motion(run.bodies())[0];
  BodyWrench hinge;
  for (const Reaction& part : run.multibody().reactions(run.bodies(), run.time()))
    hinge.force += part.force, hinge.torque += part.torque;
  const BodyWrench& grain = run.bodies().wrench.at(0);
  const std::vector<Real> history = run.contact_values();
  const Vec3 arm = rotation_matrix(plate.orientation) * model.joints[0].point[1];
  return {hinge.force + grain.force + model.bodies[0].mass * Vec3{0, 0, -kGravity},
          hinge.torque + cross(arm, hinge.force) + grain.torque,
          grain.force,
          {history[0], history[1], history[2]}};
}

// Rates of the plate's momenta.
struct Rates {
  Vec3 linear, angular;
};
Rates rates_of(const SimulationRun& run, const Body& plate) {
  const std::vector<Real> a = run.multibody().at_instant(run.bodies(), run.time()).acceleration;
  const BodyMotion motion = run.multibody().motion(run.bodies())[0];
  const Vec3 spun = plate.inertia_tensor * Vec3{a[3], a[4], a[5]},
             whirled = cross(motion.spin, plate.inertia_tensor * motion.spin);
  return {plate.mass * Vec3{a[0], a[1], a[2]}, rotation_matrix(motion.orientation) * (spun + whirled)};
}

}  // namespace

TEST_CASE(
    "revolute joint, particle and weight alone accelerate a plate of triangles, at every step of an impact") {
  constexpr Real kBalance = 1e-12, kIterated = 1e-9;  // relative to the largest force
  for (const std::string method : {"velocity-verlet", "hht"})
    for (const Real alpha : {0.0, -0.05}) {
      CAPTURE(method, alpha);
      const Model model = model_of(deck(method, alpha));
      SimulationRun run(model);
      Real largest = 0, force_error = 0, torque_error = 0, record_error = 0, particle_error = 0;
      while (run.time() < kEnd - kStep / 2) {
        run.step();
        const Sums now = sums_of(run, model);
        const Rates rates = rates_of(run, model.bodies[0]);
        const auto raise = [](Real& most, Vec3 by) { most = std::max(most, norm(by)); };
        raise(largest, now.contact);
        raise(force_error, rates.linear - now.force);
        raise(torque_error, rates.angular - now.torque);
        raise(record_error, now.recorded - now.contact);
        const Particle grain = run.particles()[0];
        raise(particle_error, grain.force - kMass * Vec3{0, 0, -kGravity} + now.contact);
      }
      CHECK(largest > 30);
      CHECK(run.multibody().motion(run.bodies())[0].spin.y > 3);
      CHECK(force_error < kBalance * largest);
      CHECK(torque_error < kBalance * largest * kReach);
      // Explicit steps compute the particle's force before the plate has reached its pose at the end of the
      // step.
      if (method != "hht") continue;
      CHECK(record_error < kIterated * largest);
      CHECK(particle_error < kIterated * largest);
    }
}

TEST_CASE("a held revolute joint carries a plate of triangles and the particle at rest on it") {
  constexpr Real kBalance = 1e-12, kAtRest = 1e-8;
  const std::string held =
      "[[drivers]]\nname = \"hold\"\njoint = \"hinge\"\nmotion = { kind = \"constant\", value = 0.0 }\n";
  for (const std::string method : {"velocity-verlet", "hht"}) {
    CAPTURE(method);
    const Model model =
        model_of(deck(method, -0.05) + held,
                 {"time.end=2.0", "integrator.residual_tolerance=1e-11",
                  "particles.grain.velocity=[0, 0, -0.1]", "contact.pairs.0.tangential_damping_ratio=0.3"});
    SimulationRun run(model);
    run.run();
    const Sums at_rest = sums_of(run, model);
    const Vec3 weight{0, 0, -kMass * kGravity};
    CHECK(norm(at_rest.force) < kBalance * norm(weight));
    CHECK(norm(at_rest.torque) < kBalance * norm(weight) * kReach);
    CHECK(near(at_rest.recorded, weight, {.relative = kAtRest}));
    const Reaction hinge = run.multibody().reactions(run.bodies(), run.time()).at(0);
    CHECK(near(hinge.force, Vec3{0, 0, (kMass + model.bodies[0].mass) * kGravity}, {.relative = kAtRest}));
  }
}

}  // namespace scree
