// What snapshots show of the bodies: their shapes, and where their centres of mass are.
#pragma once

#include <span>
#include <vector>

#include "dem/backend/reports.hpp"
#include "model/data/body_exchange.hpp"
#include "model/data/model.hpp"
#include "output/snapshot.hpp"

namespace scree {

// One entry per point: the shapes that touch something, those that do not, the centres of mass; each in the
// deck's order.
struct BodyPoints {
  std::vector<int> body, kind, contacts;        // as in BodySnapshot, and so are the others
  std::vector<Real> radius;                     // [m]
  std::vector<Vec3> position, velocity, force;  // [m], [m/s], [N]
  std::vector<Real> angle, angular_velocity;    // of the body [rad], [rad/s]
  std::vector<Vec3> origin;                     // [m]
  std::vector<Real> orientation;                // where bodies are spatial: 4 numbers a point
  std::vector<Vec3> spin;                       // likewise [rad/s]

  BodySnapshot view() const;
};

// shapes: those that touch something; motion and contacts: of the carriers, the bodies first.
BodyPoints body_points(const Model& model, const ShapePack& shapes, std::span<const BodyMotion> motion,
                       std::span<const ContactSum> contacts);

}  // namespace scree
