// The wrench's stiffness and damping against differences of the wrench.
#include <cmath>

#include "model/data/body_exchange.hpp"
#include "random_box.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kStiffness = 1e5, kDamping = 50, kRadius = 0.1;
// So small that the terms missing in the blocks, the rotation of normals and arms under the force, are 1e-6
// of them.
constexpr Real kOverlap = 1e-6 * kRadius;
constexpr Real kGeometric = 1e-5;      // missing terms, and the error of differences, relative
constexpr Real kRoundOff = 64 * kUlp;  // of sums of up to 30 in the unit of their terms

// One body with two shapes, and particles that touch them from several directions.
Model touched_body(int dimension) {
  Model model;
  model.space.dimension = dimension;
  model.space.min = {-2, -2, dimension == 3 ? -2.0 : 0.0},
  model.space.max = {2, 2, dimension == 3 ? 2.0 : 0.0};
  model.contact.material_names = {"material"};
  model.contact.laws = {{kStiffness, kDamping, 1, true}};
  Body body;
  body.position = {0.2, -0.1, 0}, body.angle = 0.4;
  body.shapes = {{{0.5, 0.1, 0}, kRadius, 0}, {{-0.4, 0.2, 0}, kRadius, 0}};
  model.bodies.push_back(body);
  const BodyMotion motion{body.position, {}, body.angle, 0};
  RandomNumbers random(1);
  for (const Shape& shape : body.shapes)
    for (int i = 0; i < 3; ++i) {
      const Real turn = 2.1 * i + random.uniform(0, 1), lift = dimension == 3 ? random.uniform(-0.6, 0.6) : 0;
      const Vec3 direction{std::cos(lift) * std::cos(turn), std::cos(lift) * std::sin(turn), std::sin(lift)};
      const Vec3 centre = point_motion(motion, shape.offset).position;
      model.particles.position.push_back(centre + (2 * kRadius - kOverlap) * direction);
      model.particles.velocity.push_back({});
      model.particles.radius.push_back(kRadius);
      model.particles.mass.push_back(1e9);
      model.particles.material.push_back(0);
    }
  count_particles(model.particles, model.contact.materials());
  return model;
}

// Its shapes against those of another body in the positions of the particles; there are no particles.
Model two_bodies(int dimension) {
  Model model = touched_body(dimension);
  Body other;
  other.position = {0.1, 0.6, 0}, other.angle = -1.1;
  for (const Vec3& place : model.particles.position) {
    const Vec3 arm = place - other.position;
    const Real c = std::cos(other.angle), s = std::sin(other.angle);
    other.shapes.push_back({{c * arm.x + s * arm.y, c * arm.y - s * arm.x, arm.z}, kRadius, 0});
  }
  model.bodies.push_back(other);
  model.particles = {};
  count_particles(model.particles, model.contact.materials());
  return model;
}

// Force and torque of the step's wrench on a body as one row of six.
std::array<Real, 6> wrench_at(LoadedBox& box, ImplicitStep& step, const std::vector<BodyMotion>& motion,
                              ContactWrenches& contacts, std::size_t body = 0) {
  std::vector<BodyWrench> end(motion.size());
  contacts.wrench.resize(motion.size());
  box.backend->list().set_body_motion(motion);
  step.contact_force();
  step.reduce_wrench(contacts, end);
  const BodyWrench& wrench = contacts.wrench[body];
  return {wrench.force.x, wrench.force.y, wrench.force.z, wrench.torque.x, wrench.torque.y, wrench.torque.z};
}

Real block(const std::array<Real, 21>& packed, int i, int j) {
  return packed[static_cast<std::size_t>(i <= j ? packed6(i, j) : packed6(j, i))];
}

// Coordinates of a body that the test changes: x, y, z and the rotation about z.
constexpr int kColumns[] = {0, 1, 2, 5};

BodyMotion moved(BodyMotion motion, int column, Real position, Real velocity) {
  Real* const p[] = {&motion.position.x, &motion.position.y, &motion.position.z};
  Real* const v[] = {&motion.velocity.x, &motion.velocity.y, &motion.velocity.z};
  if (column < 3) *p[column] += position, *v[column] += velocity;
  if (column == 5) motion.angle += position, motion.angular_velocity += velocity;
  return motion;
}

}  // namespace

TEST_CASE("the wrench's blocks are minus its derivatives") {
  for (const int dimension : {2, 3}) {
    LoadedBox box(touched_body(dimension));
    const std::unique_ptr<ImplicitStep> step = predicted_step(*box.backend, 1e-4);
    ContactWrenches contacts, unused;
    wrench_at(box, *step, box.motion, contacts);
    CHECK(contacts.pairs.empty());
    REQUIRE(contacts.stiffness.size() == 1);
    const WrenchStiffness blocks = contacts.stiffness[0];
    for (const int column : kColumns) {
      if (dimension == 2 && column == 2) continue;
      CAPTURE(dimension, column);
      const Real dx = 0.01 * kOverlap, dv = 1e-3;
      const auto up = wrench_at(box, *step, {moved(box.motion[0], column, dx, 0)}, unused);
      const auto down = wrench_at(box, *step, {moved(box.motion[0], column, -dx, 0)}, unused);
      const auto faster = wrench_at(box, *step, {moved(box.motion[0], column, 0, dv)}, unused);
      const auto slower = wrench_at(box, *step, {moved(box.motion[0], column, 0, -dv)}, unused);
      for (int row = 0; row < 6; ++row) {
        const auto r = static_cast<std::size_t>(row);
        CAPTURE(row);
        const Real stiffness = (down[r] - up[r]) / (2 * dx), damping = (slower[r] - faster[r]) / (2 * dv);
        CHECK(near(block(blocks.stiffness, row, column), stiffness, {.absolute = kGeometric * kStiffness}));
        CHECK(near(block(blocks.damping, row, column), damping, {.absolute = kRoundOff * kDamping}));
      }
    }
  }
}

TEST_CASE("the blocks of two bodies that touch are minus the derivatives by each other's motion") {
  for (const int dimension : {2, 3})
    for (const std::size_t moving : {std::size_t{0}, std::size_t{1}}) {
      LoadedBox box(two_bodies(dimension));
      const std::unique_ptr<ImplicitStep> step = predicted_step(*box.backend, 1e-4);
      ContactWrenches contacts, unused;
      wrench_at(box, *step, box.motion, contacts);
      REQUIRE(contacts.pairs.size() == 1);
      const PairStiffness& pair = contacts.pairs[0];
      CHECK((pair.first == 0 && pair.second == 1));
      for (const int column : kColumns) {
        if (dimension == 2 && column == 2) continue;
        CAPTURE(dimension, moving, column);
        const auto wrench = [&](Real position, Real velocity) {
          std::vector<BodyMotion> motion = box.motion;
          motion[moving] = moved(motion[moving], column, position, velocity);
          return wrench_at(box, *step, motion, unused, 1 - moving);
        };
        const Real dx = 0.01 * kOverlap, dv = 1e-3;
        const auto up = wrench(dx, 0), down = wrench(-dx, 0), faster = wrench(0, dv), slower = wrench(0, -dv);
        for (int row = 0; row < 6; ++row) {
          const auto r = static_cast<std::size_t>(row),
                     at = static_cast<std::size_t>(moving == 1 ? 6 * row + column : 6 * column + row);
          CAPTURE(row);
          const Real stiffness = (down[r] - up[r]) / (2 * dx), damping = (slower[r] - faster[r]) / (2 * dv);
          CHECK(near(pair.stiffness[at], stiffness, {.absolute = kGeometric * kStiffness}));
          CHECK(near(pair.damping[at], damping, {.absolute = kRoundOff * kDamping}));
        }
      }
    }
}

}  // namespace scree
