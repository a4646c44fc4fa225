// The wrench's stiffness and damping against differences of the wrench.
#include <cmath>

#include "model/body_exchange.hpp"
#include "random_box.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kStiffness = 1e5, kDamping = 50, kRadius = 0.1;
// So small that what the blocks leave out, the turning of normals and arms under the force, is 1e-6 of them.
constexpr Real kOverlap = 1e-6 * kRadius;
constexpr Real kGeometric = 1e-5;      // that, and the differences' error, relative
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

// Force and torque of the step's wrench as one row of six.
std::array<Real, 6> wrench_at(LoadedBox& box, ImplicitStep& step, const BodyMotion& motion,
                              ContactWrenches& contacts) {
  std::vector<BodyWrench> end(1);
  contacts.wrench.resize(1);
  box.backend->list().place_bodies(std::vector<BodyMotion>{motion});
  step.contact_force();
  step.reduce_wrench(contacts, end);
  const BodyWrench& wrench = contacts.wrench[0];
  return {wrench.force.x, wrench.force.y, wrench.force.z, wrench.torque.x, wrench.torque.y, wrench.torque.z};
}

Real block(const std::array<Real, 21>& packed, int i, int j) {
  return packed[static_cast<std::size_t>(i <= j ? packed6(i, j) : packed6(j, i))];
}

// The coordinates of a body that its motion can change: x, y, z and the turn about z.
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
    wrench_at(box, *step, box.motion[0], contacts);
    REQUIRE(contacts.stiffness.size() == 1);
    const WrenchStiffness blocks = contacts.stiffness[0];
    for (const int column : kColumns) {
      if (dimension == 2 && column == 2) continue;
      CAPTURE(dimension, column);
      const Real dx = 0.01 * kOverlap, dv = 1e-3;
      const auto up = wrench_at(box, *step, moved(box.motion[0], column, dx, 0), unused);
      const auto down = wrench_at(box, *step, moved(box.motion[0], column, -dx, 0), unused);
      const auto faster = wrench_at(box, *step, moved(box.motion[0], column, 0, dv), unused);
      const auto slower = wrench_at(box, *step, moved(box.motion[0], column, 0, -dv), unused);
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

}  // namespace scree
