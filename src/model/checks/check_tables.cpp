// Checks functions of time given as tables: that they cover the run, and whether a spline overshoots.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "deck/choices.hpp"
#include "model/checks/deck_checks.hpp"
#include "model/derived/scalar_function.hpp"
#include "model/derived/time_functions.hpp"

namespace scree {

namespace {

constexpr Real kNoticeable = 0.01;  // of a table's range
// The motions; all other keys are forces and commands, whose default interpolation is linear.
constexpr std::array<std::string_view, 5> kMotions = {"motion", "displacement", "angle", "position",
                                                      "length"};

void check_cover(const DeckTable& table, const TimeFunction& function, Real end) {
  const Real first = function.times.front(), last = function.times.back();
  if (first <= 0 && last >= end) return;
  std::string remedy;
  if (last < end)
    remedy = fmt::format("; to stay at its end, repeat the last value, {}, at a time of {} s or later",
                         function.values.back(), end);
  table.fail("times",
             fmt::format("must cover the whole run, 0 s to time.end = {} s; they go from {} s to {} s{}", end,
                         first, last, remedy));
}

void warn_of_overshoot(const DeckTable& table, const TimeFunction& function, Log& log) {
  const Overshoot farthest = ScalarFunction(function, table.label(), 0).overshoot();
  const auto [least, most] = std::minmax_element(function.values.begin(), function.values.end());
  const Real range = *most - *least, beyond = std::abs(farthest.beyond);
  if (!(beyond > kNoticeable * range)) return;
  const std::string share =
      range > 0 ? fmt::format(", {:.2g} % of the table's range", 100 * beyond / range) : "";
  log.warning(
      fmt::format("{}: between {} s and {} s the {} spline overshoots the values there, to {:.4g} at t = "
                  "{:.4g} s, by {:.3g}{}; interpolation = \"monotone\" stays between them",
                  table.label(), function.times[farthest.segment], function.times[farthest.segment + 1],
                  word_of(function.interpolation), farthest.value, farthest.t, beyond, share));
}

}  // namespace

void check_time_tables(const DeckTable& table, Real end, Log& log) {
  for (const auto& [key, value] : table.values()) {
    const auto* const below = std::get_if<std::vector<DeckTable>>(&value.data);
    if (below == nullptr) continue;
    for (const DeckTable& entry : *below) {
      if (&entry.keys() != &time_function_keys()) {
        check_time_tables(entry, end, log);
        continue;
      }
      const bool moves = std::find(kMotions.begin(), kMotions.end(), key) != kMotions.end();
      const TimeFunction function = moves ? build_motion(entry) : build_force(entry);
      if (function.kind != TimeFunctionKind::table) continue;
      check_cover(entry, function, end);
      warn_of_overshoot(entry, function, log);
    }
  }
}

}  // namespace scree
