#include "base/stage_trace.hpp"

#include <limits>

namespace scree {

thread_local StageTrace* StageTrace::of_thread_ = nullptr;

StageTrace::~StageTrace() {
  if (of_thread_ == this) of_thread_ = nullptr;
}

void StageTrace::before_steps(std::int64_t step) {
  recording_ = step >= from_ && step < to_;
  of_thread_ = recording_ ? this : nullptr;
  first_step_ = step, batch_begin_ = Clock::now();
}

void StageTrace::after_steps(std::int64_t step) {
  if (recording_)
    events_.push_back({kBatch, since_origin(batch_begin_), since_origin(Clock::now()), first_step_, step});
  recording_ = false, of_thread_ = nullptr;
}

std::int64_t StageTrace::most_steps(std::int64_t step) const {
  if (step < from_) return from_ - step;
  return step < to_ ? to_ - step : std::numeric_limits<std::int64_t>::max();
}

}  // namespace scree
