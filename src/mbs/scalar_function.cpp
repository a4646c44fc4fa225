#include "mbs/scalar_function.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"

namespace scree {

ScalarFunction::ScalarFunction(const TimeFunction& function, const std::string& owner, Real end,
                               Interpolation interpolation)
    : function_(function), second_derivatives_(function.times.size(), 0) {
  if (function.kind != TimeFunction::Kind::table) return;
  check_table(owner, end);
  if (interpolation == Interpolation::spline) find_second_derivatives();
}

void ScalarFunction::check_table(const std::string& owner, Real end) const {
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
  if (times.front() > 0 || times.back() < end) {
    throw InputError(
        fmt::format("{}: the table covers {} s to {} s; it must cover the whole run, 0 s to {} s", owner,
                    times.front(), times.back(), end));
  }
}

// Continuity of f' at the inner points, with d_i = t_{i+1} - t_i:
//   d_{i-1} m_{i-1} + 2 (d_{i-1} + d_i) m_i + d_i m_{i+1} = 6 (s_i - s_{i-1}),  s_i = (f_{i+1} - f_i)/d_i,
// and m = 0 at both ends; the tridiagonal system is diagonally dominant and needs no pivoting.
void ScalarFunction::find_second_derivatives() {
  const std::vector<Real>&t = function_.times, &f = function_.values;
  const std::size_t n = t.size();
  std::vector<Real> upper(n, 0);
  std::vector<Real>& m = second_derivatives_;
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const Real left = t[i] - t[i - 1], right = t[i + 1] - t[i];
    const Real rhs = 6 * ((f[i + 1] - f[i]) / right - (f[i] - f[i - 1]) / left);
    const Real pivot = 2 * (left + right) - left * upper[i - 1];
    upper[i] = right / pivot;
    m[i] = (rhs - left * m[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 1;) m[i] -= upper[i] * m[i + 1];
}

// Of tables: the same points, and second derivatives there, of all pieces that begin before t.
bool ScalarFunction::same_until(const ScalarFunction& other, Real t) const {
  const TimeFunction &a = function_, &b = other.function_;
  if (a.kind != b.kind) return false;
  if (a.kind != TimeFunction::Kind::table)
    return a.value == b.value && a.rate == b.rate && a.amplitude == b.amplitude &&
           a.frequency == b.frequency && a.phase == b.phase;
  const auto before = std::lower_bound(a.times.begin(), a.times.end(), t) - a.times.begin();
  const auto points = std::min(static_cast<std::size_t>(before) + 1, a.times.size());
  if (points > b.times.size() || (t > a.times.back() && a.times.size() != b.times.size())) return false;
  const auto same = [points](const std::vector<Real>& x, const std::vector<Real>& y) {
    return std::equal(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(points), y.begin());
  };
  return same(a.times, b.times) && same(a.values, b.values) &&
         same(second_derivatives_, other.second_derivatives_);
}

TimeValue ScalarFunction::table_value(Real t) const {
  const std::vector<Real>& times = function_.times;
  const Real inside = std::clamp(t, times.front(), times.back());
  const auto after = std::upper_bound(times.begin() + 1, times.end() - 1, inside);
  const std::size_t i = static_cast<std::size_t>(after - times.begin()) - 1;
  const TimeValue at = spline_function({times[i], times[i + 1], function_.values[i], function_.values[i + 1],
                                        second_derivatives_[i], second_derivatives_[i + 1]},
                                       inside);
  return {at.value + at.rate * (t - inside), at.rate, at.acceleration};
}

TimeValue ScalarFunction::moving_value(Real t) const {
  switch (function_.kind) {
    case TimeFunction::Kind::ramp:
      return ramp_function(function_.value, function_.rate, t);
    case TimeFunction::Kind::sine:
      return sine_function(function_.value, function_.amplitude, function_.frequency, function_.phase, t);
    case TimeFunction::Kind::constant:
    case TimeFunction::Kind::table:
      break;
  }
  return table_value(t);
}

}  // namespace scree
