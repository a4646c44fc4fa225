#include "run/population/carrier_motion.hpp"

#include "base/index.hpp"

namespace scree {
namespace {

BodyMotion start_of_carrier(const Model& model, int carrier) {
  if (carrier < std::ssize(model.bodies)) return start_motion(model.bodies[as_size(carrier)]);
  auto number = as_size(carrier) - model.bodies.size();
  for (const Wall& wall : model.walls)
    if (wall.has_pose() && number-- == 0) {
      BodyMotion motion;
      motion.position = wall.point, motion.kind = BodyKind::spatial;
      return motion;
    }
  return {};
}

}  // namespace

CarrierMotion::CarrierMotion(const Model& model, int carrier, std::span<const BodyMotion> motion) {
  if (carrier == kGround) return;
  const BodyMotion start = start_of_carrier(model, carrier);
  now_ = motion[as_size(carrier)], start_ = start.position;
  rotation_ = rotation_matrix(orientation(now_) * conjugate(orientation(start)));
}

}  // namespace scree
