#include "mbs/rigid_body_system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "mbs/body_coupling.hpp"
#include "mbs/coupler.hpp"
#include "mbs/joints.hpp"
#include "model/derived/connections.hpp"
#include "model/derived/joint_coordinates.hpp"
#include "model/derived/mesh_corners.hpp"

namespace scree {

namespace {

Real characteristic_length(const Model& model) {
  Real radius = 0, largest_arm = 0;
  for (const Body& body : model.bodies) {
    for (const Shape& shape : body.shapes) radius = std::max(radius, shape.radius);
  }
  const auto add_point = [&](int body, Vec3 point) {
    if (body == kGround) return;
    largest_arm = std::max(largest_arm, is_spatial(model, body) ? norm(point) : norm(planar(point)));
  };
  for (int i = 0; i < 2; ++i) {
    for (const Joint& joint : model.joints) add_point(joint.body[i], joint.point[i]);
    for (const SpringDamper& element : model.spring_dampers) add_point(element.body[i], element.point[i]);
  }
  for (const Bushing& element : model.bushings)
    for (int i = 0; i < 2; ++i) add_point(element.body[i], element.point[i]);
  for (const AppliedForce& element : model.applied_forces) add_point(element.body, element.point);
  if (radius > 0 || largest_arm > 0) return radius > 0 ? radius : largest_arm;
  const Real of_corners = largest_corner_radius(model);
  return of_corners > 0 ? of_corners : 1;
}

// A natural spline through points that begin level does not start with zero velocity.
std::string start_remedy(const TimeFunction& given, const ScalarFunction& motion) {
  if (given.kind != TimeFunctionKind::table || given.interpolation != Interpolation::natural) return "";
  return fmt::format(
      "; its table's natural spline begins with a rate of {:.4g}: interpolation = \"monotone\" stays between "
      "the "
      "values, \"clamped\" starts with the rates in end_rates",
      motion(0).rate);
}

}  // namespace

RigidBodySystem::RigidBodySystem(const Model& model)
    : bodies_(model.bodies),
      layout_(model.bodies),
      length_scale_(characteristic_length(model)),
      weight_(static_cast<std::size_t>(layout_.columns()), 0),
      poses_(layout_),
      scratch_(layout_),
      wrench_(model.bodies.size()),
      coordinate_scale_(static_cast<std::size_t>(layout_.columns()), 1) {
  kinds_.push_back(planar_bodies(model, layout_));
  kinds_.push_back(spatial_bodies(model, layout_));
  for (const auto& kind : kinds_) {
    kind->set_scale(length_scale_, coordinate_scale_);
    kind->set_weight(weight_);
    constant_force_scale_ = std::max(constant_force_scale_, kind->weight_scale(length_scale_));
  }
  add_counted_angles(model);
  const BodyPoses start = start_poses();
  add_constraints(model, start);
  add_elements(model, start);
}

void RigidBodySystem::add_constraints(const Model& model, const BodyPoses& start) {
  const std::vector<bool> rowless = rowless_joints(model);
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const Joint& joint = model.joints[i];
    const std::unique_ptr<JointParts> parts = joint_parts(model, static_cast<int>(i), layout_);
    add_joint(joint, rowless[i], *parts);
    add_group({fmt::format("joint '{}'", joint.name), joint.name, joint.deck_label}, parts->take(), joint,
              between(model, joint.body));
  }
  for (const Driver& driver : model.drivers) {
    const Joint& joint = model.joints[static_cast<std::size_t>(driver.joint)];
    const std::string title = fmt::format("driver '{}'", driver.name);
    const std::unique_ptr<JointParts> parts = joint_parts(model, driver.joint, layout_);
    const ScalarFunction motion(driver.motion, title, model.time.end);
    add_driver(coordinate_of(title, joint, driver.coordinate), motion, *parts);
    add_group(
        {title, driver.name, driver.deck_label, true, motion(0).value, start_remedy(driver.motion, motion)},
        parts->take(), joint, between(model, joint.body));
  }
  for (const Coupler& coupler : model.couplers) {
    std::vector<std::unique_ptr<Constraint>> rows;
    rows.push_back(make_coupler(coupler, model, layout_, start));
    const Joint& first = model.joints[static_cast<std::size_t>(coupler.joints.front())];
    add_group({fmt::format("coupler '{}'", coupler.name), coupler.name, coupler.deck_label}, std::move(rows),
              first, between(model, first.body));
  }
}

void RigidBodySystem::add_elements(const Model& model, const BodyPoses& start) {
  const Real end = model.time.end;
  for (const SpringDamper& e : model.spring_dampers)
    elements_.push_back(between(model, e.body) == BodyKind::spatial ? make_spatial_element(e, layout_, end)
                                                                    : make_force_element(e, layout_, end));
  for (const TorsionalSpringDamper& e : model.torsional_spring_dampers)
    elements_.push_back(make_force_element(e, layout_));
  springs_ = elements_.size();
  for (const Bushing& e : model.bushings) {
    auto element = std::make_unique<BushingElement>(e, layout_);
    bushings_.push_back(element.get());
    elements_.push_back(std::move(element));
  }
  for (const AppliedForce& e : model.applied_forces)
    elements_.push_back(is_spatial(model, e.body) ? make_spatial_element(e, layout_, end)
                                                  : make_force_element(e, layout_, end));
  for (const auto& element : elements_) {
    constant_force_scale_ =
        std::max(constant_force_scale_, kElasticFloor * element->elastic_scale(length_scale_));
  }
  joint_forces_ = JointForces(model, layout_, start, load_rows(model));
  constant_force_scale_ =
      std::max(constant_force_scale_, kElasticFloor * joint_forces_.elastic_scale(length_scale_));
}

// Rows of a joint that are lengths are displacements along perpendicular axes, or coincident points: their
// multipliers are forces.
std::vector<std::vector<int>> RigidBodySystem::load_rows(const Model& model) const {
  std::vector<std::vector<int>> rows(model.joints.size());
  for (std::size_t j = 0; j < rows.size(); ++j)
    for (int row = groups_[j].first_row; row < groups_[j].end_row; ++row)
      if (!is_angle(row)) rows[j].push_back(row);
  return rows;
}

void RigidBodySystem::add_group(ConstraintGroup group, std::vector<std::unique_ptr<Constraint>> parts,
                                const Joint& joint, BodyKind kind) {
  group.kind = kind, group.body = joint.body[0], group.marker = joint.marker[0];
  group.first = static_cast<int>(constraints_.size()), group.first_row = constraints();
  for (std::unique_ptr<Constraint>& part : parts) {
    if (group.drives) drivers_.push_back(constraints_.size());
    first_row_.push_back(constraints());
    for (int row = 0; row < part->rows(); ++row) {
      is_angle_.push_back(part->is_angle());
      constraint_scale_.push_back(part->is_angle() ? 1 : length_scale_);
      group_.push_back(static_cast<int>(groups_.size()));
    }
    constraints_.push_back(std::move(part));
  }
  group.end = static_cast<int>(constraints_.size());
  group.end_row = constraints();
  groups_.push_back(std::move(group));
}

void RigidBodySystem::evaluate(const SystemInstant& at, SystemTerms& terms) {
  evaluate_uncontacted(at, terms);
  add_contacts(terms);
}

void RigidBodySystem::evaluate_uncontacted(const SystemInstant& at, SystemTerms& terms) {
  evaluate_uncontacted_forces(at, terms);
  terms.constraint_jacobian.begin();
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    constraints_[i]->value(poses_, at.time, &terms.constraint[static_cast<std::size_t>(first_row_[i])]);
    constraints_[i]->jacobian(poses_, first_row_[i], terms.constraint_jacobian);
  }
}

void RigidBodySystem::evaluate_uncontacted_forces(const SystemInstant& at, SystemTerms& terms) {
  set_poses(at.position, at.velocity, poses_);
  if (terms.mass.size() == 0) {  // it is constant
    terms.mass.begin();
    for (const auto& kind : kinds_) kind->add_mass(terms.mass);
  }
  terms.applied_force = weight_;
  terms.force_scale = constant_force_scale_;
  for (const auto& element : elements_) {
    const Real size = element->add_force(poses_, at.time, length_scale_, terms.applied_force);
    terms.force_scale = std::max(terms.force_scale, size);
  }
  terms.force_scale =
      std::max(terms.force_scale, joint_forces_.add_force(poses_, at, length_scale_, terms.applied_force));
  for (const auto& kind : kinds_)
    terms.force_scale = std::max(terms.force_scale, kind->add_inertial_force(poses_, terms.applied_force));
}

void RigidBodySystem::add_contacts(SystemTerms& terms) const {
  for (const auto& kind : kinds_)
    terms.force_scale =
        std::max(terms.force_scale, kind->add_contact(poses_, wrench_, length_scale_, terms.applied_force));
}

void RigidBodySystem::set_contacts(const ContactWrenches& contacts) {
  wrench_ = contacts.wrench;
  set_stiffness(contacts.stiffness, contacts.pairs);
}

void RigidBodySystem::set_stiffness(const std::vector<WrenchStiffness>& of_bodies,
                                    const std::vector<PairStiffness>& of_pairs) {
  pairs_ = of_pairs;
  stiffened_ = !of_bodies.empty() || !of_pairs.empty();
  for (const auto& kind : kinds_) kind->set_contact_stiffness(of_bodies);
}

bool RigidBodySystem::contacts_in_matrix() const {
  return stiffened_ || std::ranges::any_of(kinds_, [](const auto& kind) { return kind->wrench_in_matrix(); });
}

bool RigidBodySystem::has_contacts() const {
  return std::ranges::any_of(
      wrench_, [](const BodyWrench& one) { return one.force != Vec3{} || one.torque != Vec3{}; });
}

bool RigidBodySystem::has_forces_of(const std::vector<BodyWrench>& wrench) const {
  return std::equal(
      wrench_.begin(), wrench_.end(), wrench.begin(), wrench.end(),
      [](const BodyWrench& a, const BodyWrench& b) { return a.force == b.force && a.torque == b.torque; });
}

void RigidBodySystem::differentiate(const SystemInstant& at, const SystemIterate& iterate,
                                    SystemDerivatives& derivatives) {
  derivatives.stiffness.begin();
  derivatives.damping.begin();
  derivatives.tangent_inertia.begin();
  derivatives.reaction.begin();
  derivatives.coupling.clear(), derivatives.loaded = false;
  for (const auto& kind : kinds_) kind->set_tangents(iterate.displacement, poses_);
  for (const auto& element : elements_) {
    element->add_derivatives(poses_, at.time, derivatives.stiffness, derivatives.damping);
  }
  joint_forces_.add_derivatives(poses_, {at.time, at.position, at.velocity, &iterate.multipliers},
                                derivatives);
  for (const auto& kind : kinds_) {
    kind->add_inertial_derivatives(poses_, derivatives);
    kind->add_contact_derivatives(poses_, wrench_, derivatives);
  }
  for (const PairStiffness& pair : pairs_) add_coupling(pair, bodies_, layout_, poses_, derivatives);
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    constraints_[i]->hessian(poses_, &iterate.multipliers[static_cast<std::size_t>(first_row_[i])],
                             derivatives.stiffness);
  }
}

void RigidBodySystem::displace(const std::vector<Real>& start, const std::vector<Real>& displacement,
                               std::vector<Real>& position) const {
  for (const auto& kind : kinds_) kind->displace(start, displacement, position);
  std::copy(start.begin() + layout_.positions(), start.end(), position.begin() + layout_.positions());
}

void RigidBodySystem::pull_back(const std::vector<Real>& displacement, std::vector<Real>& change) const {
  for (const auto& kind : kinds_) kind->pull_back(displacement, change);
}

void RigidBodySystem::add_counted_angles(const Model& model) {
  for (int j = 0; j < static_cast<int>(model.joints.size()); ++j)
    for (const Joint& joint = model.joints[static_cast<std::size_t>(j)];
         const JointCoordinate angle : rotational_coordinates(model, joint))
      counted_.push_back({angle_number(j, angle), joint_angle(joint, j, angle, layout_)});
}

void RigidBodySystem::count_revolutions(const BodyPoses& poses, std::vector<Real>& position) const {
  auto angle = position.begin() + layout_.positions();
  for (const CountedAngle& counted : counted_) *angle++ = counted.angle->value(poses.spatial);
}

void RigidBodySystem::set_poses(const std::vector<Real>& position, const std::vector<Real>& velocity,
                                BodyPoses& poses) const {
  for (const auto& kind : kinds_) kind->set_poses(position, velocity, poses);
  auto angle = position.begin() + layout_.positions();
  for (const CountedAngle& counted : counted_) poses.spatial.set_counted_angle(counted.number, *angle++);
}

SparseTerm RigidBodySystem::inverse_mass() const {
  SparseTerm inverse;
  inverse.begin();
  for (const auto& kind : kinds_) kind->add_inverse_mass(inverse);
  return inverse;
}

BodyPoses RigidBodySystem::start_poses() const {
  std::vector<Real> position(static_cast<std::size_t>(positions())),
      velocity(static_cast<std::size_t>(coordinates()));
  for (const auto& kind : kinds_) kind->start(position, velocity);
  return poses_at({0, position, velocity});
}

BodyPoses RigidBodySystem::poses_at(const SystemInstant& at) const {
  BodyPoses poses(layout_);
  set_poses(at.position, at.velocity, poses);
  return poses;
}

const BodyPoses& RigidBodySystem::passing_poses(const SystemInstant& at) {
  set_poses(at.position, at.velocity, scratch_);
  return scratch_;
}

void RigidBodySystem::velocity_rhs(const SystemInstant& at, std::vector<Real>& rhs) const {
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    constraints_[i]->velocity_rhs(at.time, &rhs[static_cast<std::size_t>(first_row_[i])]);
  }
}

void RigidBodySystem::acceleration_rhs(const SystemInstant& at, std::vector<Real>& rhs) const {
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    constraints_[i]->acceleration_rhs(poses_, at.time, &rhs[static_cast<std::size_t>(first_row_[i])]);
  }
}

std::string RigidBodySystem::coordinate_name(int coordinate) const {
  const std::size_t body = static_cast<std::size_t>(layout_.body_of_column(coordinate));
  return fmt::format("body '{}' (id {})", bodies_[body].name, body);
}

std::string RigidBodySystem::constraint_name(int constraint) const {
  return groups_[static_cast<std::size_t>(group_[static_cast<std::size_t>(constraint)])].title;
}

Powers RigidBodySystem::powers(const SystemInstant& at, const std::vector<Real>& multipliers) {
  Powers powers;
  if (!elements_.empty()) set_poses(at.position, at.velocity, scratch_);
  for (const auto& element : elements_) element->add_powers(scratch_, at.time, powers);
  for (const std::size_t i : drivers_) {
    powers.drivers += constraints_[i]->power(at.time, &multipliers[static_cast<std::size_t>(first_row_[i])]);
  }
  return powers;
}

Real RigidBodySystem::elastic_energy(const SystemInstant& at, const std::vector<Real>& memory) const {
  const BodyPoses poses = poses_at(at);
  Real energy = 0;
  for (const auto& element : elements_) energy += element->elastic_energy(poses);
  return energy + joint_forces_.elastic_energy(poses, at.time, memory);
}

std::vector<RigidBodySystem::GroupReaction> RigidBodySystem::reactions(
    const SystemInstant& at, const std::vector<Real>& memory) const {
  const BodyPoses poses = poses_at(at);
  std::vector<GroupReaction> reactions(groups_.size());
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    for (int i = groups_[k].first; i < groups_[k].end; ++i) {
      const Real* lambda =
          &(*at.multipliers)[static_cast<std::size_t>(first_row_[static_cast<std::size_t>(i)])];
      constraints_[static_cast<std::size_t>(i)]->add_reaction(poses, lambda, reactions[k].force,
                                                              reactions[k].torque);
    }
    reactions[k].frame = groups_[k].marker;
    if (groups_[k].kind == BodyKind::spatial)
      reactions[k].frame = quaternion_of(poses.spatial[groups_[k].body].rotation) * groups_[k].marker;
  }
  add_cylinder_forces(at, memory, poses, reactions);
  return reactions;
}

void RigidBodySystem::add_cylinder_forces(const SystemInstant& at, const std::vector<Real>& memory,
                                          const BodyPoses& poses,
                                          std::vector<GroupReaction>& reactions) const {
  const std::vector<JointForce>& forces = joint_forces_.all();
  const std::vector<JointForce::Sample> samples = joint_forces_.samples(poses, at, memory);
  for (std::size_t i = 0; i < forces.size(); ++i) {
    if (forces[i].cylinder() < 0) continue;
    GroupReaction& sum = reactions[static_cast<std::size_t>(forces[i].cylinder())];
    forces[i].add_reaction(poses, samples[i].effort, sum.force, sum.torque);
  }
}

std::vector<Real> RigidBodySystem::spring_efforts(const SystemInstant& at) const {
  const BodyPoses poses = poses_at(at);
  std::vector<Real> efforts;
  for (std::size_t k = 0; k < springs_; ++k) efforts.push_back(elements_[k]->effort(poses, at.time));
  return efforts;
}

}  // namespace scree
