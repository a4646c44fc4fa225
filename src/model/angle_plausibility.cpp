#include "model/angle_plausibility.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace scree {

namespace {

constexpr std::size_t kShown = 5;
constexpr Real kTurn = 2 * std::numbers::pi_v<Real>;

// Of a joint's coordinate, which may be an angle.
bool may_be_angle(const std::string& unit) { return unit == "rad or m"; }

class Search {
 public:
  std::vector<std::string> in(const DeckTable& deck) {
    look(deck);
    if (found_ > kShown) findings_.back() += fmt::format("; and {} more keys like these", found_ - kShown);
    return findings_;
  }

 private:
  void look(const DeckTable& table) {
    for (const Key& key : table.keys().keys) {
      const auto entry = table.values().find(key.name);
      if (entry == table.values().end()) continue;
      if (const auto* tables = std::get_if<std::vector<DeckTable>>(&entry->second.data))
        for (const DeckTable& inner : *tables) look(inner);
      if (const Real* value = std::get_if<Real>(&entry->second.data))
        judge(table, key, *value, entry->second);
    }
  }
  void judge(const DeckTable& table, const Key& key, Real value, const DeckValue& given) {
    const bool meant = key.unit == "rad" || (may_be_angle(key.unit) && std::floor(value) == value);
    if (!meant || !(std::abs(value) > kTurn) || !std::isfinite(value)) return;
    if (++found_ > kShown) return;
    findings_.push_back(fmt::format(
        "{}: {}{}{} = {}: {:g} rad are {:.3g} turns; angles are in radians: {:g} degrees are {:.6g}{}",
        given.place, table.path(), table.path().empty() ? "" : ".", key.name, given.shown, value,
        std::abs(value) / kTurn, value, value * kTurn / 360,
        key.unit == "rad" ? "" : ", where the coordinate is an angle"));
  }

  std::size_t found_ = 0;
  std::vector<std::string> findings_;
};

}  // namespace

std::vector<std::string> angles_in_degrees(const DeckTable& deck) { return Search().in(deck); }

}  // namespace scree
