#include "dem/body_shapes.hpp"

namespace scree {

BodyShapes::BodyShapes(const Model& model) : rule_(model) {
  GlobalId id = model.particles.totals.count;
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    for (const Shape& shape : model.bodies[b].shapes)
      items_.push_back({static_cast<int>(b), shape.offset, shape.radius, shape.material, id++});
}

}  // namespace scree
