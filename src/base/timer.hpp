// Wall time per stage of a step. The names of the stages are used for the timers and in the run record.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <span>

#include "base/stage_trace.hpp"
#include "base/types.hpp"

namespace scree {

enum class Stage {
  predict,
  migrate,
  sort_cells,
  exchange_halo,
  neighbors,
  update_halo,
  broadcast_motion,
  contact_force,
  reduce_wrench,
  mbs_correct,
  particle_correct,
  accept,
  output,
  count
};

inline constexpr std::array<const char*, static_cast<int>(Stage::count)> kStageNames = {
    "predict",          "migrate",          "sort_cells",    "exchange_halo", "neighbors",
    "update_halo",      "broadcast_motion", "contact_force", "reduce_wrench", "mbs_correct",
    "particle_correct", "accept",           "output"};

// The stages of a neighbour list build.
inline constexpr std::array kListStages = {Stage::migrate, Stage::sort_cells, Stage::exchange_halo,
                                           Stage::neighbors};

class StageTimers {
 public:
  struct Entry {
    double seconds = 0;
    std::int64_t calls = 0;
  };

  // Adds the lifetime of the returned object to the stage's time, and to the trace, if there is one.
  class Scope {
   public:
    Scope(Entry& entry, Stage stage, StageTrace* trace)
        : entry_(entry), stage_(stage), trace_(trace), start_(Clock::now()) {}
    ~Scope() {
      const Clock::time_point end = Clock::now();
      entry_.seconds += std::chrono::duration<double>(end - start_).count();
      ++entry_.calls;
      if (trace_ != nullptr) trace_->add(static_cast<std::int64_t>(stage_), start_, end);
    }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    using Clock = StageTrace::Clock;
    Entry& entry_;
    Stage stage_;
    StageTrace* trace_;
    Clock::time_point start_;
  };

  Scope time(Stage stage) { return Scope(entries_[static_cast<int>(stage)], stage, trace_); }
  // trace: nullptr, or an object that outlives the scopes.
  void record_in(StageTrace* trace) { trace_ = trace; }
  const Entry& operator[](Stage stage) const { return entries_[static_cast<int>(stage)]; }
  // Share of these stages in the time of all stages except output.
  double share(std::span<const Stage> stages) const {
    double all = -(*this)[Stage::output].seconds, these = 0;
    for (const Entry& entry : entries_) all += entry.seconds;
    for (const Stage stage : stages) these += (*this)[stage].seconds;
    return all > 0 ? these / all : 0;
  }

 private:
  std::array<Entry, static_cast<int>(Stage::count)> entries_{};
  StageTrace* trace_ = nullptr;
};

}  // namespace scree
