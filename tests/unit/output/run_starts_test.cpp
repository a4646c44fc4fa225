// The list of a run's starts: as text and back, and its sum.
#include "output/run_starts.hpp"

#include <string>
#include <vector>

#include "base/error.hpp"
#include "support/bits.hpp"
#include "support/catch.hpp"

namespace scree {

namespace {

const std::vector<RunStart> kStarts = {
    {"2026-11-25T18:34:06Z", "node \"7\"", "cpu (serial)", 4, 0, 0.1, 1000, 2.5, 0.1 + 0.2, 2.25},
    {"2026-11-26T08:00:00Z", "node 8", "cuda", 1, 0.1, 1.0 / 3, 9000, 10, 9.5, 5}};

}  // namespace

TEST_CASE("starts return from their text bit for bit") {
  const std::vector<RunStart> found = starts_in(to_text(kStarts), "file");
  REQUIRE(found.size() == kStarts.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    const RunStart &a = found[k], &b = kStarts[k];
    CHECK((a.started == b.started && a.host == b.host && a.backend == b.backend));
    CHECK((a.ranks == b.ranks && a.steps == b.steps));
    CHECK((same_bits(a.from, b.from) && same_bits(a.to, b.to)));
    CHECK((same_bits(a.wall_seconds, b.wall_seconds) && same_bits(a.loop_seconds, b.loop_seconds)));
    CHECK(same_bits(a.cpu_seconds, b.cpu_seconds));
  }
  CHECK(starts_in(to_text({}), "file").empty());
}

TEST_CASE("the sum of starts is of their steps and seconds") {
  const RunStart sum = sum_of(kStarts);
  CHECK((sum.steps == 10000 && sum.wall_seconds == 12.5 && sum.cpu_seconds == 7.25));
  CHECK(sum.loop_seconds == 9.5 + (0.1 + 0.2));
  CHECK((sum.started == kStarts[0].started && sum.from == 0 && sum.to == 1.0 / 3));
  CHECK(sum_of({}).steps == 0);
}

TEST_CASE("a damaged list of starts is refused by the file's name") {
  const std::string good = to_text(kStarts);
  std::string lacks = good;
  lacks.replace(lacks.find("steps"), 5, "stops");
  for (const std::string& text : {std::string("starts = [1]"), std::string("[["), std::string(""), lacks}) {
    CAPTURE(text);
    std::string message;
    try {
      starts_in(text, "c.h5");
    } catch (const IoError& error) {
      message = error.what();
    }
    CHECK(message.starts_with("c.h5: the list of the run's starts is damaged: "));
  }
}

}  // namespace scree
