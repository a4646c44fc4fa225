// The work of a device during some steps, for a timeline.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace scree {

class DeviceTrace {
 public:
  struct Event {
    std::int64_t begin, end;     // of std::chrono::steady_clock [ns]
    int stream;                  // the work of one stream is done in order
    std::array<char, 48> label;  // name of a kernel, or the direction of a copy; ends with a zero
  };

  virtual ~DeviceTrace() = default;
  virtual void start() = 0;
  // Waits for the device and returns its work since start().
  virtual std::vector<Event> stop() = 0;
};

}  // namespace scree
