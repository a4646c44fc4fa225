// Scalar functions of time with two derivatives: the motions of drivers, actuators and applied forces.
#pragma once

#include <cmath>
#include <numbers>

#include "base/hd.hpp"
#include "base/types.hpp"

namespace scree {

// A function at one instant, in the function's unit u: value [u], rate [u/s], acceleration [u/s^2].
struct TimeValue {
  Real value = 0, rate = 0, acceleration = 0;
};

// f = value + rate t; t [s].
SCREE_HD TimeValue ramp_function(Real value, Real rate, Real t) { return {value + rate * t, rate, 0}; }

// f = value + amplitude sin(2 pi frequency t + phase); frequency [Hz], phase [rad].
SCREE_HD TimeValue sine_function(Real value, Real amplitude, Real frequency, Real phase, Real t) {
  const Real omega = 2 * std::numbers::pi_v<Real> * frequency;
  const Real s = std::sin(omega * t + phase), c = std::cos(omega * t + phase);
  return {value + amplitude * s, amplitude * omega * c, -amplitude * omega * omega * s};
}

// One piece of a cubic spline: times [s], values [u] and second derivatives [u/s^2] at its two ends.
struct SplineSegment {
  Real t0, t1, f0, f1, m0, m1;
};

// With d = t1 - t0, a = (t1 - t)/d, b = (t - t0)/d:
//   f = a f0 + b f1 + ((a^3 - a) m0 + (b^3 - b) m1) d^2 / 6,   f'' = a m0 + b m1.
SCREE_HD TimeValue spline_function(const SplineSegment& s, Real t) {
  const Real d = s.t1 - s.t0, a = (s.t1 - t) / d, b = (t - s.t0) / d;
  return {a * s.f0 + b * s.f1 + ((a * a * a - a) * s.m0 + (b * b * b - b) * s.m1) * (d * d / 6),
          (s.f1 - s.f0) / d + ((1 - 3 * a * a) * s.m0 + (3 * b * b - 1) * s.m1) * (d / 6),
          a * s.m0 + b * s.m1};
}

}  // namespace scree
