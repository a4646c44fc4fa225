// Scalar functions of time with two derivatives: for drivers, actuators and applied forces.
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

// Ramp f = value + rate t; t [s].
SCREE_HD TimeValue ramp_function(Real value, Real rate, Real t) { return {value + rate * t, rate, 0}; }

// Eased ramp: f = value before t0, and a straight line of slope `rate` after t1; between them, with T = t1 -
// t0 and s = (t - t0)/T,
//   f = value + rate T s^3 (1 - s/2),  f' = rate s^2 (3 - 2 s),  f'' = 6 rate/T s (1 - s):
// twice continuously differentiable. t0 < t1 [s].
SCREE_HD TimeValue eased_ramp_function(Real value, Real rate, Real t0, Real t1, Real t) {
  if (t <= t0) return {value, 0, 0};
  const Real duration = t1 - t0, s = (t - t0) / duration;
  if (t >= t1) return {value + rate * ((t - t1) + duration / 2), rate, 0};
  return {value + rate * duration * (s * s * s * (1 - s / 2)), rate * (s * s * (3 - 2 * s)),
          6 * (rate / duration) * (s * ((t1 - t) / duration))};
}

// Sine f = value + amplitude sin(2 pi frequency t + phase); frequency [Hz], phase [rad].
SCREE_HD TimeValue sine_function(Real value, Real amplitude, Real frequency, Real phase, Real t) {
  const Real omega = 2 * std::numbers::pi_v<Real> * frequency;
  const Real s = std::sin(omega * t + phase), c = std::cos(omega * t + phase);
  return {value + amplitude * s, amplitude * omega * c, -amplitude * omega * omega * s};
}

// Smooth step: f = value before t0, end_value after t1; between them, with T = t1 - t0, s = (t - t0)/T and r
// = end_value - value,
//   f = value + r s^3 (10 - 15 s + 6 s^2),  f' = 30 r/T s^2 (1 - s)^2,  f'' = 60 r/T^2 s (1 - s) (1 - 2 s):
// twice continuously differentiable, and within [value, end_value]. t0 < t1 [s].
SCREE_HD TimeValue step_function(Real value, Real end_value, Real t0, Real t1, Real t) {
  if (t <= t0) return {value, 0, 0};
  if (t >= t1) return {end_value, 0, 0};
  const Real duration = t1 - t0, s = (t - t0) / duration, left = (t1 - t) / duration;
  const Real rise = end_value - value, slope = rise / duration;
  return {value + rise * (s * s * s * (10 + s * (6 * s - 15))), 30 * slope * (s * s * left * left),
          60 * (slope / duration) * (s * left * (left - s))};
}

// One piece of a quintic spline: times [s], values [u], rates [u/s] and second derivatives [u/s^2] at its two
// ends.
struct QuinticSegment {
  Real t0, t1, f0, f1, d0, d1, m0, m1;
};

// Quintic polynomial of a segment. With d = t1 - t0, s = (t - t0)/d:
//   f = f0 + d d0 s + d^2 m0/2 s^2 + s^3 (c3 + c4 s + c5 s^2).
SCREE_HD TimeValue quintic_function(const QuinticSegment& q, Real t) {
  const Real d = q.t1 - q.t0, s = (t - q.t0) / d, rise = q.f1 - q.f0;
  const Real a0 = d * q.d0, a1 = d * q.d1, b0 = d * d * q.m0 / 2, b1 = d * d * q.m1 / 2;
  const Real c3 = 10 * rise - 6 * a0 - 4 * a1 - 3 * b0 + b1;
  const Real c4 = -15 * rise + 8 * a0 + 7 * a1 + 3 * b0 - 2 * b1;
  const Real c5 = 6 * rise - 3 * a0 - 3 * a1 - b0 + b1;
  return {q.f0 + s * (a0 + s * (b0 + s * (c3 + s * (c4 + s * c5)))),
          (a0 + s * (2 * b0 + s * (3 * c3 + s * (4 * c4 + s * 5 * c5)))) / d,
          (2 * b0 + s * (6 * c3 + s * (12 * c4 + s * 20 * c5))) / (d * d)};
}

// One piece of a cubic spline: times [s], values [u] and second derivatives [u/s^2] at its two ends.
struct SplineSegment {
  Real t0, t1, f0, f1, m0, m1;
};

// Cubic polynomial of a segment. With d = t1 - t0, a = (t1 - t)/d, b = (t - t0)/d:
//   f = a f0 + b f1 + ((a^3 - a) m0 + (b^3 - b) m1) d^2 / 6,   f'' = a m0 + b m1.
SCREE_HD TimeValue spline_function(const SplineSegment& s, Real t) {
  const Real d = s.t1 - s.t0, a = (s.t1 - t) / d, b = (t - s.t0) / d;
  return {a * s.f0 + b * s.f1 + ((a * a * a - a) * s.m0 + (b * b * b - b) * s.m1) * (d * d / 6),
          (s.f1 - s.f0) / d + ((1 - 3 * a * a) * s.m0 + (3 * b * b - 1) * s.m1) * (d / 6),
          a * s.m0 + b * s.m1};
}

}  // namespace scree
