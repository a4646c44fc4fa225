#include <cmath>
#include <random>

#include "support/catch.hpp"
#include "support/device_roots.hpp"

namespace scree {

TEST_CASE("roots and reciprocals are the same on the device") {
  std::vector<Real> numbers;
  // Beside powers of two, where a rounding decides the exponent; products of unit vectors with themselves are
  // often the last number below one.
  for (int exponent = -300; exponent <= 300; ++exponent) {
    Real below = std::ldexp(Real(1), exponent), above = below;
    for (int k = 0; k < 8; ++k) {
      numbers.push_back(above), numbers.push_back(below);
      below = std::nextafter(below, Real(0)), above = std::nextafter(above, kInfinity);
    }
  }
  std::mt19937_64 random(7);
  std::uniform_real_distribution<Real> mantissa(1, 2);
  std::uniform_int_distribution<int> exponent(-300, 300);
  for (int k = 0; k < 1000000; ++k) numbers.push_back(std::ldexp(mantissa(random), exponent(random)));
  const std::vector<Roots> roots = roots_on_device(numbers);
  int wrong = 0;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const Roots expected = roots_of(numbers[k]);
    wrong += roots[k].both.root != expected.both.root || roots[k].both.inverse != expected.both.inverse ||
             roots[k].reciprocal != expected.reciprocal || roots[k].root != expected.root ||
             roots[k].inverse != expected.inverse || roots[k].quotient != expected.quotient;
  }
  CHECK(wrong == 0);
}

TEST_CASE("the root of zero and reciprocals of infinity are the same on the device") {
  const std::vector<Roots> roots = roots_on_device({0, kInfinity});
  CHECK(roots[0].root == 0);
  CHECK(roots[1].inverse == 0);
  CHECK(roots[1].quotient == 0);
}

}  // namespace scree
