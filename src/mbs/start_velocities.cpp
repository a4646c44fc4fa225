#include "mbs/start_velocities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/mat3.hpp"
#include "model/data/body_exchange.hpp"

namespace scree {

namespace {

constexpr Real kChanged = 1e-10;  // of the largest velocity plus the coordinate's scale per second
constexpr Real kZero = 1e-14;     // of the same scale: round-off of a velocity that is 0
constexpr std::size_t kBodiesShown = 8;

// The shortest TOML float that reads back to the same bits.
std::string all_digits(Real value) {
  const std::string text = fmt::format("{}", value);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

// Largest of the velocities, over the scales of their coordinates, plus 1 [1/s].
Real velocity_scale(const RigidBodySystem& system, const std::vector<Real>& velocity) {
  Real fastest = 0;
  for (std::size_t i = 0; i < velocity.size(); ++i) {
    fastest = std::max(fastest, std::abs(velocity[i]) / system.coordinate_scale()[i]);
  }
  return 1 + fastest;
}

// Velocity of the origin of the body's frame at t = 0, as a deck gives it [m/s]. v: the body's velocities.
Vec3 origin_velocity(const Body& body, const Real* v) {
  BodyMotion motion = start_motion(body);
  if (body.kind == BodyKind::spatial)
    motion.velocity = {v[0], v[1], v[2]}, motion.spin = {v[3], v[4], v[5]};
  else
    motion.velocity = {v[0], v[1], 0}, motion.angular_velocity = v[2];
  return point_motion(motion, -body.center_of_mass).velocity;
}

}  // namespace

std::string keys_to_set(const RigidBodySystem& system, const std::vector<Real>& from,
                        const std::vector<Real>& to, int dimension) {
  const Real scale = velocity_scale(system, to);
  const auto limit = [&](std::size_t i, Real share) { return share * scale * system.coordinate_scale()[i]; };
  const auto changed = [&](std::size_t i) { return std::abs(to[i] - from[i]) > limit(i, kChanged); };
  // A velocity comparable to that of column i, as text.
  const auto number = [&](Real value, std::size_t i) {
    return all_digits(std::abs(value) > limit(i, kZero) ? value : 0);
  };
  std::string text;
  const auto add = [&](const std::string& setting) { text += (text.empty() ? "" : ", ") + setting; };
  std::size_t shown = 0, more = 0;
  for (std::size_t b = 0; b < system.bodies().size(); ++b) {
    const Body& body = system.bodies()[b];
    const bool spatial = body.kind == BodyKind::spatial;
    const std::size_t x = static_cast<std::size_t>(system.layout().column(static_cast<int>(b))),
                      rotation_column = x + (spatial ? 3 : 2);
    const Vec3 before = origin_velocity(body, &from[x]), after = origin_velocity(body, &to[x]);
    const auto differs = [&](int k) {
      return std::abs(component(after, k) - component(before, k)) > limit(x, kChanged);
    };
    const bool moves = differs(0) || differs(1) || differs(2);
    const bool is_rotation = changed(rotation_column) ||
                             (spatial && (changed(rotation_column + 1) || changed(rotation_column + 2)));
    if (body.in_row || !(moves || is_rotation)) continue;
    if (++shown > kBodiesShown) {
      ++more;
      continue;
    }
    const auto along = [&](int k) { return number(component(after, k), x); };
    if (moves)
      add(fmt::format("bodies.{}.velocity = [{}, {}{}]", body.name, along(0), along(1),
                      dimension == 2 ? "" : ", " + along(2)));
    if (is_rotation && spatial)
      add(fmt::format("bodies.{}.body_angular_velocity = [{}, {}, {}]", body.name,
                      number(to[rotation_column], rotation_column),
                      number(to[rotation_column + 1], rotation_column + 1),
                      number(to[rotation_column + 2], rotation_column + 2)));
    else if (is_rotation)
      add(fmt::format("bodies.{}.angular_velocity = {}", body.name,
                      number(to[rotation_column], rotation_column)));
  }
  if (more > 0) text += fmt::format(" and the same for {} more", more);
  return text;
}

std::string largest_change(const RigidBodySystem& system, const std::vector<Real>& from,
                           const std::vector<Real>& to) {
  std::size_t largest = 0;
  const auto size = [&](std::size_t i) { return std::abs(to[i] - from[i]) / system.coordinate_scale()[i]; };
  for (std::size_t i = 0; i < to.size(); ++i) {
    if (size(i) > size(largest)) largest = i;
  }
  if (to.empty() || size(largest) == 0) return "";
  const int column = static_cast<int>(largest), body = system.layout().body_of_column(column);
  const std::size_t within = static_cast<std::size_t>(column - system.layout().column(body));
  const bool spatial = system.bodies()[static_cast<std::size_t>(body)].kind == BodyKind::spatial;
  const bool is_rotation = within >= (spatial ? 3 : 2);
  const std::string what =
      is_rotation && !spatial
          ? "angular velocity"
          : fmt::format("{} component of the {}velocity", "xyz"[within % 3], is_rotation ? "angular " : "");
  return fmt::format("{} of {} from {} to {} {}", what, system.coordinate_name(column),
                     all_digits(from[largest]), all_digits(to[largest]), is_rotation ? "rad/s" : "m/s");
}

}  // namespace scree
