// The timeline of --trace: what this rank's host and device do in some steps.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/device_trace.hpp"
#include "base/stage_trace.hpp"
#include "partition/ranks.hpp"

namespace scree {

class Timeline {
 public:
  // from, steps: as for `StageTrace`. device: null if its work cannot be recorded.
  Timeline(std::int64_t from, std::int64_t steps, std::unique_ptr<DeviceTrace> device)
      : host_(from, steps), device_(std::move(device)) {}

  StageTrace& host() { return host_; }
  // The instant at which the timeline begins.
  void set_origin();
  // Around each batch of steps. step: number of steps so far.
  void before_steps(std::int64_t step);
  void after_steps(std::int64_t step) { host_.after_steps(step); }
  std::int64_t most_steps(std::int64_t step) const { return host_.most_steps(step); }

  // Ends the recording, and writes the events of all ranks, each as a process of the timeline, on rank 0, in
  // the JSON format of Chrome's trace viewer, which Perfetto opens. Collective. Throws IoError.
  void write(const std::string& path, const Ranks& ranks);

 private:
  void stop_device();

  StageTrace host_;
  std::unique_ptr<DeviceTrace> device_;
  bool device_records_ = false;
  StageTrace::Clock::time_point origin_{};
  std::vector<DeviceTrace::Event> device_events_;  // times since set_origin() [ns]
};

}  // namespace scree
