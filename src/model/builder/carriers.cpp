#include "model/builder/carriers.hpp"

#include <fmt/format.h>

#include <cmath>

namespace scree {

namespace {

// Index of the parent of a wall with a pose: the bodies come first, then these walls.
int parent_of_wall(const Model& model, std::size_t wall) {
  int parent = static_cast<int>(model.bodies.size());
  for (std::size_t w = 0; w < wall; ++w) parent += model.walls[w].has_pose();
  return parent;
}

// Instants are counted in integers, and a floating-point number gives each of them exactly up to this one.
constexpr Real kMostInstants = 1e15;

}  // namespace

int carrier_of(const DeckTable& table, const Model& model, const ModelNames& names) {
  if (!table.has("on")) return kGround;
  const std::string& name = table.text("on");
  for (std::size_t w = 0; w < model.walls.size(); ++w) {
    if (model.walls[w].name != name) continue;
    if (!model.walls[w].has_pose()) table.fail("on", "is a plane at rest: leave the key out");
    return parent_of_wall(model, w);
  }
  return find_name(names.bodies, table, "on", "body");
}

Real fall_interval(const DeckTable& table, const Model& model, Real radius) {
  const Real g = norm(model.gravity);
  if (g == 0) table.fail("interval", "missing; without gravity it must be a number above 0 [s]");
  return std::sqrt(4 * radius / g);
}

Real checked_interval(const DeckTable& table, const Model& model, Real interval) {
  if (interval > 0 && !(model.time.end / interval <= kMostInstants))
    table.fail("interval", fmt::format("must not be below {:.1g} s: there would be more than {:.0g} instants "
                                       "until time.end",
                                       model.time.end / kMostInstants, kMostInstants));
  return interval;
}

}  // namespace scree
