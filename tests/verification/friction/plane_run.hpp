// A sphere on the wall z = 0 with its static overlap, through a deck: its motion at given times.
#pragma once

#include <cmath>

#include "verification/contact/on_plane.hpp"
#include "verification/friction/particle_decks.hpp"

namespace scree {

// damping_ratio: of the slip. A model of a sphere whose weight its normal spring carries from the start on.
inline Model resting_model(Grain grain, Real friction, Real stiffness, Real damping_ratio, Vec3 gravity,
                           Real step, Real end, const std::vector<std::string>& settings = {}) {
  grain.position = {0, 0, grain.radius + grain.mass * gravity.z / kRestStiffness};
  GrainDeck deck{.law = fmt::format("stiffness = {}\nfriction = {}\ntangential_stiffness = {}\n"
                                    "tangential_damping_ratio = {}\n",
                                    kRestStiffness, friction, stiffness, damping_ratio),
                 .grains = {grain},
                 .step = step,
                 .end = end};
  deck.gravity = gravity, deck.settings = settings;
  return deck.model();
}

// State at the step of length h that is nearest to a time t, extrapolated there by its rates.
struct PlaneState {
  Real x, v, w;        // [m], [m/s], [rad/s]
  Real spring, force;  // spring: of the slider; force: along the plane, gravity included [N]

  PlaneState(SimulationRun& run, Real t, Real h) {
    run.run_until(t - h / 2);
    const Real back = t - run.time();
    const State& state = run.complete_state();
    const Particle& p = state.particles.at(0);
    x = p.position.x + back * p.velocity.x + back * back / 2 * p.acceleration.x;
    v = p.velocity.x + back * p.acceleration.x;
    w = p.angular_velocity.y + back * p.angular_acceleration.y;
    spring = state.contacts.keys.empty() ? 0 : state.contacts.values.at(0), force = p.force.x;
  }
};

}  // namespace scree
