#include "dem/body_shapes.hpp"

#include <algorithm>

namespace scree {

BodyShapes::BodyShapes(const Model& model) : connected_(model.bodies.size()) {
  GlobalId id = model.particles.totals.count;
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    for (const Shape& shape : model.bodies[b].shapes)
      items_.push_back({static_cast<int>(b), shape.offset, shape.radius, shape.material, id++});

  if (model.contact.connected_bodies_touch) return;
  const auto connect = [&](const int(&body)[2]) {
    if (body[0] == kGround || body[1] == kGround) return;
    connected_[static_cast<std::size_t>(body[0])].push_back(body[1]);
    connected_[static_cast<std::size_t>(body[1])].push_back(body[0]);
  };
  for (const Joint& joint : model.joints) connect(joint.body);
  for (const SpringDamper& spring : model.spring_dampers) connect(spring.body);
  for (const TorsionalSpringDamper& spring : model.torsional_spring_dampers) connect(spring.body);
  for (auto& list : connected_) std::sort(list.begin(), list.end());
}

bool BodyShapes::may_touch(int body_a, int body_b) const {
  if (body_a == body_b) return false;
  const auto& list = connected_[static_cast<std::size_t>(body_a)];
  return !std::binary_search(list.begin(), list.end(), body_b);
}

}  // namespace scree
