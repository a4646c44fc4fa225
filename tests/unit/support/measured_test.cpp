// Values recorded for tables are those that a check requires and finds.
#include "support/measured.hpp"

#include <limits>

#include "support/catch.hpp"

namespace scree {

TEST_CASE("numbers may reach their bounds, and NaN is within none") {
  CHECK(at_most(-2, 2));
  CHECK_FALSE(at_most(2.1, 2));
  CHECK(at_least(3, 3));
  CHECK_FALSE(at_least(2.9, 3));
  CHECK(in_range(0, 0, 0));
  CHECK_FALSE(in_range(2.1, 1, 2));
  for (const Bounded& none :
       {at_most(std::numeric_limits<Real>::quiet_NaN(), 1), Bounded{.value = std::nan("")}})
    CHECK_FALSE(none);
}

TEST_CASE("errors are recorded with the promise, differences with the bound given") {
  const Bounded kept = bounded(keeps(-2e-5, {.promise = 1e-3, .measured = 1e-5}));
  CHECK(kept.value == 2e-5);
  CHECK(kept.at_most == 1e-3);
  const Bounded apart = bounded(near(2.5, 2, {.absolute = 1})),
                relative = bounded(near(2.5, 2, {.relative = 0.5}));
  CHECK((apart.value == 0.5 && apart.at_most == 1));
  CHECK((relative.value == 0.25 && relative.at_most == 0.5));
  CHECK((bounded(BitForBit{""}) && !bounded(BitForBit{"row 3"})));
}

}  // namespace scree
