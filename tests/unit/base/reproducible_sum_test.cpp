// The sum gives the same bits in any order and is as exact as its quantum.
#include "base/reproducible_sum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "support/catch.hpp"

namespace scree {

namespace {

constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();

Real sum_of(const std::vector<Real>& terms) {
  struct Term {
    Real value[1];
  };
  Real sum[1];
  const auto term = [&](Index i) { return Term{{terms[static_cast<std::size_t>(i)]}}; };
  reproducible_sums(static_cast<Index>(terms.size()), term, sum);
  return sum[0];
}

// Terms of both signs whose magnitudes spread over 2^-spread to 1.
std::vector<Real> mixed_terms(int count, int spread, std::mt19937_64& random) {
  std::vector<Real> terms;
  for (int i = 0; i < count; ++i) {
    const Real mantissa = std::ldexp(static_cast<Real>(static_cast<std::int64_t>(random())), -63);
    terms.push_back(std::ldexp(mantissa, -static_cast<int>(random() % static_cast<unsigned>(spread))));
  }
  return terms;
}

}  // namespace

TEST_CASE("a sum has the same bits in any order") {
  std::mt19937_64 random(1);
  for (const int spread : {1, 30, 200}) {
    CAPTURE(spread);
    std::vector<Real> terms = mixed_terms(1000, spread, random);
    const Real sum = sum_of(terms);
    for (int shuffle = 0; shuffle < 20; ++shuffle) {
      std::shuffle(terms.begin(), terms.end(), random);
      CHECK(sum_of(terms) == sum);
    }
    std::sort(terms.begin(), terms.end());
    CHECK(sum_of(terms) == sum);
  }
}

TEST_CASE("a sum is exact to a quantum per term and the last rounding") {
  std::mt19937_64 random(2);
  for (const int spread : {1, 30, 200}) {
    CAPTURE(spread);
    const std::vector<Real> terms = mixed_terms(1000, spread, random);
    long double exact = 0;  // rounding of the sum itself: 1000 terms of at most 1 at 2^-64
    for (const Real term : terms) exact += term;
    const Real sum = sum_of(terms);
    CHECK(std::abs(static_cast<Real>(sum - exact)) <=
          std::ldexp(1000.0, -61) + std::ldexp(std::abs(sum), -53));
  }
}

TEST_CASE("small terms survive beside large ones that cancel") {
  CHECK(sum_of({1e16, 1, -1e16}) == 1);
  CHECK(sum_of({1, 1e16, 2, -1e16, 3}) == 6);
  std::vector<Real> terms(100000, 0.5);
  terms.push_back(1e15), terms.push_back(-1e15);
  CHECK(sum_of(terms) == 50000);
}

TEST_CASE("sums of nothing, of zeros, of one term and of powers of two") {
  CHECK(sum_of({}) == 0);
  CHECK(sum_of({0, -0.0, 0}) == 0);
  for (const Real term : {1.0, -1.0, 0x1p60, 0x1p-60, 3.0, 0.1, -1e300, 1e-200}) {
    CAPTURE(term);
    CHECK(sum_of({term}) == term);
    CHECK(sum_of({term, term}) == 2 * term);
    CHECK(sum_of({term, -term}) == 0);
  }
}

TEST_CASE("the largest and the smallest numbers do no harm") {
  const Real largest = std::numeric_limits<Real>::max(), smallest = std::numeric_limits<Real>::denorm_min();
  CHECK(sum_of({largest, -largest}) == 0);
  CHECK(sum_of({largest}) == largest);
  CHECK(std::abs(sum_of({smallest, smallest})) <= 2 * smallest);
}

TEST_CASE("a term that is not finite makes the sum a NaN, at any position") {
  for (const Real bad : {kNan, kInfinity, -kInfinity}) {
    CAPTURE(bad);
    for (std::size_t place = 0; place < 5; ++place) {
      std::vector<Real> terms{1, 2, 3, 4, 5};
      terms[place] = bad;
      CHECK(std::isnan(sum_of(terms)));
    }
  }
  CHECK(std::isnan(sum_of({kInfinity, -kInfinity, kNan, 1})));
}

TEST_CASE("terms that come from several sums add up to the same bits") {
  std::mt19937_64 random(3);
  const std::vector<Real> terms = mixed_terms(500, 60, random);
  const Real sum = sum_of(terms);
  Real largest = 0;
  for (const Real term : terms) largest = std::max(largest, std::abs(term));
  const ReproducibleScale scale(largest);
  __int128 quanta = 0;
  for (std::size_t i = 0; i < terms.size(); i += 2) quanta += scale.quanta(terms[i]);
  for (std::size_t i = 1; i < terms.size(); i += 2) quanta += scale.quanta(terms[i]);
  CHECK(scale.value(quanta) == sum);
}

}  // namespace scree
