#include "run/record/joint_lines.hpp"

#include "base/index.hpp"
#include "base/mat3.hpp"
#include "model/derived/connections.hpp"

namespace scree {
namespace {

constexpr Real kNoArm = 1e-9;  // a point at most this far from the body's centre coincides with it [m]

bool acts(const TimeFunction& actuator) {
  return actuator.kind != TimeFunctionKind::constant || actuator.value != 0;
}

Vec3 position_of(std::span<const BodyMotion> motion, int body, Vec3 point) {
  return body == kGround ? point : point_motion(motion[as_size(body)], point).position;
}

// Rotation from the bushing's frame on its first body to the global axes.
Mat3 axes_of(const Bushing& bushing, std::span<const BodyMotion> motion) {
  const Mat3 marker = rotation_matrix(bushing.marker[0]);
  if (bushing.body[0] == kGround) return marker;
  return rotation_matrix(orientation(motion[as_size(bushing.body[0])])) * marker;
}

}  // namespace

JointLines::JointLines(const Model& model) : model_(model), subdomain_(model.space) {
  for (const Joint& joint : model.joints)
    points_coincide(joint)
        ? add_pin(joint.name, JointLineKind::joint, joint.body, joint.point)
        : add(joint.name, joint.telescopes ? JointLineKind::actuator : JointLineKind::joint, joint.body,
              joint.point);
  for (const SpringDamper& e : model.spring_dampers)
    add(e.name, acts(e.actuator) ? JointLineKind::actuator : JointLineKind::spring_damper, e.body, e.point);
  for (const TorsionalSpringDamper& e : model.torsional_spring_dampers) {
    int body[2] = {e.body[0], e.body[1]};
    for (int k = 0; k < 2; ++k)
      if (body[k] == kGround) body[k] = body[1 - k];
    add(e.name, JointLineKind::torsional_spring_damper, body, {{}, {}});
  }
  for (const Bushing& e : model.bushings) add_pin(e.name, JointLineKind::bushing, e.body, e.point);
}

void JointLines::add(const std::string& name, JointLineKind kind, const int (&body)[2],
                     const Vec3 (&point)[2]) {
  lines_.push_back({name, kind, {body[0], body[1]}, {point[0], point[1]}});
}

void JointLines::add_pin(const std::string& name, JointLineKind kind, const int (&body)[2],
                         const Vec3 (&point)[2]) {
  const auto has_arm = [&](int k) { return body[k] != kGround && norm(point[k]) > kNoArm; };
  const int to = has_arm(1) || !has_arm(0) ? 1 : 0;
  if (body[to] == kGround) return add(name, kind, body, point);
  add(name, kind, {body[to], body[to]}, {point[to], {}});
}

std::vector<std::string> JointLines::names() const {
  std::vector<std::string> names;
  for (const Line& line : lines_) names.push_back(line.name);
  return names;
}

JointLines::Sample JointLines::sample(const Multibody& multibody, const MultibodyState& state, Real t,
                                      std::span<const BodyMotion> motion) const {
  Sample sample;
  for (std::size_t k = 0; k < lines_.size(); ++k) {
    const Line& line = lines_[k];
    const Vec3 start = position_of(motion, line.body[0], line.point[0]),
               branch = position_of(motion, line.body[1], line.point[1]) - start;
    ImageCount unused;
    const Vec3 inside = subdomain_.wrap(start, unused);
    sample.ends.insert(sample.ends.end(), {inside, inside + branch});
    sample.link.push_back(as_index(k)), sample.kind.push_back(static_cast<int>(line.kind));
    sample.length.push_back(norm(branch));
  }
  add_forces(multibody, state, t, motion, sample);
  return sample;
}

// Appends force, torque and reaction in the order of the lines.
void JointLines::add_forces(const Multibody& multibody, const MultibodyState& state, Real t,
                            std::span<const BodyMotion> motion, Sample& sample) const {
  const auto add = [&sample](Real force, Real torque, Vec3 reaction) {
    sample.force.push_back(force), sample.torque.push_back(torque), sample.reaction.push_back(reaction);
  };
  std::vector<Reaction> reactions;
  if (!model_.joints.empty()) reactions = multibody.reactions(state, t);
  for (std::size_t k = 0; k < model_.joints.size(); ++k) {
    const Vec3 along = sample.ends[2 * k + 1] - sample.ends[2 * k];
    const bool pushes = dot(reactions[k].force, along) > 0;
    const Real size = norm(reactions[k].force);
    add(model_.joints[k].telescopes && pushes ? -size : size, norm(reactions[k].torque), reactions[k].force);
  }
  const std::vector<Real> efforts = multibody.spring_efforts(state, t);
  const std::size_t springs = model_.spring_dampers.size();
  for (std::size_t k = 0; k < efforts.size(); ++k) {
    const std::size_t line = sample.force.size();
    Vec3 along = sample.ends[2 * line + 1] - sample.ends[2 * line];
    if (k < springs && between(model_, model_.spring_dampers[k].body) == BodyKind::planar) along.z = 0;
    k < springs ? add(efforts[k], 0, (-efforts[k] / norm(along)) * along) : add(0, efforts[k], {});
  }
  const std::vector<BushingSample> bushings = multibody.bushings(state, t);
  for (std::size_t k = 0; k < bushings.size(); ++k)
    add(norm(bushings[k].force), norm(bushings[k].torque),
        axes_of(model_.bushings[k], motion) * bushings[k].force);
}

LineSnapshot JointLines::Sample::snapshot() const {
  LineSnapshot out{ends, {}};
  const auto add = [&](const char* name, const DatasetLabel& label, const auto& values) {
    out.fields.push_back(field_of(name, label, values));
  };
  add("link", {"1", "index of the joint or force element in the list of names"}, link);
  add("kind",
      {"1",
       "0 joint, 1 spring-damper, 2 cylinder or spring-damper with an actuator, 3 bushing, 4 torsional "
       "spring-damper"},
      kind);
  add("force",
      {"N", "magnitude of the reaction (joint) or force (bushing); tensile force (spring-damper, cylinder)"},
      force);
  add("torque",
      {"N m",
       "magnitude of the torque of a joint or bushing; for a torsional spring-damper the torque on its "
       "second body"},
      torque);
  add("length", {"m", "length of the line; for spring-dampers and cylinders the distance of their points"},
      length);
  add("reaction", {"N", "force on the second body, global axes"}, reaction);
  return out;
}

}  // namespace scree
