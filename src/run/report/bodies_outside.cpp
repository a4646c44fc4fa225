#include "run/report/bodies_outside.hpp"

#include <fmt/format.h>

#include "base/index.hpp"
#include "model/data/body_layout.hpp"
#include "model/derived/space_box.hpp"

namespace scree {

BodiesOutside bodies_outside(const Model& model, const MultibodyState& state) {
  const Box space = open_box(model.space);
  BodiesOutside outside;
  const BodyLayout layout(model.bodies);
  if (state.position.empty()) return outside;
  for (int b = 0; b < layout.bodies(); ++b) {
    const Real* q = &state.position[as_size(layout.position(b))];
    const Body& body = model.bodies[as_size(b)];
    const Vec3 centre{q[0], q[1], body.kind == BodyKind::spatial ? q[2] : body.position.z};
    if (!space.inside(centre) && ++outside.count == 1) outside.first = as_size(b);
  }
  return outside;
}

std::string bodies_outside_warning(const Model& model, const MultibodyState& state, Real t) {
  const BodiesOutside outside = bodies_outside(model, state);
  if (outside.count == 0) return "";
  return fmt::format(
      "body \"{}\" is outside the domain at t = {:.6g} s: a body that leaves is counted, but neither stopped "
      "nor removed",
      model.bodies[outside.first].name, t);
}

}  // namespace scree
