#include "model/derived/distribution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "base/elementary.hpp"

namespace scree {

namespace {

// x^power by multiplications, which have the same bits everywhere.
Real whole_power(Real x, int power) {
  Real result = 1;
  for (int k = 0; k < std::abs(power); ++k) result *= x;
  return power < 0 ? 1 / result : result;
}

// Nodes and weights of the Gauss-Legendre rule with five points on [-1, 1].
constexpr std::array<Real, 5> kNodes = {-0.90617984593866399, -0.53846931010568309, 0, 0.53846931010568309,
                                        0.90617984593866399};
constexpr std::array<Real, 5> kNodeWeights = {0.23692688505618909, 0.47862867049936647, 0.56888888888888889,
                                              0.47862867049936647, 0.23692688505618909};

template <class Function>
Real integral(Real from, Real to, const Function& function) {
  const Real half = (to - from) / 2, middle = (from + to) / 2;
  Real sum = 0;
  for (std::size_t k = 0; k < kNodes.size(); ++k)
    sum += kNodeWeights[k] * function(middle + half * kNodes[k]);
  return half * sum;
}

// Logarithm of the density by number with respect to t = ln x, up to a constant.
Real log_density(const DistributionParameters& p, int mass_power, Real t) {
  const Real by_mass = p.by == CountedBy::mass ? mass_power * t : 0;
  switch (p.kind) {
    case DistributionKind::normal: {
      const Real z = (exponential(t) - p.mean) / p.sd;
      return -z * z / 2 + t - by_mass;
    }
    case DistributionKind::lognormal: {
      const Real z = (t - logarithm(p.median)) / logarithm(p.geometric_sd);
      return -z * z / 2 - by_mass;
    }
    case DistributionKind::rosin_rammler: {
      const Real s = p.exponent * (t - logarithm(p.scale));
      return s - exponential(std::min(s, Real(700))) - by_mass;
    }
    default:
      throw std::logic_error("a distribution without a density");
  }
}

struct LogRange {
  Real low, high;
};

// The part of [ln min, ln max] outside which the density is below 1e-17 of its largest value, so that cells
// of equal width resolve a narrow peak.
LogRange support(const DistributionParameters& p, int mass_power) {
  const LogRange all{logarithm(p.min), logarithm(p.max)};
  const auto cut = [&](Real low, Real high) {
    const LogRange part{std::max(all.low, low), std::min(all.high, high)};
    return part.low < part.high ? part : all;
  };
  constexpr Real kWide = 40;  // standard deviations; the weight by mass moves the peak by a few
  const int shift = p.by == CountedBy::mass ? mass_power : 0;
  switch (p.kind) {
    case DistributionKind::normal: {
      const Real low = p.mean - kWide * p.sd;
      return cut(low > 0 ? logarithm(low) : all.low, logarithm(p.mean + kWide * p.sd));
    }
    case DistributionKind::lognormal: {
      const Real sd = logarithm(p.geometric_sd), peak = logarithm(p.median) - shift * sd * sd;
      return cut(peak - kWide * sd, peak + kWide * sd);
    }
    default: {
      const Real scale = logarithm(p.scale), rise = p.exponent - shift;  // slope far below the scale
      return cut(rise > 0 ? scale - kWide / rise : all.low, scale + 7 / p.exponent);
    }
  }
}

// Integral of x^(s - 1) from a to b.
Real power_integral(Real a, Real b, int s) {
  return s == 0 ? logarithm(b / a) : (whole_power(b, s) - whole_power(a, s)) / s;
}

Real normal_tail(Real z) { return std::erfc(z / std::numbers::sqrt2_v<Real>) / 2; }

}  // namespace

// Integrals of a density from the smallest value to the ends of cells of equal width in t = ln x.
struct Distribution::Integrals {
  static constexpr int kCells = 1024;

  Integrals(const DistributionParameters& parameters, int mass_power);
  Real density(Real t) const { return exponential(log_density(parameters, mass_power, t) - largest); }
  Real end(int cell) const { return low + cell * width; }
  Real quantile(Real u) const;
  Real moment(int power) const;

  const DistributionParameters parameters;
  int mass_power;
  Real low = 0, width = 0;  // of ln x
  Real largest = 0;         // logarithm of the largest density
  std::vector<Real> below;  // integral up to the end of the cell before; kCells + 1 entries
};

Distribution::Integrals::Integrals(const DistributionParameters& of, int power)
    : parameters(of), mass_power(power) {
  const LogRange range = support(of, power);
  low = range.low, width = (range.high - range.low) / kCells;
  largest = log_density(of, power, low);
  for (int cell = 1; cell <= kCells; ++cell) largest = std::max(largest, log_density(of, power, end(cell)));
  below.assign(1, 0);
  for (int cell = 0; cell < kCells; ++cell)
    below.push_back(below.back() + integral(end(cell), end(cell + 1), [&](Real t) { return density(t); }));
}

// Newton's method for the integral within a cell, kept inside the cell by bisection.
Real Distribution::Integrals::quantile(Real u) const {
  const Real sought = u * below.back();
  const auto next = std::upper_bound(below.begin() + 1, below.end() - 1, sought);
  const int cell = static_cast<int>(next - below.begin()) - 1;
  const Real from = end(cell), rest = sought - *(next - 1);
  Real left = from, right = end(cell + 1);
  Real t = left + (right - left) * std::clamp(rest / (*next - *(next - 1)), Real(0), Real(1));
  constexpr int kMostIterations = 60;
  for (int k = 0; k < kMostIterations; ++k) {
    const Real excess = integral(from, t, [&](Real s) { return density(s); }) - rest;
    (excess > 0 ? right : left) = t;
    const Real newton = t - excess / density(t);
    const Real better = newton > left && newton < right ? newton : (left + right) / 2;
    const bool done = std::abs(better - t) <= 1e-15 * (1 + std::abs(t));
    t = better;
    if (done) break;
  }
  return exponential(t);
}

Real Distribution::Integrals::moment(int power) const {
  Real sum = 0;
  for (int cell = 0; cell < kCells; ++cell)
    sum += integral(end(cell), end(cell + 1), [&](Real t) { return density(t) * exponential(power * t); });
  return sum / below.back();
}

Distribution::Distribution(const DistributionParameters& parameters, int mass_power)
    : parameters_(parameters), given_(parameters), mass_power_(mass_power) {
  if (parameters.kind == DistributionKind::constant) parameters_.min = parameters_.max = parameters.value;
  if (parameters.kind == DistributionKind::table) take_table();
  const bool has_density = parameters.kind == DistributionKind::normal ||
                           parameters.kind == DistributionKind::lognormal ||
                           parameters.kind == DistributionKind::rosin_rammler;
  if (has_density && !is_narrow()) integrals_ = std::make_shared<const Integrals>(parameters, mass_power);
}

void Distribution::take_table() {
  std::vector<std::size_t> order(given_.values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return given_.values[k]; });
  Real sum = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const Real x = given_.values[order[k]], weight = given_.weights[order[k]];
    parameters_.values[k] = x;
    const Real mass = whole_power(parameters_.values.front() / x, -mass_power_);  // of the lightest ones
    parameters_.weights[k] = given_.by == CountedBy::mass ? weight / mass : weight;
    sum += parameters_.weights[k];
  }
  for (Real& weight : parameters_.weights) weight /= sum;
  parameters_.min = parameters_.values.front(), parameters_.max = parameters_.values.back();
}

Real Distribution::quantile(Real u) const {
  if (is_constant()) return smallest();
  if (integrals_) return std::clamp(integrals_->quantile(u), smallest(), largest());
  if (parameters_.kind != DistributionKind::table) return uniform_quantile(u);
  for (std::size_t k = 0; k + 1 < parameters_.values.size(); ++k) {
    u -= parameters_.weights[k];
    if (u < 0) return parameters_.values[k];
  }
  return parameters_.values.back();
}

// By mass the density by number is proportional to x^-mass_power.
Real Distribution::uniform_quantile(Real u) const {
  const Real a = smallest(), b = largest();
  const int s = parameters_.by == CountedBy::mass ? 1 - mass_power_ : 1;
  if (s == 1) return a + (b - a) * u;
  if (s == 0) return std::clamp(a * exponential(u * logarithm(b / a)), a, b);
  const Real inner = whole_power(b / a, s);  // of x / a
  return std::clamp(a * exponential(logarithm(1 + u * (inner - 1)) / s), a, b);
}

Real Distribution::moment(int power) const {
  if (is_narrow()) return whole_power((smallest() + largest()) / 2, power);
  if (integrals_) return integrals_->moment(power);
  if (parameters_.kind == DistributionKind::uniform) {
    const int s = parameters_.by == CountedBy::mass ? 1 - mass_power_ : 1;
    return power_integral(smallest(), largest(), s + power) / power_integral(smallest(), largest(), s);
  }
  Real sum = 0;
  for (std::size_t k = 0; k < parameters_.values.size(); ++k)
    sum += parameters_.weights[k] * whole_power(parameters_.values[k], power);
  return sum;
}

Distribution Distribution::other_reading() const {
  DistributionParameters other = given_;
  other.by = given_.by == CountedBy::mass ? CountedBy::number : CountedBy::mass;
  return {other, mass_power_};
}

Real share_within_limits(const DistributionParameters& p) {
  switch (p.kind) {
    case DistributionKind::normal:
      return normal_tail((p.min - p.mean) / p.sd) - normal_tail((p.max - p.mean) / p.sd);
    case DistributionKind::lognormal: {
      const auto z = [&](Real x) { return std::log(x / p.median) / std::log(p.geometric_sd); };
      return normal_tail(z(p.min)) - normal_tail(z(p.max));
    }
    case DistributionKind::rosin_rammler: {
      const auto larger = [&](Real x) { return std::exp(-std::pow(x / p.scale, p.exponent)); };
      return larger(p.min) - larger(p.max);
    }
    default:
      return 1;
  }
}

namespace {

void check_limits(const DeckTable& table, const DistributionParameters& p) {
  if (p.kind == DistributionKind::constant || p.kind == DistributionKind::table) return;
  if (p.min > p.max) table.fail("max", fmt::format("must be at least min = {}", p.min));
  constexpr Real kNarrowest = 1e-9;
  if (p.kind == DistributionKind::normal && p.sd < kNarrowest * p.mean)
    table.fail("sd",
               fmt::format("must be at least {} of the mean; a constant has no distribution", kNarrowest));
  if (p.kind == DistributionKind::lognormal && p.geometric_sd < 1 + kNarrowest)
    table.fail("geometric_sd", fmt::format("must be at least 1 + {}", kNarrowest));
  // Limits that exclude nearly everything are a mistake in the deck.
  constexpr Real kSmallestShare = 1e-5;
  if (const Real share = share_within_limits(p); p.min < p.max && share < kSmallestShare)
    table.fail("min", fmt::format("only {:.1e} of the distribution is from min to max = {}; at least {:.0e} "
                                  "must be",
                                  std::max(share, Real(0)), p.max, kSmallestShare));
}

void read_values(const DeckTable& table, DistributionParameters& p) {
  p.values = table.reals("values");
  if (p.values.empty()) table.fail("values", "must have an entry");
  p.weights = table.has("weights") ? table.reals("weights") : std::vector<Real>(p.values.size(), 1);
  if (p.weights.size() != p.values.size())
    table.fail("weights", fmt::format("must have {} entries, as values", p.values.size()));
}

}  // namespace

Distribution read_distribution(const DeckTable& table, int mass_power) {
  DistributionParameters p;
  p.kind = table.choice<DistributionKind>("kind");
  if (table.has("by")) p.by = table.choice<CountedBy>("by");
  const auto take = [&](const char* key, Real& value) {
    if (table.has(key)) value = table.real(key);
  };
  take("value", p.value), take("min", p.min), take("max", p.max);
  take("mean", p.mean), take("sd", p.sd), take("median", p.median), take("geometric_sd", p.geometric_sd);
  take("scale", p.scale), take("exponent", p.exponent);
  if (p.kind == DistributionKind::table) read_values(table, p);
  check_limits(table, p);
  return {p, mass_power};
}

}  // namespace scree
