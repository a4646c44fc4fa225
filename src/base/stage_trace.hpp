// The intervals of some steps, for a timeline: batches of steps, the stages in them, and waits for a device.
#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

namespace scree {

class StageTrace {
 public:
  using Clock = std::chrono::steady_clock;
  // Values of Event::what that are no stages.
  static constexpr std::int64_t kBatch = -1, kWait = -2;

  struct Event {
    std::int64_t what;              // a stage, or one of the above
    std::int64_t begin, end;        // since set_origin() [ns]
    std::int64_t first_step, last;  // numbers of steps before and after a batch
  };

  // from, steps: the first step to record, counted from 0, and how many.
  StageTrace(std::int64_t from, std::int64_t steps) : from_(from), to_(from + steps) {}
  ~StageTrace();
  StageTrace(const StageTrace&) = delete;
  StageTrace& operator=(const StageTrace&) = delete;

  // The instant at which the timeline begins.
  void set_origin() { origin_ = Clock::now(); }
  // Between two batches of steps. step: number of steps so far. What this thread does from before_steps() to
  // after_steps() is recorded if the step is to be recorded.
  void before_steps(std::int64_t step);
  void after_steps(std::int64_t step);
  // Most steps of a batch that begins after `step` steps, so that recording begins and ends with it.
  std::int64_t most_steps(std::int64_t step) const;

  bool is_recording() const { return recording_; }
  void add(std::int64_t what, Clock::time_point begin, Clock::time_point end) {
    if (recording_) events_.push_back({what, since_origin(begin), since_origin(end), 0, 0});
  }
  const std::vector<Event>& events() const { return events_; }

  // Records its lifetime as a wait for the device, if this thread records.
  class Wait {
   public:
    Wait() : trace_(of_thread_), begin_(trace_ != nullptr ? Clock::now() : Clock::time_point{}) {}
    ~Wait() {
      if (trace_ != nullptr) trace_->add(kWait, begin_, Clock::now());
    }
    Wait(const Wait&) = delete;
    Wait& operator=(const Wait&) = delete;

   private:
    StageTrace* trace_;
    Clock::time_point begin_;
  };

 private:
  std::int64_t since_origin(Clock::time_point time) const {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(time - origin_).count();
  }

  static thread_local StageTrace* of_thread_;  // that records now

  std::int64_t from_, to_, first_step_ = 0;
  bool recording_ = false;
  Clock::time_point origin_ = Clock::now(), batch_begin_;
  std::vector<Event> events_;
};

}  // namespace scree
