#include "run/state/start_record.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <utility>

#include "output/lock_owner.hpp"

namespace scree {
namespace {

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

std::string took_text(const std::vector<RunStart>& starts) {
  const auto seconds = [](const RunStart& of) {
    return fmt::format("{:.2f} s wall, {:.2f} s CPU", of.wall_seconds, of.cpu_seconds);
  };
  const std::string own = seconds(starts.back());
  if (starts.size() == 1) return own;
  return fmt::format("{}; all {} starts of the run {}", own, starts.size(), seconds(sum_of(starts)));
}

StartRecord::StartRecord(std::vector<RunStart> earlier, const State& state, const std::string& started,
                         const std::string& backend, int ranks)
    : earlier_(std::move(earlier)), first_step_(state.counts.steps), start_cpu_(cpu_seconds()) {
  own_.started = started, own_.host = LockOwner::this_process().host;
  own_.backend = backend, own_.ranks = ranks;
  own_.from = state.clock.time;
}

void StartRecord::end_loop() { loop_seconds_ = loop_seconds(), in_loop_ = false; }

double StartRecord::loop_seconds() const { return in_loop_ ? seconds_since(loop_start_) : loop_seconds_; }

std::vector<RunStart> StartRecord::starts(const State& state) const {
  std::vector<RunStart> all = earlier_;
  RunStart& now = all.emplace_back(own_);
  now.to = state.clock.time, now.steps = state.counts.steps - first_step_;
  now.wall_seconds = seconds_since(start_), now.loop_seconds = loop_seconds();
  now.cpu_seconds = cpu_seconds() - start_cpu_;
  return all;
}

}  // namespace scree
