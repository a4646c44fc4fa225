#include "mbs/joint_forces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "mbs/joint_coordinate.hpp"
#include "model/derived/connections.hpp"

namespace scree {

JointForces::JointForces(const Model& model, const BodyLayout& layout, const BodyPoses& start,
                         const std::vector<std::vector<int>>& load_rows) {
  // make_law(c at t = 0) makes the law of `element`.
  const auto add = [&](const char* kind, const auto& element, const auto& make_law) {
    const Joint& joint = model.joints[static_cast<std::size_t>(element.joint)];
    const std::string title = fmt::format("{} '{}'", kind, element.name);
    std::unique_ptr<Constraint> coordinate =
        joint_coordinate(title, model, element.joint, element.coordinate, layout);
    Real c = 0;
    coordinate->value(start, 0, &c);
    forces_.emplace_back(element.name, std::move(coordinate), make_law(c));
    if (forces_.back().is_loaded())
      forces_.back().is_loaded_by(load_rows[static_cast<std::size_t>(element.joint)]);
    if (joint.telescopes) forces_.back().acts_along_cylinder(element.joint);
    for (const int body : joint.body) {
      if (is_spatial(model, body)) forces_.back().rotates_in_space(body, layout.column(body) + 3);
    }
  };
  for (const Motor& e : model.motors)
    add("motor", e, [&](Real) { return make_joint_law(e, model.time.end); });
  for (const JointSpring& e : model.joint_springs)
    add("joint spring", e, [&](Real c) { return make_joint_law(e, c); });
  for (const JointLimit& e : model.joint_limits)
    add("joint limit", e, [&](Real) { return make_joint_law(e, model.integrator.resolve_events); });
  for (const JointFriction& e : model.joint_frictions)
    add("joint friction", e, [&](Real) { return make_joint_law(e); });
}

bool JointForces::are_loaded() const {
  return std::ranges::any_of(forces_, [](const JointForce& force) { return force.is_loaded(); });
}

void JointForces::open_step(const BodyPoses& poses, const SystemInstant& at, Real h,
                            const std::vector<Real>& memory) {
  auto next = memory.begin();
  for (JointForce& force : forces_) force.open_step(poses, at, h, force.has_memory() ? *next++ : 0);
}

bool JointForces::end_step() {
  bool differs = false;
  for (JointForce& force : forces_) {
    force.end_step();
    differs = differs || force.resolves_events() || force.has_memory();
  }
  return differs;
}

Real JointForces::add_force(const BodyPoses& poses, const SystemInstant& at, Real length,
                            std::vector<Real>& force) {
  Real largest = 0;
  for (JointForce& one : forces_) largest = std::max(largest, one.add_force(poses, at, length, force));
  return largest;
}

void JointForces::add_derivatives(const BodyPoses& poses, const SystemInstant& at,
                                  SystemDerivatives& derivatives) {
  for (JointForce& force : forces_) force.add_derivatives(poses, at, derivatives);
}

Real JointForces::elastic_energy(const BodyPoses& poses, Real t, const std::vector<Real>& memory) const {
  Real energy = 0;
  auto next = memory.begin();
  for (const JointForce& force : forces_)
    energy += force.elastic_energy(poses, t, force.has_memory() ? *next++ : 0);
  return energy;
}

Real JointForces::elastic_scale(Real length) const {
  Real largest = 0;
  for (const JointForce& force : forces_) largest = std::max(largest, force.elastic_scale(length));
  return largest;
}

JointWork JointForces::work() const {
  JointWork sum;
  for (const JointForce& force : forces_) {
    const JointWork one = force.work();
    sum.dissipated += one.dissipated, sum.applied += one.applied;
  }
  return sum;
}

std::vector<Real> JointForces::memory() const {
  std::vector<Real> memory;
  for (const JointForce& force : forces_)
    if (force.has_memory()) memory.push_back(force.memory());
  return memory;
}

std::vector<JointForce::Sample> JointForces::samples(const BodyPoses& poses, const SystemInstant& at,
                                                     const std::vector<Real>& memory) const {
  std::vector<JointForce::Sample> samples;
  auto next = memory.begin();
  for (const JointForce& force : forces_)
    samples.push_back(force.sample(poses, at, force.has_memory() ? *next++ : 0));
  return samples;
}

}  // namespace scree
