// Content of the contact history: the data that each contact stores from step to step.
#pragma once

namespace scree {

// Nothing, the contact key alone, or the contact key and the history values of the contact law.
struct HistoryContent {
  bool has_keys = false;
  int values = 0;  // history values of the law per contact; 0 without keys

  static constexpr HistoryContent of_law(int values) { return {values > 0, values}; }

  constexpr bool exists() const { return has_keys; }
  friend constexpr bool operator==(const HistoryContent&, const HistoryContent&) = default;
};

inline constexpr HistoryContent kNoHistory{};
// Content of laws without history where the model has open surfaces: the contacts with these are stored for
// their sides, which are part of the keys.
inline constexpr HistoryContent kSidesOnly{true, 0};

}  // namespace scree
