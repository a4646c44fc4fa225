#include "run/bodies_outside.hpp"

#include "model/body_layout.hpp"
#include "model/space_box.hpp"

namespace scree {

BodiesOutside bodies_outside(const Model& model, const MultibodyState& state) {
  const Box space = open_box(model.space);
  BodiesOutside outside;
  const BodyLayout layout(model.bodies);
  if (state.position.empty()) return outside;
  for (int b = 0; b < layout.bodies(); ++b) {
    const Real* q = &state.position[static_cast<std::size_t>(layout.position(b))];
    const Body& body = model.bodies[static_cast<std::size_t>(b)];
    const Vec3 centre{q[0], q[1], body.kind == BodyKind::spatial ? q[2] : body.position.z};
    if (!space.inside(centre) && ++outside.count == 1) outside.first = static_cast<std::size_t>(b);
  }
  return outside;
}

}  // namespace scree
