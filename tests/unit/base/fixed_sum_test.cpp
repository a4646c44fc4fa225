// Fixed-point sums: the same limbs in any order, for any split and with carries at any time; exact to 2^-96
// a term; NaN for a term outside the range.
#include "base/fixed_sum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "support/bits.hpp"
#include "support/catch.hpp"

namespace scree {

namespace {

std::vector<Real> random_terms(std::mt19937_64& engine, int count, int lowest, int highest) {
  std::uniform_real_distribution<Real> mantissa(-1, 1);
  std::uniform_int_distribution<int> exponent(lowest, highest);
  std::vector<Real> terms;
  for (int i = 0; i < count; ++i) terms.push_back(std::ldexp(mantissa(engine), exponent(engine)));
  return terms;
}

FixedSum sum_of(const std::vector<Real>& terms) {
  FixedSum sum;
  for (const Real term : terms) sum.add(term);
  return sum;
}

bool same_words(FixedSum a, FixedSum b) {
  a.normalize(), b.normalize();
  return std::ranges::equal(a.word, b.word);
}

}  // namespace

TEST_CASE("order, split and carries do not change a bit of a fixed sum") {
  std::mt19937_64 engine(7);
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<Real> terms = random_terms(engine, 1 + trial, -110, 31);
    const FixedSum sum = sum_of(terms);
    std::ranges::shuffle(terms, engine);
    FixedSum parts[4], whole;
    for (const Real term : terms) {
      FixedSum& part = parts[engine() % 4];
      part.add(term);
      if (engine() % 8 == 0) part.normalize();
    }
    for (const FixedSum& part : parts) whole.add(part);
    CHECK(same_words(whole, sum));
    CHECK(same_bits(whole.value(), sum.value()));
  }
}

TEST_CASE("a fixed sum is right to 2^-96 of each term and to the rounding of its value") {
  std::mt19937_64 engine(11);
  for (const int highest : {-70, -40, 0, 10}) {
    for (int trial = 0; trial < 100; ++trial) {
      const std::vector<Real> terms = random_terms(engine, 100, -90, highest);
      __float128 exact = 0;
      for (const Real term : terms) exact += term;
      const Real value = sum_of(terms).value();
      CHECK(std::abs(static_cast<Real>(exact - value)) <=
            100 * std::ldexp(1.0, -96) + std::ldexp(std::abs(value), -53));
    }
  }
}

TEST_CASE("terms whose last bit is above the lowest limb are summed exactly, and cancel") {
  std::mt19937_64 engine(3);
  for (const Real term : random_terms(engine, 500, -40, 31)) {
    CHECK(same_bits(sum_of({term}).value(), term));
    CHECK(sum_of({term, 0.5 * term, -term, -0.5 * term}).value() == 0);
  }
  CHECK(sum_of({}).value() == 0);
  CHECK(sum_of({0.0, -0.0, std::numeric_limits<Real>::denorm_min()}).value() == 0);
  CHECK(sum_of({std::ldexp(1.0, -96)}).value() == std::ldexp(1.0, -96));
  CHECK(sum_of({std::ldexp(1.0, -97)}).value() == 0);
  CHECK(sum_of({-std::ldexp(1.75, -96)}).value() == -std::ldexp(1.0, -96));
  const Real largest = std::nextafter(std::ldexp(1.0, 32), 0.0);
  CHECK(sum_of({largest}).value() == largest);
  CHECK(sum_of({-largest, -largest}).value() == -2 * largest);
}

TEST_CASE("a fixed sum past 94 bits is rounded once, to the nearest") {
  const Real large = std::ldexp(1.0, 31), small = std::ldexp(1.0, -96);
  const Real half = std::ldexp(1.0, 31 - 53);     // half of the last bit
  CHECK(sum_of({large, half}).value() == large);  // rounded to even
  CHECK(sum_of({large, half, small}).value() == std::nextafter(large, 2 * large));
  CHECK(sum_of({-large, -half, -small}).value() == std::nextafter(-large, -2 * large));
  CHECK(sum_of({-large, -half, small}).value() == -large);
}

TEST_CASE("limbs carry what many terms leave in them") {
  FixedSum sum;
  const Real term = std::ldexp(1.0, 32) - 1;
  sum.add(term);
  for (int k = 0; k < 30; ++k) {  // 2^30 of them
    FixedSum twice = sum;
    twice.add(sum);
    sum = twice;
  }
  CHECK(sum.value() == std::ldexp(term, 30));
}

TEST_CASE("a term that is not finite or too large makes a fixed sum a NaN, in any order") {
  for (const Real bad : {std::nan(""), -std::numeric_limits<Real>::infinity(), std::ldexp(1.0, 32)}) {
    const FixedSum first = sum_of({bad, 1, 2});
    CHECK(std::isnan(first.value()));
    CHECK(same_words(first, sum_of({1, bad, 2})));
    FixedSum whole = sum_of({1, 2});
    whole.add(sum_of({bad}));
    CHECK(same_words(first, whole));
  }
}

}  // namespace scree
