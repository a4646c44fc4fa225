#include "model/checks/angle_plausibility.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "deck/choices.hpp"
#include "model/derived/joint_coordinates.hpp"

namespace scree {

namespace {

constexpr Real kRevolution = 2 * std::numbers::pi_v<Real>;

class Search {
 public:
  explicit Search(const DeckTable& deck) : deck_(deck) { search(deck); }
  std::vector<std::string> findings() && { return std::move(findings_); }

 private:
  void search(const DeckTable& table) {
    for (const Key& key : table.keys().keys) {
      const auto entry = table.values().find(key.name);
      if (entry == table.values().end()) continue;
      if (const auto* tables = std::get_if<std::vector<DeckTable>>(&entry->second.data))
        for (const DeckTable& inner : *tables) search(inner);
      if (const Real* value = std::get_if<Real>(&entry->second.data))
        judge(table, key, *value, entry->second);
    }
  }
  void judge(const DeckTable& table, const Key& key, Real value, const DeckValue& given) {
    if (!(std::abs(value) > kRevolution) || !std::isfinite(value)) return;
    const bool meant =
        key.unit == "rad" || (key.unit == "rad or m" && std::floor(value) == value && is_of_angle(table));
    if (!meant) return;
    findings_.push_back(fmt::format(
        "{}: {}.{} = {}: {:g} rad are {:.3g} revolutions; angles are in radians: {:g} degrees are {:.6g}",
        given.location, table.path(), key.name, given.shown, value, std::abs(value) / kRevolution, value,
        value * kRevolution / 360));
  }
  // Whether the values of the table refer to an angle of its joint.
  bool is_of_angle(const DeckTable& table) const {
    for (const DeckTable& joint : deck_.tables("joints")) {
      if (joint.text("name") != table.text("joint")) continue;
      if (table.has("coordinate")) return is_angle(table.choice<JointCoordinate>("coordinate"));
      const std::vector<JointCoordinate> own = coordinates_of(joint.choice<JointKind>("type"));
      return !own.empty() && is_angle(own.front());
    }
    return false;  // belongs to a row
  }

  const DeckTable& deck_;
  std::vector<std::string> findings_;
};

}  // namespace

std::vector<std::string> angles_in_degrees(const DeckTable& deck) { return Search(deck).findings(); }

}  // namespace scree
