// The amount of particles that an inserter has due at any time: a closed-form function of time, so that
// births do not depend on the steps of a run.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/types.hpp"

namespace scree {

// The amount due is the integral of a piecewise linear rate over time, up to a total. The unit u of amounts
// is that of the inserter: particles, kilograms, or cubic metres of particles.
class BirthSchedule {
 public:
  // All of `total` [u] at one instant [s].
  static BirthSchedule at_once(Real instant, Real total) { return {{instant}, {}, total}; }
  // times: increasing, the last may be infinite [s]; rates: at these times, none negative, as many as times
  // [u/s]; 0 before the first and after the last. total: [u], may be infinite.
  static BirthSchedule by_rate(std::vector<Real> times, std::vector<Real> rates, Real total) {
    return {std::move(times), std::move(rates), total};
  }

  Real start() const { return times_.front(); }  // [s]
  Real end() const { return times_.back(); }     // [s]
  // The total amount of the whole schedule [u].
  Real total() const { return amounts_.back(); }

  // Amount due at time t [u].
  Real due(Real t) const {
    if (t < times_.front()) return 0;
    if (rates_.empty() || t >= times_.back()) return amounts_.back();
    const std::size_t k = segment(times_, t);
    const Real tau = t - times_[k];
    return std::min(amounts_[k] + tau * (rates_[k] + slope(k) * tau / 2), amounts_.back());
  }

  // The first instant at which the amount is due [s]; infinite above the total, apart from round-off.
  Real time_of(Real amount) const {
    if (amount > amounts_.back() * (1 + kRoundOff)) return kInfinity;
    if (rates_.empty() || amount <= 0) return times_.front();
    if (amount >= amounts_.back()) amount = amounts_.back();
    const auto above = std::lower_bound(amounts_.begin() + 1, amounts_.end(), amount);
    const auto k = static_cast<std::size_t>(std::min(above, amounts_.end() - 1) - amounts_.begin()) - 1;
    const Real rest = amount - amounts_[k], rate = rates_[k];
    const Real root = std::sqrt(std::max(rate * rate + 2 * slope(k) * rest, Real(0)));
    return rest > 0 ? std::min(times_[k] + 2 * rest / (rate + root), times_[k + 1]) : times_[k];
  }

  // Whether an amount counts as due: sums of rates reach their total up to round-off only.
  bool is_due(Real amount, Real t) const { return amount <= due(t) * (1 + kRoundOff); }

  // Largest rate [u/s]; infinite for an amount that is due at once.
  Real largest_rate() const {
    return rates_.empty() ? kInfinity : *std::max_element(rates_.begin(), rates_.end());
  }

 private:
  static constexpr Real kRoundOff = 1e-12;  // relative

  BirthSchedule(std::vector<Real> times, std::vector<Real> rates, Real total)
      : times_(std::move(times)), rates_(std::move(rates)), amounts_(times_.size(), 0) {
    for (std::size_t k = 0; k + 1 < times_.size(); ++k)
      amounts_[k + 1] = amounts_[k] + (times_[k + 1] - times_[k]) * (rates_[k] + rates_[k + 1]) / 2;
    if (rates_.empty()) amounts_.back() = total;
    for (Real& amount : amounts_) amount = std::min(amount, total);
  }
  static std::size_t segment(const std::vector<Real>& points, Real at) {
    const auto above = std::upper_bound(points.begin(), points.end(), at);
    return static_cast<std::size_t>(above - points.begin()) - 1;
  }
  Real slope(std::size_t k) const { return (rates_[k + 1] - rates_[k]) / (times_[k + 1] - times_[k]); }

  std::vector<Real> times_, rates_;  // one time and no rates: at once
  std::vector<Real> amounts_;        // due at the times
};

}  // namespace scree
