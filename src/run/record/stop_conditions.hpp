// The conditions of the deck that end the run, evaluated at the rows of the history.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "model/data/model.hpp"
#include "run/record/history_columns.hpp"
#include "run/state/stop_watch.hpp"

namespace scree {

// Throws InputError with the place in the deck and the nearest name if a condition is on a column that the
// run does not have.
void check_stop_columns(const Model& model);
// "energy/kinetic below 1e-06 for 0.1 s"
std::string described(const StopCondition& condition);
// Identity of the condition without its name: equal if the watch of one condition is that of the other.
std::int64_t key_of(const StopCondition& condition);

class StopConditions {
 public:
  // columns: of the history, with those of all conditions.
  StopConditions(std::vector<StopCondition> conditions, const std::vector<RecordedColumn>& columns);

  bool empty() const { return conditions_.empty(); }
  // Makes the watches those of these conditions, in their order; conditions without a watch have a new one,
  // and watches of other conditions are dropped.
  void adopt(std::vector<StopWatch>& watches) const;
  // Adds a row with a value per column. A row at the time of the last one is the same row. watches: as
  // adopt() makes them.
  void add_row(Real time, std::span<const Real> row, std::vector<StopWatch>& watches) const;
  // The first condition that is met, with its last value and the time; empty if none is, and at t = 0.
  std::string reason(const std::vector<StopWatch>& watches) const;

 private:
  std::vector<StopCondition> conditions_;
  std::vector<std::size_t> column_;  // of each condition
};

}  // namespace scree
