// Comparisons of the tests fail where they should, and report by how much.
#include "support/near.hpp"

#include <sstream>

#include "support/bars.hpp"
#include "support/catch.hpp"

namespace scree {

namespace {

constexpr Real kNaN = std::numeric_limits<Real>::quiet_NaN();

template <class Printed>
std::string text(const Printed& printed) {
  std::ostringstream out;
  out << printed;
  return out.str();
}

}  // namespace

TEST_CASE("without a bound only what is equal is near") {
  CHECK(near(0.1, 0.1, {}));
  CHECK(near(0.0, -0.0, {}));
  CHECK_FALSE(near(0.1 + 0.2, 0.3, {}));
  CHECK_FALSE(near(1 + kUlp, 1, {}));
  CHECK_FALSE(near(std::numeric_limits<Real>::denorm_min(), 0, {}));
}

TEST_CASE("a relative bound is of the expected value, an absolute one is not, and they do not add up") {
  CHECK(near(1 + kUlp, 1, {.relative = kUlp}));
  CHECK_FALSE(near(1 + 2 * kUlp, 1, {.relative = kUlp}));
  CHECK(near(-96.5, -100, {.relative = 0.035}));
  CHECK_FALSE(near(-96.4, -100, {.relative = 0.035}));
  CHECK_FALSE(near(100, 96.5, {.relative = 0.035}));
  CHECK_FALSE(near(1e-300, 0, {.relative = 1e6}));
  CHECK(near(1e-9, 0, {.absolute = 1e-9}));
  CHECK_FALSE(near(1.1e-9, 0, {.absolute = 1e-9}));
  CHECK(near(3, 2, {.relative = 0.1, .absolute = 1}));
  CHECK(near(3, 2, {.relative = 0.5, .absolute = 0.1}));
  CHECK_FALSE(near(3, 2, {.relative = 0.4, .absolute = 0.9}));
}

TEST_CASE("NaN is near nothing, and infinity only itself") {
  const Within any{.relative = kInfinity, .absolute = kInfinity};
  for (const Real value : {0.0, 1.0, kNaN, kInfinity}) {
    CHECK_FALSE(near(kNaN, value, any));
    CHECK_FALSE(near(value, kNaN, any));
  }
  CHECK_FALSE(near(kInfinity, 1, any));
  CHECK_FALSE(near(1, kInfinity, any));
  CHECK_FALSE(near(kInfinity, -kInfinity, any));
  CHECK(near(kInfinity, kInfinity, {}));
  CHECK_FALSE(near(1, 2, {.relative = kNaN, .absolute = kNaN}));
  CHECK_FALSE(near(Vec3{0, kNaN, 0}, Vec3{0, kNaN, 0}, any));
}

TEST_CASE("vectors are as near as their difference is short") {
  CHECK(near(Vec3{1, 2, 3}, Vec3{1, 2, 3}, {}));
  CHECK_FALSE(near(Vec3{1, 2, 3 + 2 * kUlp}, Vec3{1, 2, 3}, {}));
  CHECK(near(Vec3{3, 4, 12}, Vec3{0, 0, 12}, {.absolute = 5}));
  CHECK_FALSE(near(Vec3{3, 4, 12}, Vec3{0, 0, 12}, {.absolute = 4.99}));
  CHECK(near(Vec3{0, 5, 0}, Vec3{3, 4, 0}, {.relative = 0.64}));
  CHECK_FALSE(near(Vec3{0, 5, 0}, Vec3{3, 4, 0}, {.relative = 0.63}));
}

TEST_CASE("values that are not near are reported with all digits, the distance and the bounds") {
  CHECK(
      text(near(0.1, 0.2, {.relative = 0.25, .absolute = 1e-3})) ==
      "0.10000000000000001, expected 0.20000000000000001: 0.1 apart, 0.5 of it; allowed: 0.001, 0.25 of it");
  CHECK(text(near(Vec3{3, 4, 0}, Vec3{}, {})) ==
        "(3, 4, 0), expected (0, 0, 0): 5 apart, inf of it; allowed: 0, 0 of it");
}

TEST_CASE("an error must be below what is promised and below three times what was measured") {
  const Bars bars{.promise = 1e-3, .measured = 1e-5};
  CHECK(keeps(0, bars));
  CHECK(keeps(-3e-5, bars));
  CHECK_FALSE(keeps(3.1e-5, bars));
  CHECK_FALSE(keeps(-3.1e-5, bars));
  CHECK_FALSE(keeps(kNaN, bars));
  CHECK_FALSE(keeps(1e-3, {.promise = 1e-3, .measured = 9e-4}));
  CHECK(keeps(9.9e-4, {.promise = 1e-3, .measured = 9e-4}));
  CHECK(text(keeps(2e-3, bars)) == "error 0.002, promised 0.001, measured 1e-05: the promise is broken");
  CHECK(text(keeps(5e-4, bars)) ==
        "error 0.0005, promised 0.001, measured 1e-05: more than three times as large as it was");
}

}  // namespace scree
