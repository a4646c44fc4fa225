// The multibody subsystem of rank 0: HHT-I3 for constrained rigid bodies, one Newton iteration at a time.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "model/data/body_exchange.hpp"
#include "model/data/model.hpp"

namespace scree {

// All state of the multibody side; a checkpoint stores exactly this.
struct MultibodyState {
  // q: x, y [m], angle [rad] of a planar body; x, y, z, quaternion of a spatial one; then angles of spatial
  // joints [rad], which count their revolutions
  std::vector<Real> position;
  std::size_t counted_angles = 0;  // number of these angles, the last of the positions
  // v: q'; the last three of a spatial body are the angular velocity in its frame [rad/s].
  std::vector<Real> velocity;
  std::vector<Real> acceleration;  // a: v', with hht_alpha < 0 at t + hht_alpha h
  std::vector<Real> multipliers;   // lambda, joints' rows first, then drivers' [N, N m]
  std::vector<Real> force;         // Q - Phi_q^T lambda, contact wrenches included: HHT's force at t_n
  std::vector<Real> applied;       // Q alone, for the energy ledger
  std::vector<BodyWrench> wrench;  // of the contacts at t_n, per body; where walls move or have a surface
                                   // velocity, then per such wall (BodyCoupling)
  std::vector<Real> belt_power;    // per such wall, the power of the contacts at its surface velocity [W]
  std::vector<Real> memory;        // of motors and friction on joints, in their order (mbs/joint_forces.hpp)
  Real dissipated = 0;             // in force elements since t = 0 [J]
  Real integrator_loss = 0;        // taken out by HHT since t = 0 [J]
  Real driver_work = 0;            // done by drivers, actuators, applied forces and walls since t = 0 [J]
  // Smallest and largest kinetic energy of all bodies at the ends of steps since t = 0 [J].
  Real min_kinetic = 0, max_kinetic = 0;
};

// Size of one Newton iteration, scaled and dimensionless.
struct IterationNorms {
  Real residual = 0;    // at the iterate from which the iteration started
  Real correction = 0;  // of the position, over the length scale
};

struct MultibodyEnergies {
  Real kinetic = 0, gravitational = 0, elastic = 0;  // [J]
};

// Reaction of a joint or driver, or the force of a cylinder, on body[1] at its joint point, in the global
// frame.
struct Reaction {
  std::string joint;
  Vec3 force;   // [N]
  Vec3 torque;  // about that point [N m]
  BodyKind kind = BodyKind::planar;
  Quaternion frame{};  // between spatial bodies: the joint's marker on body[0], global
};

// A coordinate of a joint at one instant.
struct JointReading {
  std::string joint;
  JointCoordinate coordinate = JointCoordinate::angle;
  Real value = 0, rate = 0;  // [rad or m, per s]
};

// A motor, spring, limit or friction on a joint at one instant.
struct JointEffortSample {
  std::string name;
  bool is_angle = false;
  Real coordinate = 0, rate = 0;  // [rad] or [m], per s
  Real effort = 0, power = 0;     // [N m] or [N]; [W], above 0 where it is fed in
};

// Deflection and load of a bushing at one instant, along the axes of its frame on the first body.
struct BushingSample {
  std::string name;
  Vec3 shift, turn;    // of the second frame from the first: displacement [m], rotation vector [rad]
  Vec3 force, torque;  // on the second body, about its point [N, N m]
};

class Multibody {
 public:
  // Throws InputError, with the names of the joints, where joints are not closed at the start, start
  // velocities contradict them, or constraints are redundant without permission.
  explicit Multibody(const Model& model);
  ~Multibody();

  // Consistent start: q of the model and its v, which is projected onto the constraints where the model says
  // so; a and lambda from the acceleration-level system with these wrenches.
  MultibodyState initial_state(const std::vector<BodyWrench>& wrench);

  // Prepares a state of another model for this one: a and lambda as in initial_state, at its time t [s].
  // Throws InputError where the state violates a joint or driver.
  void solve_acceleration(MultibodyState& state, Real t, const std::vector<BodyWrench>& wrench);

  // Warnings, one text each, of joint limits that the start position violates, with their efforts and stored
  // energies, and of servos that start off their position where the step is too long for them. Throws
  // InputError where the start is hardly intended (mbs/violated_limits.hpp, mbs/overshooting_servos.hpp).
  std::vector<std::string> start_warnings();

  // Opens a step from `state` at time t of length h: Newmark prediction with a_{n+1} = a_n.
  void predict(const MultibodyState& state, Real t, Real h);
  // Between predict() and the first correct(): does what that correct() needs and the contacts do not change,
  // while they are not known yet.
  void prepare();
  // One Newton iteration of Eq. 14 with the contact wrenches at the current iterate. Throws SimulationError
  // naming the joint or body on a singular matrix or a non-finite residual.
  IterationNorms correct(const ContactWrenches& contacts);
  // Explains a step that does not converge, by the last correct(): which joints and drivers are violated,
  // and whether the position is nearly singular; empty where neither explains it.
  std::string trouble();
  // A text for a run that ends because the step opened last fails: it names the driver whose prescribed
  // motion the mechanism cannot follow (mbs/dead_point.hpp); empty where there is none.
  std::string dead_point();
  // Scaled local position error of the open step: HHT's estimate over the length scale.
  Real error() const;
  // After the last correct(): does what accept() for this state needs and the wrenches at the end of the step
  // do not change. Throws SimulationError as accept() does.
  void begin_accept(const MultibodyState& state);
  // Closes the step into `state`. Without this call the step is rejected and `state` is unchanged.
  // end_wrench: contact wrenches at the end of the step, where they differ from those that the step was
  // corrected with because contacts opened or closed within it; the next step starts from them. Throws
  // SimulationError, with `state` unchanged, where the reactions oscillate beyond repair (see
  // ReactionWatch).
  void accept(MultibodyState& state, const std::vector<BodyWrench>& end_wrench);

  // Replaces the fraction `share` of the accelerations at the end of the step that accept() has just closed
  // by their mean over the step.
  void average_accelerations(MultibodyState& state, Real share) const;

  // Called after a failed step: throws SimulationError where the reactions oscillate, as shorter steps do
  // not help then.
  void check_reactions() const;
  // The warning of a run that went on although its reactions oscillated; else empty.
  std::string reaction_warning() const;

  // One entry per body, at the current iterate of the open step.
  const std::vector<BodyMotion>& motion() const;
  // One entry per body, of a state; tau: extrapolated by so much under its accelerations [s].
  std::vector<BodyMotion> motion(const MultibodyState& state, Real tau = 0) const;
  void motion(const MultibodyState& state, Real tau, std::vector<BodyMotion>& out) const;

  MultibodyEnergies energies(const MultibodyState& state, Real t) const;
  // Energy scale of the round-off of forces and reactions [J]: the sum of their magnitudes, each times the
  // scale of its coordinate. Forces may cancel, their round-off does not.
  Real energy_of_forces(const MultibodyState& state) const;
  // An accepted state, while no step is open, with the accelerations and multipliers of its instant t: those
  // of the acceleration-level system with its positions, velocities and forces, and with the memory of
  // friction under the new reactions. The accelerations and multipliers of a step belong to no instant and
  // alternate for tens of steps after a jump of the step length; they are kept where the position is
  // singular.
  MultibodyState at_instant(const MultibodyState& state, Real t) const;
  // Reactions of joints, drivers and cylinders at the instant of the state.
  std::vector<Reaction> reactions(const MultibodyState& state, Real t) const;
  // Coordinates of the joints that Output::history_coordinates counts.
  std::vector<JointReading> joint_readings(const MultibodyState& state, Real t) const;
  // Efforts of motors, springs, limits and friction on joints, in this order, under the reactions of the
  // instant.
  std::vector<JointEffortSample> joint_efforts(const MultibodyState& state, Real t) const;

  // Tension of the spring-dampers [N], then the torque of the torsional ones on their second bodies [N m].
  std::vector<Real> spring_efforts(const MultibodyState& state, Real t) const;
  std::vector<BushingSample> bushings(const MultibodyState& state, Real t) const;

  // Where the model asks for consistent velocities: their largest change at t = 0, e.g. "angular velocity of
  // body 'crank' (id 0) from 0.0 to 2.5 rad/s"; empty where nothing changed.
  const std::string& start_change() const;

  // Note on redundant constraints with minimum-norm reactions: rows, rank and names, e.g. "20 rows of rank
  // 17: joint 'a', joint 'b'"; empty where there are none.
  const std::string& redundancy() const;

  int coordinates() const;
  int constraints() const;
  // e.g. "petsc 3.18.5, preonly + lu (klu_refactor)"
  std::string solver_description() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace scree
