// Numbers and vectors that agree within stated bounds.
#pragma once

#include <cmath>
#include <limits>
#include <ostream>

#include "base/types.hpp"
#include "base/vec3.hpp"

namespace scree {

// Distance from 1 to the next number, the unit of round-off.
inline constexpr Real kUlp = std::numeric_limits<Real>::epsilon();
// Relative difference of two evaluations of the same quantity in another order of operations: the round-off
// of some thousand operations.
inline constexpr Real kAccumulatedRoundOff = 1e-12;

// Largest distance of a value from the expected one, by the larger of the two bounds. An absent bound is
// zero.
struct Within {
  Real relative = 0;  // of the expected value's magnitude
  Real absolute = 0;  // in the unit of the values
};

// Result of near(): true where the value is near, with all data for a failure's message.
template <class Value>
struct Nearness {
  Value value, expected;
  Real difference, magnitude;  // difference of the two; magnitude of the expected one
  Within within;

  // NaN is near nothing, and infinity only itself, whatever the bounds.
  explicit operator bool() const {
    return std::isfinite(difference) &&
           (difference <= within.relative * magnitude || difference <= within.absolute);
  }
};

inline void put(std::ostream& out, Real value) { out << value; }
inline void put(std::ostream& out, Vec3 v) { out << '(' << v.x << ", " << v.y << ", " << v.z << ')'; }

template <class Value>
std::ostream& operator<<(std::ostream& out, const Nearness<Value>& near) {
  const auto digits = out.precision(std::numeric_limits<Real>::max_digits10);
  put(out, near.value), out << ", expected ", put(out, near.expected);
  out.precision(3);
  out << ": " << near.difference << " apart, " << near.difference / near.magnitude
      << " of it; allowed: " << near.within.absolute << ", " << near.within.relative << " of it";
  out.precision(digits);
  return out;
}

inline Nearness<Real> near(Real value, Real expected, Within within) {
  const Real difference = value == expected ? 0 : std::abs(value - expected);
  return {value, expected, difference, std::abs(expected), within};
}

inline Nearness<Vec3> near(Vec3 value, Vec3 expected, Within within) {
  const Real difference = value == expected ? 0 : norm(value - expected);
  return {value, expected, difference, norm(expected), within};
}

}  // namespace scree
