// A joint law as a generalized force along the coordinate of a joint.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "mbs/constraints.hpp"
#include "mbs/joint_laws.hpp"
#include "mbs/limit_bridge.hpp"
#include "mbs/mechanical_system.hpp"

namespace scree {

// Work of a law over one step [J]: `applied` of laws that drive, otherwise `dissipated`, less the change of
// the law's stored energy.
struct JointWork {
  Real dissipated = 0, applied = 0;
};

// With c the coordinate, g = c_q and H = c_qq:
//   Q     = T(c, c', t) g,  c' = g.v
//   -Q_q  = -(T_c g g^T + T_c' g (H^T v)^T + T H)
//   -Q_v T^-1 = -T_c' g (T^-T g)^T, T^-1 as in MechanicalSystem
//   -Q_lambda = -T_F g (lambda / F)^T, F = |lambda| of the rows that load the law
class JointForce {
 public:
  // coordinate: a constraint of one row with f = 0, whose C is c.
  JointForce(std::string name, std::unique_ptr<Constraint> coordinate, std::unique_ptr<JointLaw> law);

  // Adds a body of the joint with spatial rotation, whose three columns begin at `column`.
  void rotates_in_space(int body, int column) { rotations_.push_back({body, column, 0, false}); }

  // Sets the rows of Phi whose multipliers are the components of the force that the joint transmits, along
  // perpendicular axes.
  void is_loaded_by(std::vector<int> rows) { load_rows_ = std::move(rows); }

  // Sets the joint of the model that is a cylinder, along which the force acts.
  void acts_along_cylinder(int joint) { cylinder_ = joint; }
  int cylinder() const { return cylinder_; }  // -1: along none

  const std::string& name() const { return name_; }
  bool is_angle() const { return coordinate_->is_angle(); }
  bool has_memory() const { return law_->has_memory(); }
  bool resolves_events() const { return law_->resolves_events(); }
  bool is_loaded() const { return law_->is_loaded(); }

  // Opens a step of length h at this instant, with its multipliers and the law's memory there. With h = 0
  // forces are those of instants until the next step. Where an instant has no multipliers, the load is that
  // of the last one that had some.
  void open_step(const BodyPoses& poses, const SystemInstant& at, Real h, Real memory);
  // From here on forces are those of the instant of an evaluation, not of the step.
  void end_step() { in_step_ = false; }

  // Adds to Q [coordinates]. Returns the size of what it added [J]: a force times `length` [m], or a torque.
  Real add_force(const BodyPoses& poses, const SystemInstant& at, Real length, std::vector<Real>& force);
  // Adds -Q_q, -Q_v T^-1 and -Q_lambda, at the instant of the last add_force().
  void add_derivatives(const BodyPoses& poses, const SystemInstant& at, SystemDerivatives& derivatives);
  // Work from the opening of the step to the last add_force(), trapezoidal over the coordinate.
  JointWork work() const;
  // The law's memory at the end of the step, which is the instant of the last add_force().
  Real memory() const { return law_->memory_after(step_, last_); }

  Real elastic_energy(const BodyPoses& poses, Real t, Real memory) const;
  Real elastic_scale(Real length) const { return law_->stiffness() * (is_angle() ? 1 : length * length); }
  // Coordinate and effort at any instant with multipliers; c'' where the instant has accelerations. memory:
  // as in the state there.
  struct Sample {
    CoordinateInstant at;
    Real effort = 0;
  };
  Sample sample(const BodyPoses& poses, const SystemInstant& at, Real memory) const;
  // Adds the force [N] of this effort on the joint's second body at its joint point, and the torque about
  // that point [N m].
  void add_reaction(const BodyPoses& poses, Real effort, Vec3& force, Vec3& torque) const;

 private:
  Real load_of(const SystemInstant& at) const;
  void find_coordinates();
  std::vector<std::size_t> local_indices(const SparseTerm& term) const;
  void pull_back(const BodyPoses& poses);
  struct RotationColumns {
    int body, first;
    std::size_t at = 0;    // of its first coordinate among coordinates_
    bool is_read = false;  // c depends on it
  };

  std::string name_;
  std::unique_ptr<Constraint> coordinate_;
  std::unique_ptr<JointLaw> law_;
  std::vector<RotationColumns> rotations_;  // spatial ones
  std::vector<int> load_rows_;
  int cylinder_ = -1;
  LawStep step_;
  Real start_effort_ = 0;
  bool in_step_ = false;
  LimitBridge bridge_;
  // Results of the last add_force().
  CoordinateInstant last_;
  JointEffort effort_;
  SparseTerm gradient_;
  // Scratch of add_derivatives(): the coordinates that c depends on, and g, H^T v and T^-T g there.
  std::vector<int> coordinates_;
  std::vector<std::size_t> in_gradient_, in_hessian_;  // the coordinates of their entries, by column
  std::vector<Real> along_, rotation_rate_, displaced_;
  SparseTerm hessian_;
};

}  // namespace scree
