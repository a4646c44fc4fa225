// The serial loop and the largest value over items.
#include "base/for_each.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "base/log.hpp"
#include "support/catch.hpp"

namespace scree {

namespace {

Real largest_of(const std::vector<Real>& values) {
  return max_over(Serial{}, static_cast<Index>(values.size()),
                  [&](Index i) { return values[static_cast<std::size_t>(i)]; });
}

}  // namespace

TEST_CASE("for_each visits every item once, in order") {
  std::vector<Index> visited;
  for_each(Serial{}, 5, [&](Index i) { visited.push_back(i); });
  CHECK(visited == std::vector<Index>{0, 1, 2, 3, 4});
  for_each(Serial{}, 0, [&](Index) { visited.clear(); });
  CHECK(visited.size() == 5);
}

TEST_CASE("max_over gives the largest value, at least 0") {
  CHECK(largest_of({}) == 0);
  CHECK(largest_of({-3, -1}) == 0);
  CHECK(largest_of({1, 5, 2}) == 5);
  const Real infinity = std::numeric_limits<Real>::infinity();
  CHECK(largest_of({1, infinity, 2}) == infinity);
}

TEST_CASE("a NaN at any position makes max_over a NaN") {
  for (std::size_t place = 0; place < 4; ++place) {
    std::vector<Real> values{1, 7, 3, std::numeric_limits<Real>::infinity()};
    values[place] = std::numeric_limits<Real>::quiet_NaN();
    CAPTURE(place);
    CHECK(std::isnan(largest_of(values)));
  }
}

TEST_CASE("a quiet log keeps its warnings in order") {
  Log log(true);
  log.warning("first");
  log.info("not kept");
  log.progress("not kept either", true);
  log.warning("second");
  CHECK(log.warnings() == std::vector<std::string>{"first", "second"});
}

}  // namespace scree
