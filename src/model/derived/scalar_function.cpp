#include "model/derived/scalar_function.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/error.hpp"

namespace scree {

ScalarFunction::ScalarFunction(const TimeFunction& function, const std::string& owner, Real end)
    : function_(function), rates_(function.times.size(), 0), second_derivatives_(function.times.size(), 0) {
  if (function.kind != TimeFunction::Kind::table) return;
  check_points(owner);
  check_cover(owner, end);
  find_rates();
}

ScalarFunction::ScalarFunction(const Curve& curve, const std::string& owner)
    : rates_(curve.at.size(), 0), second_derivatives_(curve.at.size(), 0) {
  if (curve.at.empty()) return;
  function_.kind = TimeFunction::Kind::table;
  function_.times = curve.at;
  function_.values = curve.values;
  function_.interpolation = curve.interpolation;
  check_points(owner);
  find_rates();
}

void ScalarFunction::find_rates() {
  if (function_.interpolation == Interpolation::linear) return;
  function_.interpolation == Interpolation::monotone ? find_monotone() : find_spline();
}

void ScalarFunction::check_points(const std::string& owner) const {
  const std::vector<Real>& times = function_.times;
  if (times.size() < 2 || times.size() != function_.values.size()) {
    throw InputError(
        fmt::format("{}: a table needs at least two points and as many values as times; it has {} times "
                    "and {} values",
                    owner, times.size(), function_.values.size()));
  }
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (!(times[i] > times[i - 1])) {
      throw InputError(fmt::format("{}: times of a table must increase; {} s follows {} s", owner, times[i],
                                   times[i - 1]));
    }
  }
}

void ScalarFunction::check_cover(const std::string& owner, Real end) const {
  const std::vector<Real>& times = function_.times;
  if (times.front() > 0 || times.back() < end) {
    throw InputError(
        fmt::format("{}: the table covers {} s to {} s; it must cover the whole run, 0 s to {} s", owner,
                    times.front(), times.back(), end));
  }
}

Real ScalarFunction::slope(std::size_t i) const {
  return (function_.values[i + 1] - function_.values[i]) / (function_.times[i + 1] - function_.times[i]);
}

// Continuity of f' at the inner points, with d_i = t_{i+1} - t_i:
//   d_{i-1} m_{i-1} + 2 (d_{i-1} + d_i) m_i + d_i m_{i+1} = 6 (s_i - s_{i-1}),  s_i = (f_{i+1} - f_i)/d_i,
// and at the ends m = 0 (natural), or with the given rates r (clamped)
//   2 d_0 m_0 + d_0 m_1 = 6 (s_0 - r_0),  d_{n-2} m_{n-2} + 2 d_{n-2} m_{n-1} = 6 (r_1 - s_{n-2});
// the tridiagonal system is diagonally dominant and needs no pivoting.
void ScalarFunction::find_spline() {
  const std::vector<Real>&t = function_.times, &f = function_.values;
  const std::size_t n = t.size();
  const bool clamped = function_.interpolation == Interpolation::clamped;
  std::vector<Real> upper(n, 0);
  std::vector<Real>& m = second_derivatives_;
  if (clamped) {
    upper[0] = Real(0.5);
    m[0] = 3 * (slope(0) - function_.end_rates[0]) / (t[1] - t[0]);
  }
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const Real left = t[i] - t[i - 1], right = t[i + 1] - t[i];
    const Real rhs = 6 * ((f[i + 1] - f[i]) / right - (f[i] - f[i - 1]) / left);
    const Real pivot = 2 * (left + right) - left * upper[i - 1];
    upper[i] = right / pivot;
    m[i] = (rhs - left * m[i - 1]) / pivot;
  }
  if (clamped) {
    const Real last = t[n - 1] - t[n - 2];
    m[n - 1] = (6 * (function_.end_rates[1] - slope(n - 2)) / last - m[n - 2]) / (2 - upper[n - 2]);
  }
  for (std::size_t i = n - 1; i-- > (clamped ? 0 : 1);) m[i] -= upper[i] * m[i + 1];
}

// Rate and second derivative at each point are those of the parabola through it and its two neighbours (at
// the ends, the nearest three points), as far as they keep f' of one sign on the two segments beside it. In
// Bernstein's form on a segment of length d and slope s the coefficients of f' are
//   d0,  d0 + d m0/4,  5 s - 2 (d0 + d1) + d (m1 - m0)/4,  d1 - d m1/4,  d1;
// all of them have the sign of s where at each end, apart from the sign of s, |rate| <= 1.25 |s| and m lies
// within monotone_bend()'s limits: half of the third coefficient belongs to each end.
void ScalarFunction::find_monotone() {
  const std::vector<Real>& t = function_.times;
  const std::size_t n = t.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t middle = n < 3 ? 0 : std::clamp<std::size_t>(i, 1, n - 2);
    Real rate = slope(0), bend = 0;
    if (n > 2) {
      const Real left = slope(middle - 1), right = slope(middle), all = t[middle + 1] - t[middle - 1];
      bend = 2 * (right - left) / all;
      rate = left + bend / 2 * (t[middle] - t[middle - 1]) + bend * (t[i] - t[middle]);
    }
    rates_[i] = monotone_rate(i, rate);
    second_derivatives_[i] = monotone_bend(i, bend);
  }
}

// 0 where the segments on either side differ in the sign of their slopes, or one of them is constant.
Real ScalarFunction::monotone_rate(std::size_t point, Real parabola) const {
  constexpr Real kSteepest = 1.25;
  const std::size_t last = function_.times.size() - 2;
  const Real left = slope(point == 0 ? 0 : point - 1), right = slope(std::min(point, last));
  if (left > 0 && right > 0) return std::clamp<Real>(parabola, 0, kSteepest * std::min(left, right));
  if (left < 0 && right < 0) return std::clamp<Real>(parabola, kSteepest * std::max(left, right), 0);
  return 0;
}

// With r = rate: as the left end of a rising segment, -4 r/d <= m <= (10 s - 8 r)/d; as its right end with
// the opposite sign; on a falling segment, both with the opposite sign.
Real ScalarFunction::monotone_bend(std::size_t point, Real parabola) const {
  Real low = -kInfinity, high = -low;  // 0 lies between the limits except for round-off
  for (std::size_t segment = point == 0 ? 0 : point - 1; segment < std::min(point + 1, rates_.size() - 1);
       ++segment) {
    const Real length = function_.times[segment + 1] - function_.times[segment], s = slope(segment);
    const Real side = segment == point ? 1 : -1;
    const Real first = -4 * side * rates_[point] / length;
    const Real second = side * (10 * s - 8 * rates_[point]) / length;
    low = std::max(low, std::min(first, second));
    high = std::min(high, std::max(first, second));
  }
  return std::clamp(parabola, std::min<Real>(low, 0), std::max<Real>(high, 0));
}

TimeValue ScalarFunction::segment_value(std::size_t i, Real t) const {
  const std::vector<Real>&times = function_.times, &values = function_.values;
  const std::vector<Real>& bends = second_derivatives_;
  if (function_.interpolation == Interpolation::monotone)
    return quintic_function(
        {times[i], times[i + 1], values[i], values[i + 1], rates_[i], rates_[i + 1], bends[i], bends[i + 1]},
        t);
  return spline_function({times[i], times[i + 1], values[i], values[i + 1], bends[i], bends[i + 1]}, t);
}

// For tables: points, rates and second derivatives are equal in all segments that begin before t.
bool ScalarFunction::same_until(const ScalarFunction& other, Real t) const {
  const TimeFunction &a = function_, &b = other.function_;
  if (a.kind != b.kind) return false;
  if (a.kind != TimeFunction::Kind::table)
    return a.value == b.value && a.rate == b.rate && a.amplitude == b.amplitude &&
           a.frequency == b.frequency && a.phase == b.phase && a.end_value == b.end_value &&
           a.start == b.start && a.end == b.end;
  if (a.interpolation != b.interpolation) return false;
  const auto before = std::lower_bound(a.times.begin(), a.times.end(), t) - a.times.begin();
  const auto points = std::min(static_cast<std::size_t>(before) + 1, a.times.size());
  if (points > b.times.size() || (t > a.times.back() && a.times.size() != b.times.size())) return false;
  const auto same = [points](const std::vector<Real>& x, const std::vector<Real>& y) {
    return std::equal(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(points), y.begin());
  };
  return same(a.times, b.times) && same(a.values, b.values) && same(rates_, other.rates_) &&
         same(second_derivatives_, other.second_derivatives_);
}

// With b = (t - t_i)/d, f' = slope + d/6 ((3 b^2 - 1) m_1 - (3 (1 - b)^2 - 1) m_0) is quadratic in b.
Overshoot ScalarFunction::overshoot() const {
  Overshoot farthest;
  const bool spline =
      function_.kind == TimeFunction::Kind::table && (function_.interpolation == Interpolation::natural ||
                                                      function_.interpolation == Interpolation::clamped);
  for (std::size_t i = 0; spline && i + 1 < function_.times.size(); ++i) {
    const Real d = function_.times[i + 1] - function_.times[i];
    const Real m0 = second_derivatives_[i], m1 = second_derivatives_[i + 1];
    const Real a = d / 2 * (m1 - m0), b = d * m0, c = slope(i) - d / 6 * (2 * m0 + m1);
    const Real q = -(b + std::copysign(std::sqrt(std::max<Real>(b * b - 4 * a * c, 0)), b)) / 2;
    for (const Real root : {q / a, c / q}) {
      if (!(root > 0 && root < 1)) continue;
      const Real t = function_.times[i] + root * d, value = segment_value(i, t).value;
      const auto [low, high] = std::minmax(function_.values[i], function_.values[i + 1]);
      const Real beyond = value - std::clamp(value, low, high);
      if (std::abs(beyond) > std::abs(farthest.beyond)) farthest = {i, t, value, beyond};
    }
  }
  return farthest;
}

TimeValue ScalarFunction::table_value(Real t) const {
  const std::vector<Real>& times = function_.times;
  const Real inside = std::clamp(t, times.front(), times.back());
  const auto after = std::upper_bound(times.begin() + 1, times.end() - 1, inside);
  const TimeValue at = segment_value(static_cast<std::size_t>(after - times.begin()) - 1, inside);
  return {at.value + at.rate * (t - inside), at.rate, at.acceleration};
}

TimeValue ScalarFunction::moving_value(Real t) const {
  switch (function_.kind) {
    case TimeFunction::Kind::ramp:
      return function_.end > function_.start
                 ? eased_ramp_function(function_.value, function_.rate, function_.start, function_.end, t)
                 : ramp_function(function_.value, function_.rate, t);
    case TimeFunction::Kind::sine:
      return sine_function(function_.value, function_.amplitude, function_.frequency, function_.phase, t);
    case TimeFunction::Kind::step:
      return step_function(function_.value, function_.end_value, function_.start, function_.end, t);
    case TimeFunction::Kind::table:
      return table_value(t);
    case TimeFunction::Kind::constant:
      return {function_.value, 0, 0};
  }
  throw std::logic_error("a function of time of no kind");
}

}  // namespace scree
