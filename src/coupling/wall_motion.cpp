#include "coupling/wall_motion.hpp"

#include <fmt/format.h>

namespace scree {

WallMotions::WallMotions(const Model& model) {
  for (const Wall& wall : model.walls) {
    if (!wall.has_pose()) continue;
    move_ |= wall.moves(), run_ |= wall.is_conveyor();
    std::vector<Part>& parts = walls_.emplace_back();
    for (const WallMotion& motion : wall.motions)
      parts.push_back(
          {motion, ScalarFunction(motion.coordinate, fmt::format("wall '{}'", wall.name), model.time.end)});
  }
}

void WallMotions::at(Real t, std::span<BodyMotion> out) const {
  for (std::size_t w = 0; w < size(); ++w) {
    out[w] = {};
    out[w].kind = BodyKind::spatial;
    for (const Part& part : walls_[w]) add(part, t, out[w]);
  }
}

// Adds one motion to those of the wall. A point x with velocity v is translated to x + s d with velocity v +
// s' d, or rotated by R about the axis a through c to c + R (x - c) with velocity R v + f' a x (its new arm).
void WallMotions::add(const Part& part, Real t, BodyMotion& motion) {
  const TimeValue now = part.coordinate(t);
  const Real change = now.value - part.coordinate(0).value;
  const Vec3 axis = part.of.axis;
  if (part.of.kind == WallMotionKind::translation) {
    motion.position += change * axis, motion.velocity += now.rate * axis;
    return;
  }
  const Quaternion turn = exponential(change * axis);
  const Vec3 arm = rotated(turn, motion.position - part.of.point);
  motion.position = part.of.point + arm;
  motion.velocity = rotated(turn, motion.velocity) + cross(now.rate * axis, arm);
  motion.orientation = normalized(turn * motion.orientation);
  motion.spin += rotated(conjugate(motion.orientation), now.rate * axis);  // in the parent's frame
}

// Trapezoidal rule, as for the particles' own work.
Real work_between(const BodyMotion& start, const BodyWrench& start_wrench, const BodyMotion& end,
                  const BodyWrench& wrench, Real h) {
  return Real(0.5) * (dot(start_wrench.force + wrench.force, end.position - start.position) +
                      dot(start_wrench.torque + wrench.torque, rotation_between(start, end)) +
                      h * (start_wrench.belt_power + wrench.belt_power));
}

}  // namespace scree
