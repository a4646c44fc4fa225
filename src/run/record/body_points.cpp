#include "run/record/body_points.hpp"

#include "base/index.hpp"
#include "model/derived/connections.hpp"
#include "partition/subdomain.hpp"

namespace scree {

namespace {

void add_touching(const ShapePack& shapes, BodyPoints& to) {
  to.body = shapes.body, to.radius = shapes.radius;
  to.position = shapes.position, to.velocity = shapes.velocity;
  to.force = shapes.force, to.contacts = shapes.contacts;
  to.kind.assign(shapes.body.size(), kTouchingShape);
}

// Adds a point at an offset in the body's frame, wrapped into the periodic box like the other shapes.
void add_point(const Model& model, int body, BodyPointKind kind, const PointMotion& at, BodyPoints& to) {
  ImageCount unused;
  to.body.push_back(body), to.kind.push_back(kind);
  to.position.push_back(Subdomain(model.space).wrap(at.position, unused));
  to.velocity.push_back(at.velocity);
}

void add_motion(const BodyMotion& motion, const Body& body, bool spatial, BodyPoints& to) {
  to.angle.push_back(motion.angle), to.angular_velocity.push_back(motion.angular_velocity);
  to.origin.push_back(point_motion(motion, -body.center_of_mass).position);
  if (!spatial) return;
  const Quaternion p = orientation(motion);
  to.orientation.insert(to.orientation.end(), {p.w, p.x, p.y, p.z});
  to.spin.push_back(global_spin(motion));
}

}  // namespace

BodySnapshot BodyPoints::view() const {
  return {body,  kind,     radius, position,    velocity, angle, angular_velocity,
          force, contacts, origin, orientation, spin};
}

BodyPoints body_points(const Model& model, const ShapePack& shapes, std::span<const BodyMotion> motion,
                       std::span<const ContactSum> contacts) {
  BodyPoints points;
  add_touching(shapes, points);
  const int bodies = as_index(model.bodies.size());
  for (int b = 0; b < bodies; ++b)
    for (const Shape& shape : model.bodies[as_size(b)].drawn_shapes) {
      add_point(model, b, kDrawnShape, point_motion(motion[as_size(b)], shape.offset), points);
      points.radius.push_back(shape.radius), points.force.push_back({}), points.contacts.push_back(0);
    }
  for (int b = 0; b < bodies; ++b) {
    const ContactSum& sum = contacts[as_size(b)];
    add_point(model, b, kCenterOfMass, point_motion(motion[as_size(b)], {}), points);
    points.radius.push_back(0), points.force.push_back(sum.force);
    points.contacts.push_back(static_cast<int>(sum.contacts));
  }
  const bool spatial = has_spatial_bodies(model);
  for (const int b : points.body) add_motion(motion[as_size(b)], model.bodies[as_size(b)], spatial, points);
  return points;
}

}  // namespace scree
