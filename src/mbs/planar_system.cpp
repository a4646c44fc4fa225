#include "mbs/planar_system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/error.hpp"
#include "model/connections.hpp"

namespace scree {

namespace {

// Positions of size 1 carry round-off of 1e-16; a force of stiffness times 1e-6 of the length scale stays far
// above it, and a residual of 1e-8 of that force moves a body by 1e-14 of the length scale.
constexpr Real kElasticFloor = 1e-6;

// The planar part (x, y, rz) of a packed 6x6 block.
constexpr int kPlanarRows[3] = {0, 1, 5};

std::array<Real, 9> planar_block(const std::array<Real, 21>& packed) {
  std::array<Real, 9> block;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const int row = kPlanarRows[std::min(i, j)], column = kPlanarRows[std::max(i, j)];
      block[static_cast<std::size_t>(3 * i + j)] = packed[static_cast<std::size_t>(packed6(row, column))];
    }
  }
  return block;
}

Real characteristic_length(const Model& model) {
  Real radius = 0, reach = 0;
  for (const Body& body : model.bodies) {
    for (const Shape& shape : body.shapes) radius = std::max(radius, shape.radius);
  }
  const auto add_point = [&](int body, Vec3 point) {
    if (body != kGround) reach = std::max(reach, norm(planar(point)));
  };
  for (int i = 0; i < 2; ++i) {
    for (const Joint& joint : model.joints) add_point(joint.body[i], joint.point[i]);
    for (const SpringDamper& element : model.spring_dampers) add_point(element.body[i], element.point[i]);
  }
  for (const AppliedForce& element : model.applied_forces) add_point(element.body, element.point);
  return radius > 0 ? radius : reach > 0 ? reach : 1;
}

PointPair point_pair(const Joint& joint) {
  return {{joint.body[0], joint.body[1]}, {planar(joint.point[0]), planar(joint.point[1])}};
}

}  // namespace

PlanarSystem::PlanarSystem(const Model& model)
    : bodies_(model.bodies),
      gravity_(model.gravity),
      length_scale_(characteristic_length(model)),
      motion_(static_cast<int>(model.bodies.size())),
      scratch_(static_cast<int>(model.bodies.size())),
      wrench_(model.bodies.size()),
      contact_(model.bodies.size()) {
  for (const Body& body : bodies_) {
    coordinate_scale_.insert(coordinate_scale_.end(), {length_scale_, length_scale_, 1});
    weight_.insert(weight_.end(), {body.mass * gravity_.x, body.mass * gravity_.y, 0});
    constant_force_scale_ =
        std::max(constant_force_scale_, length_scale_ * body.mass * norm(planar(gravity_)));
  }
  const std::vector<bool> driven = driven_joints(model);
  for (std::size_t i = 0; i < model.joints.size(); ++i) add_joint(model.joints[i], driven[i]);
  for (const Driver& driver : model.drivers) {
    add_driver(driver, model.joints[static_cast<std::size_t>(driver.joint)], model.time.end);
  }
  for (const SpringDamper& e : model.spring_dampers) {
    elements_.push_back(make_force_element(e, model.time.end));
  }
  for (const TorsionalSpringDamper& e : model.torsional_spring_dampers) {
    elements_.push_back(make_force_element(e));
  }
  for (const AppliedForce& e : model.applied_forces) {
    elements_.push_back(make_force_element(e, model.time.end));
  }
  for (const auto& element : elements_) {
    constant_force_scale_ =
        std::max(constant_force_scale_, kElasticFloor * element->elastic_scale(length_scale_));
  }
}

// Revolute: the points coincide. Fixed: and the angle. Translational: body 2's point has no displacement
// across the axis, and the angle. Distance: the length, unless a driver prescribes it.
void PlanarSystem::add_joint(const Joint& joint, bool driven) {
  const PointPair pair = point_pair(joint);
  std::vector<std::unique_ptr<Constraint>> parts;
  switch (joint.kind) {
    case JointKind::revolute:
      parts.push_back(coincidence_constraint(pair));
      break;
    case JointKind::fixed:
      parts.push_back(coincidence_constraint(pair));
      parts.push_back(angle_constraint(joint.body, ScalarFunction(joint.angle_offset)));
      break;
    case JointKind::translational:
      parts.push_back(axis_constraint(pair, perp(planar(joint.axis)), ScalarFunction(0)));
      parts.push_back(angle_constraint(joint.body, ScalarFunction(joint.angle_offset)));
      break;
    case JointKind::distance:
      if (!(joint.distance > 0)) {
        throw InputError(fmt::format("joint '{}': distance {} m is not allowed, it must be positive",
                                     joint.name, joint.distance));
      }
      if (!driven) parts.push_back(length_constraint(pair, ScalarFunction(joint.distance)));
      break;
  }
  add_group(fmt::format("joint '{}'", joint.name), joint.name, std::move(parts));
}

void PlanarSystem::add_driver(const Driver& driver, const Joint& joint, Real end) {
  const std::string title = fmt::format("driver '{}'", driver.name);
  const ScalarFunction motion(driver.motion, title, end);
  std::vector<std::unique_ptr<Constraint>> parts;
  switch (joint.kind) {
    case JointKind::revolute:
      parts.push_back(angle_constraint(joint.body, motion));
      break;
    case JointKind::translational:
      parts.push_back(axis_constraint(point_pair(joint), planar(joint.axis), motion));
      break;
    case JointKind::distance:
      parts.push_back(length_constraint(point_pair(joint), motion));
      break;
    case JointKind::fixed:
      throw InputError(
          fmt::format("{}: joint '{}' is fixed and has nothing to drive; allowed are revolute, "
                      "translational and distance joints",
                      title, joint.name));
  }
  add_group(title, driver.name, std::move(parts));
}

void PlanarSystem::add_group(const std::string& title, const std::string& name,
                             std::vector<std::unique_ptr<Constraint>> parts) {
  ConstraintGroup group{title, name, static_cast<int>(constraints_.size()), 0, constraints(), 0};
  for (std::unique_ptr<Constraint>& part : parts) {
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

void PlanarSystem::evaluate(const SystemInstant& at, SystemTerms& terms) {
  motion_.set(at.position, at.velocity);
  if (terms.mass.size() == 0) add_mass(terms.mass);  // it is constant
  terms.applied_force = weight_;
  terms.force_scale = constant_force_scale_;
  for (const auto& element : elements_) {
    const Real size = element->add_force(motion_, at.time, length_scale_, terms.applied_force);
    terms.force_scale = std::max(terms.force_scale, size);
  }
  add_contact(terms);
  terms.constraint_jacobian.begin();
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    constraints_[i]->value(motion_, at.time, &terms.constraint[static_cast<std::size_t>(first_row_[i])]);
    constraints_[i]->jacobian(motion_, first_row_[i], terms.constraint_jacobian);
  }
}

void PlanarSystem::set_contacts(const ContactWrenches& contacts) {
  wrench_ = contacts.wrench;
  for (const int body : touched_) contact_[static_cast<std::size_t>(body)] = {};
  touched_.clear();
  for (const WrenchStiffness& one : contacts.stiffness) {
    contact_[static_cast<std::size_t>(one.body)] = {planar_block(one.stiffness), planar_block(one.damping)};
    touched_.push_back(one.body);
  }
}

void PlanarSystem::add_mass(SparseTerm& mass) const {
  mass.begin();
  for (int b = 0; b < static_cast<int>(bodies_.size()); ++b) {
    const Body& body = bodies_[static_cast<std::size_t>(b)];
    mass.add(3 * b, 3 * b, body.mass);
    mass.add(3 * b + 1, 3 * b + 1, body.mass);
    mass.add(3 * b + 2, 3 * b + 2, body.inertia);
  }
}

bool PlanarSystem::has_forces_of(const std::vector<BodyWrench>& wrench) const {
  return std::equal(
      wrench_.begin(), wrench_.end(), wrench.begin(), wrench.end(),
      [](const BodyWrench& a, const BodyWrench& b) { return a.force == b.force && a.torque == b.torque; });
}

void PlanarSystem::add_contact(SystemTerms& terms) const {
  for (std::size_t b = 0; b < wrench_.size(); ++b) {
    const BodyWrench& wrench = wrench_[b];
    Real* force = &terms.applied_force[3 * b];
    force[0] += wrench.force.x;
    force[1] += wrench.force.y;
    force[2] += wrench.torque.z;
    const std::array<Real, 9>& block = contact_[b].stiffness;
    const Real stiffness = std::max(block[0], block[4]);
    const Real size = length_scale_ * std::max(norm(wrench.force), kElasticFloor * stiffness * length_scale_);
    terms.force_scale = std::max(terms.force_scale, size);
  }
}

void PlanarSystem::differentiate(const SystemInstant& at, const std::vector<Real>&,
                                 const std::vector<Real>& multipliers, SystemDerivatives& derivatives) {
  derivatives.stiffness.begin();
  derivatives.damping.begin();
  for (const auto& element : elements_) {
    element->add_derivatives(motion_, at.time, derivatives.stiffness, derivatives.damping);
  }
  add_contact_blocks(derivatives);
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    constraints_[i]->hessian(motion_, &multipliers[static_cast<std::size_t>(first_row_[i])],
                             derivatives.stiffness);
  }
}

void PlanarSystem::add_contact_blocks(SystemDerivatives& derivatives) const {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (bodies_[b].shapes.empty()) continue;
    const int first = static_cast<int>(3 * b), coordinate[3] = {first, first + 1, first + 2};
    const ContactBlock& block = contact_[b];
    derivatives.stiffness.add_block(coordinate,
                                    [&](std::size_t i, std::size_t j) { return block.stiffness[3 * i + j]; });
    derivatives.damping.add_block(coordinate,
                                  [&](std::size_t i, std::size_t j) { return block.damping[3 * i + j]; });
  }
}

void PlanarSystem::velocity_rhs(const SystemInstant& at, std::vector<Real>& rhs) const {
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    constraints_[i]->velocity_rhs(at.time, &rhs[static_cast<std::size_t>(first_row_[i])]);
  }
}

void PlanarSystem::acceleration_rhs(const SystemInstant& at, std::vector<Real>& rhs) const {
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    constraints_[i]->acceleration_rhs(motion_, at.time, &rhs[static_cast<std::size_t>(first_row_[i])]);
  }
}

std::string PlanarSystem::coordinate_name(int coordinate) const {
  const std::size_t body = static_cast<std::size_t>(coordinate / 3);
  return fmt::format("body '{}' (id {})", bodies_[body].name, body);
}

std::string PlanarSystem::constraint_name(int constraint) const {
  return groups_[static_cast<std::size_t>(group_[static_cast<std::size_t>(constraint)])].title;
}

Powers PlanarSystem::powers(const SystemInstant& at, const std::vector<Real>& multipliers) {
  scratch_.set(at.position, at.velocity);
  Powers powers;
  for (const auto& element : elements_) element->add_powers(scratch_, at.time, powers);
  for (std::size_t i = 0; i < constraints_.size(); ++i) {
    powers.drivers += constraints_[i]->power(at.time, &multipliers[static_cast<std::size_t>(first_row_[i])]);
  }
  return powers;
}

Real PlanarSystem::elastic_energy(const SystemInstant& at) const {
  PlanarMotion motion(static_cast<int>(bodies_.size()));
  motion.set(at.position, at.velocity);
  Real energy = 0;
  for (const auto& element : elements_) energy += element->elastic_energy(motion);
  return energy;
}

std::vector<PlanarSystem::GroupReaction> PlanarSystem::reactions(const SystemInstant& at,
                                                                 const std::vector<Real>& multipliers) const {
  PlanarMotion motion(static_cast<int>(bodies_.size()));
  motion.set(at.position, at.velocity);
  std::vector<GroupReaction> reactions(groups_.size());
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    for (int i = groups_[k].first; i < groups_[k].end; ++i) {
      const Real* lambda = &multipliers[static_cast<std::size_t>(first_row_[static_cast<std::size_t>(i)])];
      constraints_[static_cast<std::size_t>(i)]->add_reaction(motion, lambda, reactions[k].force,
                                                              reactions[k].torque);
    }
  }
  return reactions;
}

}  // namespace scree
