#include "run/state/stop_watch.hpp"

#include <cmath>

#include "base/error.hpp"
#include "base/index.hpp"

namespace scree {
namespace {

constexpr const char *kConditions = "stop/conditions", *kRows = "stop/rows", *kSamples = "stop/samples";

}  // namespace

void add_watches(const std::vector<StopWatch>& watches, Checkpoint& out) {
  if (watches.empty()) return;
  std::vector<std::int64_t>&conditions = out.integers[kConditions], &rows = out.integers[kRows];
  std::vector<Real>& samples = out.reals[kSamples];
  for (const StopWatch& watch : watches) {
    conditions.push_back(watch.condition), rows.push_back(std::ssize(watch.held));
    for (const StopSample& sample : watch.held) samples.insert(samples.end(), {sample.time, sample.value});
  }
}

std::vector<StopWatch> watches_in(const Checkpoint& in) {
  if (in.integers.count(kConditions) == 0) return {};
  const std::vector<std::int64_t>&conditions = in.integer_array(kConditions), &rows = in.integer_array(kRows);
  const std::vector<Real>& samples = in.real_array(kSamples);
  const auto check = [&](bool fits) {
    if (!fits) throw IoError(in.path + ": the arrays of stop/ do not fit together");
  };
  check(conditions.size() == rows.size());
  std::vector<StopWatch> watches;
  std::size_t at = 0;
  for (std::size_t k = 0; k < conditions.size(); ++k) {
    StopWatch& watch = watches.emplace_back(StopWatch{conditions[k], {}});
    check(rows[k] >= 0 && as_size(rows[k]) <= (samples.size() - at) / 2);
    for (std::int64_t row = 0; row < rows[k]; ++row, at += 2) {
      if (!std::isfinite(samples[at]) || !std::isfinite(samples[at + 1]))
        throw IoError(in.path + ": '" + kSamples + "' is not finite");
      watch.held.push_back({samples[at], samples[at + 1]});
    }
  }
  check(at == samples.size());
  return watches;
}

}  // namespace scree
