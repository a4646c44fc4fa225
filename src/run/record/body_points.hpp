// The points that snapshots show of bodies: shapes and centres of mass.
#pragma once

#include <span>
#include <vector>

#include "dem/backend/reports.hpp"
#include "model/data/body_exchange.hpp"
#include "model/data/model.hpp"
#include "output/snapshot.hpp"

namespace scree {

// One entry per point: shapes with contact detection, then shapes without it, then the centres of mass, each
// group in the deck's order.
struct BodyPoints {
  std::vector<int> body, kind, contacts;        // as in BodySnapshot, like the other members
  std::vector<Real> radius;                     // [m]
  std::vector<Vec3> position, velocity, force;  // [m], [m/s], [N]
  std::vector<Real> angle, angular_velocity;    // of the body [rad], [rad/s]
  std::vector<Vec3> origin;                     // [m]
  std::vector<Real> orientation;                // 4 numbers per point, for spatial bodies only
  std::vector<Vec3> spin;                       // for spatial bodies only [rad/s]

  BodySnapshot view() const;
};

// shapes: those with contact detection; motion and contacts: one entry per parent, bodies first.
BodyPoints body_points(const Model& model, const ShapePack& shapes, std::span<const BodyMotion> motion,
                       std::span<const ContactSum> contacts);

}  // namespace scree
