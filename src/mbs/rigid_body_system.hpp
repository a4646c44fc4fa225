// Rigid bodies with joints, drivers, force elements and contact wrenches as a MechanicalSystem.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mbs/bushing.hpp"
#include "mbs/constraints.hpp"
#include "mbs/force_elements.hpp"
#include "mbs/joint_forces.hpp"
#include "mbs/mechanical_system.hpp"
#include "mbs/primitive_function.hpp"
#include "mbs/rigid_bodies.hpp"
#include "model/data/body_exchange.hpp"
#include "model/data/body_layout.hpp"
#include "model/data/model.hpp"

namespace scree {

// A joint, driver or coupler and its rows of Phi.
struct ConstraintGroup {
  std::string title;       // "joint 'pin'", "driver 'crank'"
  std::string name;        // "pin"
  std::string deck_label;  // as of the joint in the model
  bool drives = false;     // whether it is a driver
  Real start = 0;          // of a driver: its motion at t = 0
  std::string remedy{};    // of a driver whose velocity at t = 0 contradicts the other constraints
  BodyKind kind = BodyKind::planar;
  int body = kGround;              // the joint's first body
  Quaternion marker{};             // the joint's marker on that body
  int first = 0, end = 0;          // range of the system's constraint objects
  int first_row = 0, end_row = 0;  // range of rows of Phi
};

// Positions and columns of the bodies are ordered as in the model's BodyLayout. The angles of spatial joints
// at the last accepted step [rad] follow after the positions of the bodies; they count the revolutions. Rows
// of Phi: joints, then drivers, then couplers.
class RigidBodySystem final : public MechanicalSystem {
 public:
  // Throws InputError naming the joint, driver or element that is refused.
  explicit RigidBodySystem(const Model& model);

  int positions() const override { return layout_.positions() + counted_angles(); }
  int coordinates() const override { return layout_.columns(); }
  int constraints() const override { return static_cast<int>(constraint_scale_.size()); }
  void evaluate(const SystemInstant& at, SystemTerms& terms) override;
  void evaluate_uncontacted(const SystemInstant& at, SystemTerms& terms) override;
  void add_contacts(SystemTerms& terms) const override;
  void evaluate_uncontacted_forces(const SystemInstant& at, SystemTerms& terms) override;
  bool contacts_in_matrix() const override;
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

  // Sets the contacts for the next evaluate() and differentiate(); the model starts without any.
  void set_contacts(const ContactWrenches& contacts);
  // Keeps the wrenches alone.
  void drop_stiffness() { set_stiffness({}, {}); }
  // Keeps the contacts' stiffness and replaces their wrenches, one per body.
  void set_forces(const std::vector<BodyWrench>& wrench) { wrench_ = wrench; }
  // Whether the wrenches set last have the same forces and torques.
  bool has_forces_of(const std::vector<BodyWrench>& wrench) const;
  bool has_contacts() const;  // whether any of them has a force or torque

  // Number of angles of spatial joints, the last of the positions.
  int counted_angles() const { return static_cast<int>(counted_.size()); }
  // Writes the counted angles of the poses, each on the branch nearest to the angle with which the poses
  // were set.
  void count_revolutions(const BodyPoses& poses, std::vector<Real>& position) const;
  // Poses of the last evaluate().
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
  // Group of one row.
  int group_of(int row) const { return group_[static_cast<std::size_t>(row)]; }
  // Whether C of one row is an angle [rad]; otherwise it is a length [m].
  bool is_angle(int row) const { return is_angle_[static_cast<std::size_t>(row)]; }

  // Poses of any instant, without use of earlier evaluations.
  BodyPoses poses_at(const SystemInstant& at) const;
  // The same, valid until the next call of this or of powers().
  const BodyPoses& passing_poses(const SystemInstant& at);
  Powers powers(const SystemInstant& at, const std::vector<Real>& multipliers);
  // memory: as in the state.
  Real elastic_energy(const SystemInstant& at, const std::vector<Real>& memory) const;
  // Force [N] on body 2 of the group at its joint point and torque about that point [N m], global, and the
  // orientation of the joint's marker on body 1.
  struct GroupReaction {
    Vec3 force, torque;
    Quaternion frame;
  };
  // Reactions of all groups. at: with its multipliers; memory: as in the state. A cylinder has no rows; its
  // reaction is the force along it.
  std::vector<GroupReaction> reactions(const SystemInstant& at, const std::vector<Real>& memory) const;
  // ForceElement::effort of the spring-dampers, then of the torsional ones.
  std::vector<Real> spring_efforts(const SystemInstant& at) const;

 private:
  struct CountedAngle {
    int number;
    std::unique_ptr<PrimitiveFunction> angle;
  };

  void set_stiffness(const std::vector<WrenchStiffness>& of_bodies,
                     const std::vector<PairStiffness>& of_pairs);
  void add_counted_angles(const Model& model);
  void set_poses(const std::vector<Real>& position, const std::vector<Real>& velocity,
                 BodyPoses& poses) const;
  BodyPoses start_poses() const;
  // Adds the rows of joints, drivers and couplers. start: the poses at t = 0.
  void add_constraints(const Model& model, const BodyPoses& start);
  void add_elements(const Model& model, const BodyPoses& start);
  void add_cylinder_forces(const SystemInstant& at, const std::vector<Real>& memory, const BodyPoses& poses,
                           std::vector<GroupReaction>& reactions) const;
  // The rows of the transmitted force, for every joint.
  std::vector<std::vector<int>> load_rows(const Model& model) const;
  // Completes a group whose names are given. joint: the one with these rows; of a coupler the first one.
  void add_group(ConstraintGroup group, std::vector<std::unique_ptr<Constraint>> parts, const Joint& joint,
                 BodyKind kind);

  std::vector<Body> bodies_;
  BodyLayout layout_;
  std::vector<std::unique_ptr<RigidBodies>> kinds_;
  std::vector<CountedAngle> counted_;
  Real length_scale_ = 1;
  Real constant_force_scale_ = 0;  // of weights and stiffness; see SystemTerms::force_scale [J]
  std::vector<Real> weight_;       // generalized forces of gravity
  BodyPoses poses_;
  BodyPoses scratch_;
  std::vector<BodyWrench> wrench_;
  std::vector<PairStiffness> pairs_;
  bool stiffened_ = false;  // whether contacts with a stiffness are set
  std::vector<std::unique_ptr<Constraint>> constraints_;
  std::vector<int> first_row_;        // per constraint object
  std::vector<std::size_t> drivers_;  // the constraint objects whose f may depend on time
  std::vector<bool> is_angle_;        // per row
  std::vector<int> group_;            // per row
  std::vector<ConstraintGroup> groups_;
  std::vector<std::unique_ptr<ForceElement>> elements_;
  std::size_t springs_ = 0;                      // number of spring-dampers, the first of elements_
  std::vector<const BushingElement*> bushings_;  // those among elements_
  JointForces joint_forces_;
  std::vector<Real> coordinate_scale_, constraint_scale_;
};

}  // namespace scree
