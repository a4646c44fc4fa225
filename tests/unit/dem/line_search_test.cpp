// The rule of the line search on potentials of one variable, whose minimum along the correction is known.
#include "dem/implicit/line_search.hpp"

#include <limits>

#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 4 * kUlp;  // of fractions up to 1

// Result of a search: the fraction of the correction that is applied, and the number of evaluations.
// slope(share): derivative of the potential.
struct Found {
  Real share;
  int evaluations;
};
template <class Slope>
Found search_along(const Slope& slope) {
  LineSearch search;
  search.open(-slope(Real(0)));
  Found found{1, 0};
  for (; found.evaluations < 100; ++found.evaluations) {
    if (!search.is_open()) break;
    search.update(-slope(found.share));
    if (!search.overshoots()) break;
    const Real next = search.next_share(), change = search.shorten();
    CHECK(near(found.share + change, next, {.absolute = kRoundOff}));
    CHECK((next >= 0.1 * found.share * (1 - kRoundOff) && next <= 2 * found.share / 3));
    found.share += change;
  }
  return found;
}

}  // namespace

TEST_CASE("without a correction nothing overshoots") {
  LineSearch search;
  CHECK_FALSE(search.is_open());
  search.update(-1);
  CHECK_FALSE(search.overshoots());
}

TEST_CASE("a correction overshoots if it leaves more than half the slope that it started with") {
  LineSearch search;
  search.open(4);  // the slope is -4
  CHECK(search.is_open());
  CHECK_FALSE(search.overshoots());
  for (const Real along : {3.0, 0.0, -2.0}) {
    search.update(along);
    CHECK_FALSE(search.overshoots());
  }
  search.update(-2.001);
  CHECK(search.overshoots());
  search.update(std::numeric_limits<Real>::quiet_NaN());
  CHECK_FALSE(search.overshoots());
}

TEST_CASE("the minimum of a parabola is found at once") {
  for (const Real minimum : {0.12, 0.3, 0.6}) {
    const Found found = search_along([&](Real share) { return 5 * (share - minimum); });
    CHECK(found.evaluations == 1);
    CHECK(near(found.share, minimum, {.relative = kRoundOff}));
  }
}

TEST_CASE("a minimum beyond two thirds of the correction is not searched") {
  CHECK(search_along([](Real share) { return share - 0.7; }).evaluations == 0);
}

TEST_CASE("at a kink the search ends, at a fraction before it or too small to be shortened") {
  for (const Real kink : {0.02, 0.07, 0.2, 0.5, 0.9})
    for (const Real stiffness : {0.6, 3.0, 1e6}) {
      CAPTURE(kink, stiffness);
      const Found found = search_along([&](Real share) { return share < kink ? -1 : stiffness; });
      CHECK((found.share < kink || found.share <= 0.05));
      CHECK(found.share >= 0.005);
      CHECK(found.evaluations <= 8);  // 2/3 to the eighth is less than 0.05
    }
}

TEST_CASE("the next correction starts with all of it") {
  LineSearch search;
  search.open(1), search.update(-1e9);
  search.shorten(), search.shorten();
  CHECK_FALSE(search.is_open());
  search.open(1);
  CHECK((search.is_open() && !search.overshoots()));
  search.update(-1);
  CHECK(search.next_share() == 0.5);
}

TEST_CASE("where there is no potential a correction is halved while the residual is larger than before") {
  ResidualSearch search;
  CHECK_FALSE(search.is_open());
  search.open(1);
  search.update(1);
  CHECK_FALSE(search.overshoots());
  Real share = 1;
  int evaluations = 0;
  for (search.update(2); search.overshoots(); search.update(2)) share += search.shorten(), ++evaluations;
  CHECK((share == Real(0.0625) && evaluations == 4));
  search.open(3), search.update(2);
  CHECK((search.is_open() && !search.overshoots()));
}

}  // namespace scree
