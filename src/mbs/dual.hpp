// A number with its derivatives by the inputs of a joint law at the end of a step.
#pragma once

#include "base/types.hpp"

namespace scree {

// Derivatives by the coordinate's value c, its rate c' and the load F at the end of the step.
struct Dual {
  Real value = 0, by_value = 0, by_rate = 0, by_load = 0;

  Dual() = default;
  Dual(Real constant) : value(constant) {}
  Dual(Real v, Real c, Real r, Real f) : value(v), by_value(c), by_rate(r), by_load(f) {}
};

// f(a, b) with the partial derivatives f_a, f_b.
inline Dual chained(Real f, Real f_a, const Dual& a, Real f_b, const Dual& b) {
  return {f, f_a * a.by_value + f_b * b.by_value, f_a * a.by_rate + f_b * b.by_rate,
          f_a * a.by_load + f_b * b.by_load};
}
inline Dual operator+(const Dual& a, const Dual& b) { return chained(a.value + b.value, 1, a, 1, b); }
inline Dual operator-(const Dual& a, const Dual& b) { return chained(a.value - b.value, 1, a, -1, b); }
inline Dual operator-(const Dual& a) { return chained(-a.value, -1, a, 0, a); }
inline Dual operator*(const Dual& a, const Dual& b) {
  return chained(a.value * b.value, b.value, a, a.value, b);
}
inline Dual operator/(const Dual& a, const Dual& b) {
  const Real quotient = a.value / b.value;
  return chained(quotient, 1 / b.value, a, -quotient / b.value, b);
}
// The smaller or larger argument, with its derivatives.
inline Dual smaller(const Dual& a, const Dual& b) { return b.value < a.value ? b : a; }
inline Dual larger(const Dual& a, const Dual& b) { return b.value > a.value ? b : a; }
inline Dual within(const Dual& a, const Dual& limit) { return larger(smaller(a, limit), -limit); }

}  // namespace scree
