// Which steps a timeline records, and what of them.
#include "base/stage_trace.hpp"

#include "base/timer.hpp"
#include "support/catch.hpp"

namespace scree {

TEST_CASE("a timeline has the steps that are wanted, with their stages and waits") {
  StageTrace trace(10, 5);
  StageTimers timers;
  timers.record_in(&trace);
  const auto batch = [&](std::int64_t from, std::int64_t to) {
    trace.before_steps(from);
    {
      const auto scope = timers.time(Stage::contact_force);
      const StageTrace::Wait wait;
    }
    trace.after_steps(to);
  };
  batch(0, 10), batch(10, 12);
  { const auto between = timers.time(Stage::output); }
  const StageTrace::Wait also_between;
  batch(12, 15), batch(15, 40);
  const auto& events = trace.events();
  REQUIRE(events.size() == 6);
  for (std::size_t k = 0; k < 6; k += 3) {
    const auto &wait = events[k], &stage = events[k + 1], &steps = events[k + 2];
    CHECK(wait.what == StageTrace::kWait);
    CHECK(stage.what == static_cast<std::int64_t>(Stage::contact_force));
    CHECK((steps.what == StageTrace::kBatch && steps.first_step == (k == 0 ? 10 : 12)));
    CHECK((steps.begin <= stage.begin && stage.begin <= wait.begin && wait.begin <= wait.end));
    CHECK((wait.end <= stage.end && stage.end <= steps.end));
  }
  CHECK(timers[Stage::contact_force].calls == 4);
}

TEST_CASE("batches of steps end where a timeline begins and ends") {
  const StageTrace trace(10, 5);
  CHECK(trace.most_steps(0) == 10);
  CHECK(trace.most_steps(10) == 5);
  CHECK(trace.most_steps(14) == 1);
  CHECK(trace.most_steps(15) > 1000000);
}

}  // namespace scree
