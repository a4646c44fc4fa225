// Laws of efforts on one joint coordinate: motors, springs, limits, friction. They depend on neither joints
// nor bodies.
#pragma once

#include <memory>
#include <string>

#include "base/types.hpp"
#include "mbs/dual.hpp"
#include "model/data/joint_forces.hpp"

namespace scree {

// A joint coordinate c at one instant.
struct CoordinateInstant {
  Real time = 0;             // t [s]
  Real value = 0, rate = 0;  // c, c' [rad or m, per s]
  Real load = 0;             // F: force of the joint's reaction [N], for the laws that depend on it
  Real second = 0;           // c'' [rad or m, per s^2], at the start of a step, for the laws that need it
};

// An effort T, positive where it increases c, and its derivatives.
struct JointEffort {
  Real effort = 0;                 // T [N m or N]
  Real by_value = 0, by_rate = 0;  // T_c, T_c'
  Real size = 0;                   // the largest single contribution, as contributions may cancel
  Real by_load = 0;                // T_F
  Dual wanted{};                   // in a step: the effort at its end without limit(), where that is finite
};

// A step from `start`, with the law's memory there.
struct LawStep {
  CoordinateInstant start;
  Real memory = 0;
  Real h = 0;  // [s]
};

class JointLaw {
 public:
  virtual ~JointLaw() = default;

  // Effort at one instant. memory: one number of the state, for laws with memory.
  virtual JointEffort effort(const CoordinateInstant& at, Real memory) const = 0;
  // Effort at the end of a step, for the trapezoidal rule.
  virtual JointEffort step_effort(const LawStep& step, const CoordinateInstant& end) const {
    return effort(end, step.memory);
  }
  // Whether step_effort differs from effort at the same instant.
  virtual bool resolves_events() const { return false; }

  // The limit of the effort, for laws whose unlimited effort depends on the end of a step alone.
  virtual Real limit() const { return kInfinity; }
  // step_effort where the unlimited effort at the end is `wanted`.
  virtual Real limited_at(const LawStep&, Real wanted) const { return wanted; }

  virtual bool has_memory() const { return false; }
  // Memory at the end of an accepted step; of a step of length 0, an instant, under the load of `end`.
  virtual Real memory_after(const LawStep& step, const CoordinateInstant&) const { return step.memory; }

  // Whether the effort depends on the load.
  virtual bool is_loaded() const { return false; }

  // Whether the law needs c'' at the start of a step.
  virtual bool needs_second() const { return false; }

  // Whether the law's work counts as fed in; otherwise as stored and dissipated.
  virtual bool drives() const { return false; }
  virtual Real energy(Real, Real) const { return 0; }  // stored at c with this memory [J]
  // Largest stiffness -T_c apart from limits and friction, for scales [N m/rad or N/m].
  virtual Real stiffness() const { return 0; }
};

// Throw InputError with the name of the element where a table of a time function is refused (end: of the
// simulated time [s]).
std::unique_ptr<JointLaw> make_joint_law(const Motor& motor, Real end);
// start: the coordinate at t = 0.
std::unique_ptr<JointLaw> make_joint_law(const JointSpring& spring, Real start);
// resolve_events: as in Integrator.
std::unique_ptr<JointLaw> make_joint_law(const JointLimit& limit, bool resolve_events);
std::unique_ptr<JointLaw> make_joint_law(const JointFriction& friction);

}  // namespace scree
