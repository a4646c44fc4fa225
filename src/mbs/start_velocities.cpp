#include "mbs/start_velocities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

constexpr Real kChanged = 1e-10;  // of the largest velocity plus the coordinate's scale per second
constexpr Real kZero = 1e-14;     // the same: round-off of a velocity that is 0
constexpr std::size_t kBodiesShown = 8;

// As a TOML float that reads back to the same bits.
std::string all_digits(Real value) {
  const std::string text = fmt::format("{:.17g}", value);
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

}  // namespace

std::string keys_to_set(const RigidBodySystem& system, const std::vector<Real>& from,
                        const std::vector<Real>& to, int dimension) {
  const Real scale = velocity_scale(system, to);
  const auto limit = [&](std::size_t i, Real share) { return share * scale * system.coordinate_scale()[i]; };
  const auto changed = [&](std::size_t i) { return std::abs(to[i] - from[i]) > limit(i, kChanged); };
  const auto number = [&](std::size_t i) {
    return all_digits(std::abs(to[i]) > limit(i, kZero) ? to[i] : 0);
  };
  std::string text;
  const auto add = [&](const std::string& setting) { text += (text.empty() ? "" : ", ") + setting; };
  std::size_t shown = 0, more = 0;
  for (std::size_t b = 0; b < system.bodies().size(); ++b) {
    const Body& body = system.bodies()[b];
    const bool spatial = body.kind == BodyKind::spatial;
    const std::size_t x = static_cast<std::size_t>(system.layout().column(static_cast<int>(b))),
                      turn = x + (spatial ? 3 : 2);
    const bool moves = changed(x) || changed(x + 1) || (spatial && changed(x + 2));
    const bool turns = changed(turn) || (spatial && (changed(turn + 1) || changed(turn + 2)));
    if (body.in_row || !(moves || turns)) continue;
    if (++shown > kBodiesShown) {
      ++more;
      continue;
    }
    const std::string third = dimension == 2 ? "" : spatial ? ", " + number(x + 2) : ", 0.0";
    if (moves)
      add(fmt::format("bodies.{}.velocity = [{}, {}{}]", body.name, number(x), number(x + 1), third));
    if (turns && spatial)
      add(fmt::format("bodies.{}.body_angular_velocity = [{}, {}, {}]", body.name, number(turn),
                      number(turn + 1), number(turn + 2)));
    else if (turns)
      add(fmt::format("bodies.{}.angular_velocity = {}", body.name, number(turn)));
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
  const bool turns = within >= (spatial ? 3 : 2);
  const std::string what = turns && !spatial ? "angular velocity"
                                             : fmt::format("{} component of the {}velocity",
                                                           "xyz"[within % 3], turns ? "angular " : "");
  return fmt::format("{} of {} from {} to {} {}", what, system.coordinate_name(column),
                     all_digits(from[largest]), all_digits(to[largest]), turns ? "rad/s" : "m/s");
}

}  // namespace scree
