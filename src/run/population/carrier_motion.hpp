// Motion of the regions of inserters and outlets with the body or wall that carries them.
#pragma once

#include <span>

#include "base/mat3.hpp"
#include "model/data/body_exchange.hpp"
#include "model/data/model.hpp"

namespace scree {

// The rigid motion of a carrier since t = 0; none for the ground.
class CarrierMotion {
 public:
  // carrier: of an Inserter or Outlet; motion: of the bodies, then of the walls with a pose.
  CarrierMotion(const Model& model, int carrier, std::span<const BodyMotion> motion);

  // Where a point of the region at t = 0 is now [m].
  Vec3 point(Vec3 at_start) const { return now_.position + rotation_ * (at_start - start_); }
  Vec3 direction(Vec3 at_start) const { return rotation_ * at_start; }
  // Velocity of the point of the carrier that is at p now [m/s].
  Vec3 velocity(Vec3 p) const { return now_.velocity + cross(global_spin(now_), p - now_.position); }

 private:
  BodyMotion now_;
  Vec3 start_;  // position at t = 0 [m]
  Mat3 rotation_ = identity3();
};

}  // namespace scree
