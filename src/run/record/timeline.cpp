#include "run/record/timeline.hpp"

#include <fmt/format.h>

#include <chrono>
#include <set>
#include <utility>
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

struct RankDeviceEvent {
  int rank;
  DeviceTrace::Event event;
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

// Streams are lanes after that of the host.
int lane_of(const RankDeviceEvent& of) { return of.event.stream + 1; }

std::string line_of(const RankDeviceEvent& of) {
  const DeviceTrace::Event& event = of.event;
  return fmt::format(
      R"({{"name": "{}", "cat": "device", "ph": "X", "ts": {:.3f}, "dur": {:.3f}, "pid": {}, "tid": {}}})",
      event.label.data(), 1e-3 * static_cast<double>(event.begin),
      1e-3 * static_cast<double>(event.end - event.begin), of.rank, lane_of(of));
}

std::string name_of_lane(int rank, int lane) {
  return fmt::format(
      R"({{"name": "thread_name", "ph": "M", "pid": {}, "tid": {}, "args": {{"name": "{}"}}}})", rank, lane,
      lane == 0 ? "host" : fmt::format("stream {}", lane - 1));
}

std::string name_of_rank(int rank) {
  return fmt::format(R"({{"name": "process_name", "ph": "M", "pid": {0}, "args": {{"name": "rank {0}"}}}})",
                     rank);
}

}  // namespace

void Timeline::set_origin() { host_.set_origin(), origin_ = StageTrace::Clock::now(); }

void Timeline::before_steps(std::int64_t step) {
  host_.before_steps(step);
  if (!host_.is_recording())
    stop_device();
  else if (device_ && !device_records_)
    device_->start(), device_records_ = true;
}

void Timeline::stop_device() {
  if (!std::exchange(device_records_, false)) return;
  const auto origin =
      std::chrono::duration_cast<std::chrono::nanoseconds>(origin_.time_since_epoch()).count();
  for (DeviceTrace::Event event : device_->stop()) {
    event.begin -= origin, event.end -= origin;
    device_events_.push_back(event);
  }
}

void Timeline::write(const std::string& path, const Ranks& ranks) {
  stop_device();
  std::vector<RankEvent> own;
  for (const Event& event : host_.events()) own.push_back({ranks.rank(), event});
  std::vector<RankDeviceEvent> own_device;
  for (const DeviceTrace::Event& event : device_events_) own_device.push_back({ranks.rank(), event});
  const std::vector<RankEvent> all = ranks.gather(std::move(own));
  const std::vector<RankDeviceEvent> devices = ranks.gather(std::move(own_device));
  ranks.on_root([&] {
    std::vector<std::string> lines;
    std::set<std::pair<int, int>> lanes;  // of a rank
    for (int rank = 0; rank < ranks.size(); ++rank)
      lines.push_back(name_of_rank(rank)), lanes.insert({rank, 0});
    for (const RankDeviceEvent& event : devices) lanes.insert({event.rank, lane_of(event)});
    for (const auto& [rank, lane] : lanes) lines.push_back(name_of_lane(rank, lane));
    for (const RankEvent& event : all) lines.push_back(line_of(event));
    for (const RankDeviceEvent& event : devices) lines.push_back(line_of(event));
    write_text_file(path, fmt::format("{{\"displayTimeUnit\": \"ns\", \"traceEvents\": [\n{}\n]}}\n",
                                      fmt::join(lines, ",\n")));
  });
}

}  // namespace scree
