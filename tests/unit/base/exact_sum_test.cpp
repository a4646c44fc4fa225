// Exact sums: the same bits in any order and for any split, and as near to the true sum as a double can be.
#include "base/exact_sum.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "support/bits.hpp"
#include "support/catch.hpp"

namespace scree {

namespace {

ExactSum sum_of(const std::vector<Real>& terms) {
  ExactSum sum;
  for (const Real term : terms) sum.add(term);
  return sum;
}

std::vector<Real> random_terms(std::mt19937_64& engine, int count, int exponents) {
  std::uniform_real_distribution<Real> mantissa(-1, 1);
  std::uniform_int_distribution<int> exponent(-exponents, exponents);
  std::vector<Real> terms;
  for (int i = 0; i < count; ++i) terms.push_back(std::ldexp(mantissa(engine), exponent(engine)));
  return terms;
}

}  // namespace

TEST_CASE("order and split do not change a bit of an exact sum") {
  std::mt19937_64 engine(7);
  for (const int exponents : {0, 3, 40, 500}) {
    CAPTURE(exponents);
    for (int trial = 0; trial < 200; ++trial) {
      std::vector<Real> terms = random_terms(engine, 1 + trial, exponents);
      const Real value = sum_of(terms).value();
      std::shuffle(terms.begin(), terms.end(), engine);
      CHECK(same_bits(sum_of(terms).value(), value));
      ExactSum parts[4];
      for (std::size_t i = 0; i < terms.size(); ++i) parts[engine() % 4].add(terms[i]);
      std::shuffle(std::begin(parts), std::end(parts), engine);
      ExactSum whole;
      for (const ExactSum& part : parts) whole.add(part);
      CHECK(same_bits(whole.value(), value));
    }
  }
}

TEST_CASE("an exact sum is right to 2^-64 of its largest term, and to the rounding of its value") {
  std::mt19937_64 engine(11);
  for (int trial = 0; trial < 300; ++trial) {
    const std::vector<Real> terms = random_terms(engine, 100, 20);
    __float128 exact = 0;
    Real largest = 0;
    for (const Real term : terms) exact += term, largest = std::max(largest, std::abs(term));
    const Real value = sum_of(terms).value();
    const auto error = static_cast<Real>(exact - value);
    const Real cut = 100 * std::ldexp(largest, -64);
    CHECK(std::abs(error) <= cut + std::ldexp(std::abs(value), -53));
  }
}

TEST_CASE("one term is its own sum, and terms cancel") {
  std::mt19937_64 engine(3);
  for (const Real term : random_terms(engine, 500, 900)) {
    CHECK(same_bits(sum_of({term}).value(), term));
    CHECK(sum_of({term, 3 * term, -term, -3 * term}).value() == 0);
  }
  CHECK(sum_of({}).value() == 0);
  CHECK(sum_of({0.0, -0.0}).value() == 0);
  CHECK(sum_of({1e300, 1.0, -1e300}).value() ==
        0);  // 1 is below the resolution of the sum, whatever the order
  CHECK(sum_of({1.0, 1e300, -1e300}).value() == 0);
  CHECK(sum_of({1.0, std::numeric_limits<Real>::denorm_min()}).value() == 1);
  CHECK(sum_of({std::numeric_limits<Real>::max()}).value() == std::numeric_limits<Real>::max());
}

TEST_CASE("a term that is not finite makes an exact sum a NaN") {
  for (const Real bad : {std::nan(""), std::numeric_limits<Real>::infinity()}) {
    CHECK(std::isnan(sum_of({1, bad, 2}).value()));
    ExactSum whole = sum_of({1, 2});
    whole.add(sum_of({bad}));
    whole.add(sum_of({3}));
    CHECK(std::isnan(whole.value()));
  }
}

}  // namespace scree
