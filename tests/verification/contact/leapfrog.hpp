// A minimal particle code: one sphere on a plane, or two spheres, under a contact law, with leapfrog steps.
#pragma once

#include "physics/contact_law.hpp"
#include "physics/energy.hpp"
#include "physics/particle_mass.hpp"

namespace scree {

// A sphere with its velocities of the preceding half step.
struct Grain {
  Vec3 position{};  // [m]
  Vec3 velocity{};  // [m/s]
  Vec3 spin{};      // [rad/s]
  Real radius, mass;
  Real inertia = moment_of_inertia(solid_inertia_factor(3), mass, radius);  // [kg m^2]

  RotatingPartner partner() const { return {spin, radius, inertia}; }
  Real energy() const { return kinetic_energy(mass, velocity) + rotational_energy(inertia, spin); }
};

// Force over mass and torque over inertia of the last step.
struct GrainRates {
  Vec3 acceleration, spin_up;  // [m/s^2], [rad/s^2]
};

// Sums over all contacts of a run.
struct ContactSums {
  Real normal = 0;  // losses of the normal law [J]
  SpringLosses friction, rolling;

  template <class Outcome>
  void add(const Outcome& out, Real h) {
    normal += out.load.loss * h - out.friction.sum() - out.rolling.sum();
    friction += out.friction, rolling += out.rolling;
  }
};

// A sphere i over the plane z = 0.
template <class Law>
struct PlaneRun {
  Law law;
  Grain grain;
  Vec3 gravity{};  // [m/s^2]
  Real h = 0;      // [s]

  typename Law::Outcome outcome{};
  GrainRates rates{};
  ContactSums sums{};
  bool closed = false;

  ContactGeometry geometry() const { return plane_pair(grain.position, grain.radius, {0, 0, 0}, {0, 0, 1}); }
  PairState pair() const {
    return {geometry(),
            grain.velocity + (h / 2) * rates.acceleration,
            {grain.radius, kInfinity, grain.mass, kInfinity}};
  }
  // Advances velocities at the start by half a step.
  void start() {
    const PairState state = pair();
    const ContactMotion rest =
        face_motion(state.geometry, state.geometry.normal(), {}, {{}, grain.radius, grain.inertia}, {}, h);
    kick(law.respond({state, rest}, outcome.history), h / 2);
  }
  void step() {
    const Vec3 displacement = h * grain.velocity;
    grain.position += displacement;
    const PairState state = pair();
    const ContactMotion motion =
        face_motion(state.geometry, state.geometry.normal(), displacement, grain.partner(), {}, h);
    closed = law.closed(state, outcome.history);
    outcome = law.respond({state, motion}, outcome.history);
    sums.add(outcome, h);
    kick(outcome, h);
  }
  // Velocity at the end of the last step, half a step before that of `grain`.
  Vec3 velocity() const { return grain.velocity - (h / 2) * rates.acceleration; }
  Vec3 spin() const { return grain.spin - (h / 2) * rates.spin_up; }

 private:
  void kick(const typename Law::Outcome& out, Real time) {
    rates.acceleration = (1 / grain.mass) * out.load.force + gravity;
    rates.spin_up = (1 / grain.inertia) * out.load.torque_i;
    grain.velocity += time * rates.acceleration, grain.spin += time * rates.spin_up;
  }
};

// Two free spheres.
template <class Law>
struct PairRun {
  Law law;
  Grain i, j;
  Real h = 0;  // [s]
  // Whether the law uses velocities predicted for the end of the step; else those of mid-step, as the
  // program.
  bool predicts = true;

  typename Law::Outcome outcome{};
  GrainRates rates_i{}, rates_j{};
  ContactSums sums{};
  bool closed = false;

  PairState pair() const {
    const Real ahead = predicts ? h / 2 : 0;
    return {sphere_pair(i.position - j.position, i.radius + j.radius),
            (i.velocity + ahead * rates_i.acceleration) - (j.velocity + ahead * rates_j.acceleration),
            {i.radius, j.radius, i.mass, j.mass}};
  }
  void step() {
    const Vec3 displacement = h * (i.velocity - j.velocity);
    i.position += h * i.velocity, j.position += h * j.velocity;
    const PairState state = pair();
    const ContactMotion motion = sphere_motion(state.geometry, displacement, i.partner(), j.partner(), h);
    closed = law.closed(state, outcome.history);
    outcome = law.respond({state, motion}, outcome.history);
    sums.add(outcome, h);
    kick(i, rates_i, outcome.load.force, outcome.load.torque_i);
    kick(j, rates_j, -outcome.load.force, outcome.load.torque_j);
  }

 private:
  void kick(Grain& grain, GrainRates& rates, Vec3 force, Vec3 torque) const {
    rates = {(1 / grain.mass) * force, (1 / grain.inertia) * torque};
    grain.velocity += h * rates.acceleration, grain.spin += h * rates.spin_up;
  }
};

// Takes steps until a contact has closed and opened again, at most `limit` steps; returns whether it has.
template <class Run>
bool run_impact(Run& run, int limit) {
  bool met = false;
  for (int step = 0; step < limit; ++step) {
    run.step();
    if (met && !run.closed) return true;
    met = met || run.closed;
  }
  return false;
}

}  // namespace scree
