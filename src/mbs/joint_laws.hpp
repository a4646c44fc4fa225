// Laws of efforts on one joint coordinate: motors, springs, limits, friction. They know neither joints nor
// bodies.
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
  Real load = 0;             // F: force of the joint's reaction [N]; for the laws that depend on it
  Real second = 0;           // c'' [rad or m, per s^2]; at the start of a step, for the laws that ask for it
};

// An effort T, which pushes c up where it is above 0, and its derivatives.
struct JointEffort {
  Real effort = 0;                 // T [N m or N]
  Real by_value = 0, by_rate = 0;  // T_c, T_c'
  Real size = 0;                   // its largest single contribution, as they may cancel
  Real by_load = 0;                // T_F
  Dual wanted{};                   // of a step: the effort at its end without limit(), where that is finite
};

// A step from `start`, with what the law remembered there.
struct LawStep {
  CoordinateInstant start;
  Real memory = 0;
  Real h = 0;  // [s]
};

class JointLaw {
 public:
  virtual ~JointLaw() = default;

  // At one instant. memory: one number of the state, in the laws that remember.
  virtual JointEffort effort(const CoordinateInstant& at, Real memory) const = 0;
  // At the end of a step, for the trapezoidal rule.
  virtual JointEffort step_effort(const LawStep& step, const CoordinateInstant& end) const {
    return effort(end, step.memory);
  }
  // Whether step_effort differs from effort at the same instant.
  virtual bool resolves_events() const { return false; }

  // Of laws whose effort, without it, follows the end of a step alone.
  virtual Real limit() const { return kInfinity; }
  // step_effort where the effort without the limit ends at `wanted`.
  virtual Real limited_at(const LawStep&, Real wanted) const { return wanted; }

  virtual bool remembers() const { return false; }
  // What is remembered at the end of an accepted step. Of one of length 0, an instant, under the load of
  // `end`.
  virtual Real memory_after(const LawStep& step, const CoordinateInstant&) const { return step.memory; }

  // Whether the effort depends on the load.
  virtual bool is_loaded() const { return false; }

  // Whether the law asks for c'' at the start of a step.
  virtual bool needs_second() const { return false; }

  // Whether its work is fed in; else it is stored, and dissipated.
  virtual bool drives() const { return false; }
  virtual Real energy(Real, Real) const { return 0; }  // stored at c, with what is remembered there [J]
  // Largest stiffness -T_c that goes without saying [N m/rad or N/m].
  virtual Real stiffness() const { return 0; }
};

// Throw InputError naming the element where a table of a time function is refused (end: of the simulated time
// [s]).
std::unique_ptr<JointLaw> make_joint_law(const Motor& motor, Real end);
// start: the coordinate at t = 0.
std::unique_ptr<JointLaw> make_joint_law(const JointSpring& spring, Real start);
// resolve_events: as Integrator's.
std::unique_ptr<JointLaw> make_joint_law(const JointLimit& limit, bool resolve_events);
std::unique_ptr<JointLaw> make_joint_law(const JointFriction& friction);

}  // namespace scree
