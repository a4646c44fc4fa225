// Elementary functions of + - * / and square roots against those of the library.
#include "base/elementary.hpp"

#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kDigits = 1e-14;

}  // namespace

TEST_CASE("the cube root is exact to the last places") {
  for (const Real x : {1e-30, 3e-7, 0.5, 1.0, 8.0, 27.0, 1e12})
    CHECK(near(cube_root(x), std::cbrt(x), {.relative = 4 * kUlp}));
}

TEST_CASE("the exponential function, the logarithm and the arc tangent have 14 digits") {
  for (int k = -7000; k <= 7000; ++k) {
    const Real x = k * 0.0987654321;
    if (std::abs(x) <= 700) CHECK(near(exponential(x), std::exp(x), {.relative = kDigits}));
    const Real power = std::exp(x / 10);
    CHECK(near(logarithm(power), std::log(power), {.relative = kDigits, .absolute = kUlp}));
    CHECK(near(arc_tangent(x), std::atan(x), {.relative = kDigits}));
    CHECK(near(arc_tangent(power), std::atan(power), {.relative = kDigits}));
  }
  CHECK((exponential(0) == 1 && logarithm(1) == 0 && arc_tangent(0) == 0));
  CHECK(exponential(-1e9) == 0);
  for (const Real near_one : {1 + 1e-9, 1 - 1e-9, 1 + 3e-5})
    CHECK(near(logarithm(near_one), std::log(near_one), {.relative = kDigits}));
}

}  // namespace scree
