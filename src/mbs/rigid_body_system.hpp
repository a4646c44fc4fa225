// Rigid bodies with joints, drivers, force elements and contact wrenches as a MechanicalSystem.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mbs/bushing.hpp"
#include "mbs/constraints.hpp"
#include "mbs/force_elements.hpp"
#include "mbs/joint_forces.hpp"
#include "mbs/measure.hpp"
#include "mbs/mechanical_system.hpp"
#include "mbs/rigid_bodies.hpp"
#include "model/data/body_exchange.hpp"
#include "model/data/body_layout.hpp"
#include "model/data/model.hpp"

namespace scree {

// A joint, driver or coupler and its rows of Phi.
struct ConstraintGroup {
  std::string title;       // "joint 'pin'", "driver 'crank'"
  std::string name;        // "pin"
  std::string deck_label;  // as of a joint of the model
  bool drives = false;     // it is a driver
  Real start = 0;          // of a driver, its motion at t = 0
  std::string remedy{};    // of a driver whose velocity at t = 0 contradicts what else is given
  BodyKind kind = BodyKind::planar;
  int body = kGround;              // the joint's first one
  Quaternion marker{};             // of the joint on it
  int first = 0, end = 0;          // of the system's constraint objects
  int first_row = 0, end_row = 0;  // of Phi
};

// Positions and columns of the bodies stand as in the model's BodyLayout. After the bodies' positions stand
// the angles of joints in space at the last accepted step [rad]: what tells how often they went round. Rows
// of Phi: joints, then drivers, then couplers.
class RigidBodySystem final : public MechanicalSystem {
 public:
  // Throws InputError naming the joint, driver or element that is refused.
  explicit RigidBodySystem(const Model& model);

  int positions() const override { return layout_.positions() + counted_angles(); }
  int coordinates() const override { return layout_.columns(); }
  int constraints() const override { return static_cast<int>(constraint_scale_.size()); }
  void evaluate(const SystemInstant& at, SystemTerms& terms) override;
  void differentiate(const SystemInstant& at, const SystemIterate& iterate,
                     SystemDerivatives& derivatives) override;
  void displace(const std::vector<Real>& start, const std::vector<Real>& displacement,
                std::vector<Real>& position) const override;
  void pull_back(const std::vector<Real>& displacement, std::vector<Real>& change) const override;
  void velocity_rhs(const SystemInstant& at, std::vector<Real>& rhs) const override;
  void acceleration_rhs(const SystemInstant& at, std::vector<Real>& rhs) const override;
  const std::vector<Real>& coordinate_scale() const override { return coordinate_scale_; }
  const std::vector<Real>& constraint_scale() const override { return constraint_scale_; }
  std::string coordinate_name(int coordinate) const override;
  std::string constraint_name(int constraint) const override;

  // Contacts as the next evaluate() and differentiate() use them; the model starts without any.
  void set_contacts(const ContactWrenches& contacts);
  // The same contacts with other wrenches, one per body.
  void set_forces(const std::vector<BodyWrench>& wrench) { wrench_ = wrench; }
  // The wrenches set last have the same forces and torques.
  bool has_forces_of(const std::vector<BodyWrench>& wrench) const;

  // Of joints in space: how many of the positions, the last ones, are angles.
  int counted_angles() const { return static_cast<int>(counted_.size()); }
  // Writes these angles: those of the poses, on the branches next to the angles that the poses were set with.
  void count_turns(const BodyPoses& poses, std::vector<Real>& position) const;
  // Of the last evaluate().
  const BodyPoses& poses() const { return poses_; }

  // M^-1, constant.
  SparseTerm inverse_mass() const;

  JointForces& joint_forces() { return joint_forces_; }
  const JointForces& joint_forces() const { return joint_forces_; }

  const std::vector<const BushingElement*>& bushings() const { return bushings_; }

  const std::vector<Body>& bodies() const { return bodies_; }
  const BodyLayout& layout() const { return layout_; }
  const std::vector<std::unique_ptr<RigidBodies>>& kinds() const { return kinds_; }
  // Characteristic length L [m]: the largest radius of a body's shape; without shapes the largest distance of
  // a joint or force element from the centre of its body; without these that of meshes on planes, or 1 m.
  Real length_scale() const { return length_scale_; }
  const std::vector<ConstraintGroup>& groups() const { return groups_; }
  // Of one row.
  int group_of(int row) const { return group_[static_cast<std::size_t>(row)]; }
  // C of one row is an angle [rad], not a length [m].
  bool is_angle(int row) const { return is_angle_[static_cast<std::size_t>(row)]; }

  // At any instant, from scratch.
  BodyPoses poses_at(const SystemInstant& at) const;
  Powers powers(const SystemInstant& at, const std::vector<Real>& multipliers);
  // memory: as in the state.
  Real elastic_energy(const SystemInstant& at, const std::vector<Real>& memory) const;
  // Force [N] on body 2 of the group at its joint point and torque about that point [N m], global, and the
  // orientation of the joint's marker on body 1.
  struct GroupReaction {
    Vec3 force, torque;
    Quaternion frame;
  };
  // at: with its multipliers; memory: as in the state. Of a cylinder, which has no rows, what acts along it.
  std::vector<GroupReaction> reactions(const SystemInstant& at, const std::vector<Real>& memory) const;
  // Of the spring-dampers, then of the torsional ones: ForceElement::effort.
  std::vector<Real> spring_efforts(const SystemInstant& at) const;

 private:
  struct CountedAngle {
    int number;
    std::unique_ptr<Measure> angle;
  };

  void add_counted_angles(const Model& model);
  void set_poses(const std::vector<Real>& position, const std::vector<Real>& velocity,
                 BodyPoses& poses) const;
  BodyPoses start_poses() const;
  // start: at t = 0.
  void add_constraints(const Model& model, const BodyPoses& start);
  void add_elements(const Model& model, const BodyPoses& start);
  void add_cylinder_forces(const SystemInstant& at, const std::vector<Real>& memory, const BodyPoses& poses,
                           std::vector<GroupReaction>& reactions) const;
  // Of every joint.
  std::vector<std::vector<int>> load_rows(const Model& model) const;
  // The group's names are given, the rest follows. joint: whose the rows are; of a coupler's, the first one.
  void add_group(ConstraintGroup group, std::vector<std::unique_ptr<Constraint>> parts, const Joint& joint,
                 BodyKind kind);

  std::vector<Body> bodies_;
  BodyLayout layout_;
  std::vector<std::unique_ptr<RigidBodies>> kinds_;
  std::vector<CountedAngle> counted_;
  Real length_scale_ = 1;
  Real constant_force_scale_ = 0;  // of the weights and of stiffness; see SystemTerms::force_scale [J]
  std::vector<Real> weight_;       // generalized forces of gravity
  BodyPoses poses_;
  BodyPoses scratch_;
  std::vector<BodyWrench> wrench_;
  std::vector<PairStiffness> pairs_;
  std::vector<std::unique_ptr<Constraint>> constraints_;
  std::vector<int> first_row_;  // of every constraint object
  std::vector<bool> is_angle_;  // of every row
  std::vector<int> group_;      // of every row
  std::vector<ConstraintGroup> groups_;
  std::vector<std::unique_ptr<ForceElement>> elements_;
  std::size_t springs_ = 0;                      // of these the first so many
  std::vector<const BushingElement*> bushings_;  // of these
  JointForces joint_forces_;
  std::vector<Real> coordinate_scale_, constraint_scale_;
};

}  // namespace scree
