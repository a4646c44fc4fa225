// Bodies that joints and force elements connect, hold or prescribe.
#include <algorithm>
#include <array>

#include "model/derived/connections.hpp"

namespace scree {

std::vector<std::pair<int, int>> connected_bodies(const Model& model) {
  std::vector<std::pair<int, int>> pairs;
  const auto add = [&](const int(&body)[2]) {
    if (body[0] != kGround && body[1] != kGround) pairs.emplace_back(std::minmax(body[0], body[1]));
  };
  for (const Joint& joint : model.joints) add(joint.body);
  for (const SpringDamper& element : model.spring_dampers) add(element.body);
  for (const TorsionalSpringDamper& element : model.torsional_spring_dampers) add(element.body);
  for (const Bushing& element : model.bushings) add(element.body);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

namespace {

// Whether each body is connected to the ground through these pairs.
std::vector<bool> reached_from_ground(const Model& model, const std::vector<std::array<int, 2>>& links) {
  std::vector<bool> held(model.bodies.size());
  const auto is_held = [&](int body) { return body == kGround || held[static_cast<std::size_t>(body)]; };
  for (bool found = true; found;) {
    found = false;
    for (const std::array<int, 2>& link : links) {
      if (is_held(link[0]) == is_held(link[1])) continue;
      held[static_cast<std::size_t>(is_held(link[0]) ? link[1] : link[0])] = found = true;
    }
  }
  return held;
}

}  // namespace

// A torsional spring does not hold a body's position.
std::vector<bool> held_bodies(const Model& model) {
  std::vector<std::array<int, 2>> links;
  const auto add = [&](const auto& elements) {
    for (const auto& element : elements) links.push_back({element.body[0], element.body[1]});
  };
  add(model.joints), add(model.spring_dampers), add(model.bushings);
  return reached_from_ground(model, links);
}

std::vector<bool> prescribed_bodies(const Model& model) {
  const auto prescribes = [&](std::size_t j) {
    const JointKind kind = model.joints[j].kind;
    if (kind == JointKind::fixed) return true;
    const bool one_coordinate = kind == JointKind::revolute || kind == JointKind::translational;
    return one_coordinate && std::ranges::any_of(model.drivers, [&](const Driver& driver) {
             return driver.joint == static_cast<int>(j);
           });
  };
  std::vector<std::array<int, 2>> links;
  for (std::size_t j = 0; j < model.joints.size(); ++j)
    if (prescribes(j)) links.push_back({model.joints[j].body[0], model.joints[j].body[1]});
  return reached_from_ground(model, links);
}

}  // namespace scree
