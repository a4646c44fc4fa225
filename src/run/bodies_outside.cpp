#include "run/bodies_outside.hpp"

#include "model/space_box.hpp"

namespace scree {

BodiesOutside bodies_outside(const Model& model, const MultibodyState& state) {
  const Box space = open_box(model.space);
  BodiesOutside outside;
  for (std::size_t b = 0; 3 * b < state.position.size(); ++b) {
    const Vec3 centre{state.position[3 * b], state.position[3 * b + 1], model.bodies[b].position.z};
    if (!space.inside(centre) && ++outside.count == 1) outside.first = b;
  }
  return outside;
}

}  // namespace scree
