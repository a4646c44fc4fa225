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
    const std::size_t x = static_cast<std::size_t>(system.layout().column(static_cast<int>(b))), y = x + 1,
                      angle = x + 2;
    const bool moves = changed(x) || changed(y), turns = changed(angle);
    if (body.in_row || !(moves || turns)) continue;
    if (++shown > kBodiesShown) {
      ++more;
      continue;
    }
    if (moves)
      add(fmt::format("bodies.{}.velocity = [{}, {}{}]", body.name, number(x), number(y),
                      dimension == 2 ? "" : ", 0.0"));
    if (turns) add(fmt::format("bodies.{}.angular_velocity = {}", body.name, number(angle)));
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
  constexpr const char* kComponents[] = {"x component of the velocity", "y component of the velocity",
                                         "angular velocity"};
  return fmt::format("{} of {} from {} to {} {}", kComponents[largest % 3],
                     system.coordinate_name(static_cast<int>(largest)), all_digits(from[largest]),
                     all_digits(to[largest]), largest % 3 == 2 ? "rad/s" : "m/s");
}

}  // namespace scree
