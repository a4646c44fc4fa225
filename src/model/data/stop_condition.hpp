// A condition on a column of the history that ends the run.
#pragma once

#include <string>

#include "base/types.hpp"

namespace scree {

enum class StopKind {
  above,  // the column exceeds the bound
  below,  // the column is below the bound
  steady  // the column's values stay in a band of this width
};

struct StopCondition {
  std::string name;    // its number where the deck gives none
  std::string column;  // "energy/kinetic"
  StopKind kind = StopKind::above;
  Real bound = 0;     // bound, or width of the band, in the column's unit
  Real over = 0;      // time for which the condition must have held [s]
  Real after = 0;     // rows before this time do not count [s]
  std::string place;  // of the column in the deck, for messages: "deck.toml:12:10: stop.0.column"
};

}  // namespace scree
