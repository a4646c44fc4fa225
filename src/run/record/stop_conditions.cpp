#include "run/record/stop_conditions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "base/bit_hash.hpp"
#include "base/error.hpp"
#include "base/printable.hpp"
#include "deck/suggestion.hpp"
#include "run/record/model_columns.hpp"

namespace scree {
namespace {

// Times of rows are rounded: two durations that differ by less than this share are equal.
constexpr Real kSameDuration = 1e-9;

bool reaches(Real duration, Real wanted) { return duration >= wanted * (1 - kSameDuration); }

std::string path_of(const HistoryColumn& column) { return column.group + "/" + column.name; }

auto find_column(const std::vector<RecordedColumn>& columns, const std::string& path) {
  return std::ranges::find_if(columns,
                              [&](const RecordedColumn& column) { return path_of(column.head) == path; });
}

// Adds a row at which a bound may hold. NaN, the value of a particle that was removed, holds no bound.
void add_to_bound(const StopCondition& condition, StopSample row, std::vector<StopSample>& held) {
  const bool holds =
      condition.kind == StopKind::above ? row.value > condition.bound : row.value < condition.bound;
  if (!holds) return held.clear();
  if (held.size() == 2) held.pop_back();
  held.push_back(row);
}

// Keeps the rows back to the last one whose value is outside the band with the new one. The rows kept so far
// are in a band with each other, so all of them are then.
void add_to_band(const StopCondition& condition, StopSample row, std::vector<StopSample>& held) {
  if (!std::isfinite(row.value)) return held.clear();
  const auto outside = [&](const StopSample& sample) {
    return std::abs(sample.value - row.value) > condition.bound;
  };
  const auto last = std::find_if(held.rbegin(), held.rend(), outside);
  held.erase(held.begin(), last.base());
  held.push_back(row);
  // Rows before the one that completes the time do not matter any more.
  const auto complete = [&](const StopSample& sample) {
    return reaches(row.time - sample.time, condition.over);
  };
  const auto first_short = std::partition_point(held.begin(), held.end(), complete);
  if (first_short - held.begin() > 1) held.erase(held.begin(), first_short - 1);
}

bool is_met(const StopCondition& condition, const StopWatch& watch) {
  if (watch.held.empty() || watch.held.back().time <= 0) return false;
  return reaches(watch.held.back().time - watch.held.front().time, condition.over);
}

// The nearest column; otherwise the columns of the group, or all groups.
std::string column_suggestion(const std::string& misspelt, const std::vector<RecordedColumn>& columns) {
  const std::string group = misspelt.substr(0, misspelt.rfind('/'));
  std::vector<std::string> all, of_group;
  std::set<std::string> groups;
  for (const RecordedColumn& column : columns) {
    all.push_back(path_of(column.head)), groups.insert(column.head.group);
    if (column.head.group == group) of_group.push_back(all.back());
  }
  if (!of_group.empty()) return suggestion(misspelt, of_group);
  const std::string near = suggestion(misspelt, all);
  if (near.find("did you mean") != std::string::npos) return near;
  return fmt::format(
      "; known groups: {}; output.history_bodies, history_contacts, history_particles and "
      "history_regions add others",
      fmt::join(groups, ", "));
}

}  // namespace

std::string described(const StopCondition& condition) {
  const char* const is = condition.kind == StopKind::above   ? "above"
                         : condition.kind == StopKind::below ? "below"
                                                             : "steady within";
  std::string text = fmt::format("{} {} {:g}", printable(condition.column), is, condition.bound);
  if (condition.over > 0) text += fmt::format(" for {:g} s", condition.over);
  if (condition.after > 0) text += fmt::format(", from t = {:g} s on", condition.after);
  return text;
}

std::int64_t key_of(const StopCondition& condition) {
  BitHash hash;
  hash.add(condition.column.data(), condition.column.size());
  hash.add(static_cast<std::int64_t>(condition.kind));
  hash.add(condition.bound), hash.add(condition.over), hash.add(condition.after);
  return static_cast<std::int64_t>(hash.hash());
}

void check_stop_columns(const Model& model) {
  if (model.stop_conditions.empty()) return;
  const std::vector<RecordedColumn> columns = model_columns(model);
  for (const StopCondition& condition : model.stop_conditions)
    if (find_column(columns, condition.column) == columns.end())
      throw InputError(condition.place + ": the history has no such column" +
                       column_suggestion(condition.column, columns));
}

StopConditions::StopConditions(std::vector<StopCondition> conditions,
                               const std::vector<RecordedColumn>& columns)
    : conditions_(std::move(conditions)) {
  for (const StopCondition& condition : conditions_) {
    const auto found = find_column(columns, condition.column);
    if (found == columns.end()) throw InputError(condition.place + ": the history has no such column");
    column_.push_back(static_cast<std::size_t>(found - columns.begin()));
  }
}

void StopConditions::adopt(std::vector<StopWatch>& watches) const {
  std::vector<StopWatch> own;
  for (const StopCondition& condition : conditions_) {
    const std::int64_t key = key_of(condition);
    const auto found = std::ranges::find(watches, key, &StopWatch::condition);
    own.push_back(found != watches.end() ? *found : StopWatch{key, {}});
  }
  watches = std::move(own);
}

void StopConditions::add_row(Real time, std::span<const Real> row, std::vector<StopWatch>& watches) const {
  for (std::size_t k = 0; k < conditions_.size(); ++k) {
    const StopCondition& condition = conditions_[k];
    std::vector<StopSample>& held = watches[k].held;
    if (!reaches(time, condition.after) || (!held.empty() && held.back().time == time)) continue;
    const StopSample sample{time, row[column_[k]]};
    condition.kind == StopKind::steady ? add_to_band(condition, sample, held)
                                       : add_to_bound(condition, sample, held);
  }
}

std::string StopConditions::reason(const std::vector<StopWatch>& watches) const {
  for (std::size_t k = 0; k < conditions_.size(); ++k) {
    if (!is_met(conditions_[k], watches[k])) continue;
    const StopSample last = watches[k].held.back();
    return fmt::format("\"{}\": {}; {:.6g} at t = {:.9g} s", printable(conditions_[k].name),
                       described(conditions_[k]), last.value, last.time);
  }
  return "";
}

}  // namespace scree
