// Conditions that end the run, and regions whose particles the history counts.
#include <fmt/format.h>

#include <array>
#include <string>
#include <utility>

#include "model/builder/build_parts.hpp"

namespace scree {

namespace {

constexpr std::array kBounds = {std::pair("above", StopKind::above), std::pair("below", StopKind::below),
                                std::pair("within", StopKind::steady)};

void take_bound(const DeckTable& table, StopCondition& condition) {
  const char* given = nullptr;
  for (const auto& [key, kind] : kBounds) {
    if (!table.has(key)) continue;
    if (given != nullptr)
      table.fail(key, fmt::format("a condition has one of the keys above, below and within; {} is given, too",
                                  given));
    given = key, condition.kind = kind, condition.bound = table.real(key);
  }
  if (given == nullptr)
    table.fail("above", "missing; a condition needs one of the keys above, below and within");
}

RegionBounds bounds_of(const DeckTable& table, const Space& space) {
  RegionBounds bounds;
  bounds.kind = table.choice<RegionKind>("kind");
  if (bounds.kind == RegionKind::box) {
    bounds.min = table.vector("min"), bounds.max = table.vector("max");
    const Vec3 extent = bounds.max - bounds.min;
    if (!(extent.x > 0) || !(extent.y > 0) || (space.dimension == 3 && !(extent.z > 0)))
      table.fail("max", "must be larger than min in every component");
    return bounds;
  }
  bounds.radius = table.real("radius");
  if (bounds.kind == RegionKind::sphere) {
    bounds.center = table.vector("center");
    return bounds;
  }
  if (space.dimension == 2) table.fail("kind", "a cylinder needs a domain of dimension 3");
  const std::vector<Vec3>& ends = table.vectors("ends");
  bounds.center = ends[0], bounds.axis = ends[1] - ends[0];
  if (bounds.axis == Vec3{}) table.fail("ends", "the two ends must differ");
  return bounds;
}

}  // namespace

void build_stop(const DeckTable& deck, Model& model) {
  int number = 0;
  for (const DeckTable& table : deck.tables("stop")) {
    StopCondition condition;
    condition.name = table.has("name") ? table.text("name") : std::to_string(number);
    condition.column = table.text("column"), condition.place = table.place("column");
    take_bound(table, condition);
    condition.over = table.real("over"), condition.after = table.real("after");
    if (condition.kind == StopKind::steady && !(condition.over > 0))
      table.fail("over", "must be above 0 with within: the time over which the column is steady");
    model.stop_conditions.push_back(condition);
    ++number;
  }
}

void build_history_regions(const DeckTable& output, Model& model) {
  for (const DeckTable& table : output.tables("history_regions"))
    model.output.history_regions.push_back({table.text("name"), bounds_of(table, model.space)});
}

}  // namespace scree
