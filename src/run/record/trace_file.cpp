#include "run/record/trace_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "base/index.hpp"
#include "base/timer.hpp"
#include "output/durable_file.hpp"

namespace scree {
namespace {

using Event = StageTrace::Event;

struct RankEvent {
  int rank;
  Event event;
};

std::string name_of(const Event& event) {
  if (event.what == StageTrace::kWait) return "wait for the device";
  if (event.what != StageTrace::kBatch) return kStageNames[as_size(event.what)];
  return event.last - event.first_step == 1 ? "step" : "steps";
}

// A complete event, with times in microseconds.
std::string line_of(const RankEvent& of) {
  const Event& event = of.event;
  const bool batch = event.what == StageTrace::kBatch;
  return fmt::format(
      R"({{"name": "{}", "cat": "{}", "ph": "X", "ts": {:.3f}, "dur": {:.3f}, "pid": {}, "tid": 0{}}})",
      name_of(event),
      batch                             ? "steps"
      : event.what == StageTrace::kWait ? "wait"
                                        : "stage",
      1e-3 * static_cast<double>(event.begin), 1e-3 * static_cast<double>(event.end - event.begin), of.rank,
      batch ? fmt::format(R"(, "args": {{"first": {}, "steps": {}}})", event.first_step,
                          event.last - event.first_step)
            : "");
}

std::string name_of_rank(int rank) {
  return fmt::format(R"({{"name": "process_name", "ph": "M", "pid": {0}, "args": {{"name": "rank {0}"}}}})",
                     rank);
}

}  // namespace

void write_trace(const std::string& path, const StageTrace& trace, const Ranks& ranks) {
  std::vector<RankEvent> own;
  for (const Event& event : trace.events()) own.push_back({ranks.rank(), event});
  const std::vector<RankEvent> all = ranks.gather(std::move(own));
  ranks.on_root([&] {
    std::vector<std::string> lines;
    for (int rank = 0; rank < ranks.size(); ++rank) lines.push_back(name_of_rank(rank));
    for (const RankEvent& event : all) lines.push_back(line_of(event));
    write_text_file(path, fmt::format("{{\"displayTimeUnit\": \"ns\", \"traceEvents\": [\n{}\n]}}\n",
                                      fmt::join(lines, ",\n")));
  });
}

}  // namespace scree
