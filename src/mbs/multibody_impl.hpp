// The parts of the multibody subsystem; for its own files.
#pragma once

#include <string>
#include <vector>

#include "mbs/hht_method.hpp"
#include "mbs/joint_readings.hpp"
#include "mbs/multibody.hpp"
#include "mbs/newton_solver.hpp"
#include "mbs/reaction_watch.hpp"
#include "mbs/rigid_body_system.hpp"
#include "mbs/start_checks.hpp"
#include "mbs/start_elements.hpp"

namespace scree {

struct Multibody::Impl {
  explicit Impl(const Model& model);
  void settle_velocities(const Model& model);
  void open_step(const MultibodyState& state, Real t, Real h) {
    const SystemInstant at{t, state.position, state.velocity, &state.multipliers, &state.acceleration};
    if (!system.joint_forces().empty())
      system.joint_forces().open_step(system.passing_poses(at), at, h, state.memory);
  }
  void solve_acceleration(MultibodyState& state, Real t);
  MultibodyState state_after(const MultibodyState& state, Real tau) const;
  MultibodyState corrected_start(const MultibodyState& state, Real h);
  void predict(const MultibodyState& state, Real t, Real h) {
    open_step(state, t, h);
    method.predict(state, t, h);
  }
  void follow_load();
  void close_step(const MultibodyState& state);
  Real error() const;
  void watch_reactions(const MultibodyState& state);
  [[noreturn]] void fail_for_oscillation() const;

  // The wrenches of the bodies alone, without those of walls.
  std::vector<BodyWrench> wrench_of_bodies(const MultibodyState& state) const {
    return {state.wrench.begin(), state.wrench.begin() + static_cast<std::ptrdiff_t>(motion.size())};
  }
  void update_motion() {
    for (const auto& kind : system.kinds()) kind->motion(method.position(), method.velocity(), motion);
  }

  RigidBodySystem system;
  StartFindings findings;
  MultibodyState start;  // q of the model, and its v or the nearest consistent velocities
  std::string start_change;
  HhtMethod method;
  NewtonSolver newton;
  JointReadings readings;
  ReactionWatch watch;
  TimeControl time_control;
  bool corrects_start;
  StartElements start_elements;
  Real weight = 0;  // of all bodies [N]
  std::vector<BodyMotion> motion;
  MultibodyState end;           // of the step that accept() closes; swapped with the caller's state
  Real time = 0;                // of the open step's start [s]
  IterationNorms norms;         // from the last correct()
  bool closed = false;          // close_step() has been called for the open step
  bool efforts_differ = false;  // found by close_step(): the joints' efforts change where the step ends
};

}  // namespace scree
