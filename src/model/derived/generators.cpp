#include "model/derived/generators.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "model/derived/point_bins.hpp"
#include "physics/random_packing.hpp"

namespace scree {

namespace {

Vec3 random_position(const PackingBox& box, Real radius, RandomNumbers& random) {
  if (box.drawn) return box.drawn->draw(random, radius);
  const Real x = random.uniform(box.min.x + radius, box.max.x - radius);
  const Real y = random.uniform(box.min.y + radius, box.max.y - radius);
  return {x, y, box.dimension == 3 ? random.uniform(box.min.z + radius, box.max.z - radius) : 0};
}

// Volume of the region [m^3, in 2D m^2]. gap: between neighbours; it does not apply to walls.
Real volume_of(const PackingBox& box, Real gap) {
  if (box.drawn) return box.share * box.drawn->volume;
  const Vec3 extent = box.max - box.min;
  return box.share * (extent.x + gap) * (extent.y + gap) * (box.dimension == 2 ? 1 : extent.z + gap);
}

bool fits(const PackingBox& box, Real radius) {
  const Vec3 extent = box.max - box.min;
  return extent.x >= 2 * radius && extent.y >= 2 * radius && (box.dimension == 2 || extent.z >= 2 * radius);
}

// Below this number, boundaries and chance matter more than the fraction.
constexpr std::size_t kMany = 1000;

// Expected number of particles that find no position. radius: from large to small [m]. scale: factor on their
// number. The probability of a free position is doubled, as a safety margin.
Real expected_failures(const PackingBox& box, const std::vector<Real>& radius, Real scale) {
  constexpr std::size_t kParts = 200;
  const Real volume = volume_of(box, box.gap);
  PackingSums sums;
  Real failures = 0;
  for (std::size_t part = 0, i = 0; part < kParts; ++part) {
    const std::size_t end = (part + 1) * radius.size() / kParts;
    const auto count = scale * static_cast<Real>(end - i);
    for (; i < end; ++i) sums.add(box.dimension, radius[i] + box.gap / 2, scale / volume);
    const Real chance = insertion_probability(box.dimension, sums, radius[i - 1] + box.gap / 2);
    failures += count * std::exp(-2 * chance * static_cast<Real>(box.tries));
  }
  return failures;
}

// Distributions by number that groups of particles have always had keep the sequence of their random numbers;
// the others are drawn by their quantiles.
Real draw_one(const Distribution& distribution, RandomNumbers& random) {
  const DistributionParameters& p = distribution.given();
  if (p.by == CountedBy::number && p.kind == DistributionKind::uniform) return random.uniform(p.min, p.max);
  if (p.by == CountedBy::number && p.kind == DistributionKind::normal)
    for (;;) {
      const Real value = p.mean + p.sd * random.normal();
      if (value >= p.min && value <= p.max) return value;
    }
  if (p.by == CountedBy::number && p.kind == DistributionKind::table) {
    Real rest = random.uniform() * std::accumulate(p.weights.begin(), p.weights.end(), Real(0));
    for (std::size_t i = 0; i + 1 < p.values.size(); ++i) {
      rest -= p.weights[i];
      if (rest < 0) return p.values[i];
    }
    return p.values.back();
  }
  return distribution.quantile(random.uniform());
}

}  // namespace

Vec3 lattice_position(Vec3 origin, Vec3 spacing, const std::array<std::int64_t, 3>& size, std::int64_t i) {
  const auto x = static_cast<Real>(i % size[0]);
  const auto y = static_cast<Real>(i / size[0] % size[1]);
  const auto z = static_cast<Real>(i / (size[0] * size[1]));
  return origin + Vec3{x * spacing.x, y * spacing.y, z * spacing.z};
}

std::vector<Vec3> random_packing(const PackingBox& box, const std::vector<Real>& radius,
                                 const std::vector<StartItem>& obstacles, const IsFree& is_free,
                                 RandomNumbers& random) {
  const Real own = radius.empty() ? 0 : *std::max_element(radius.begin(), radius.end());
  Real largest = own;
  for (const StartItem& item : obstacles) largest = std::max(largest, item.radius);
  const std::size_t expected = radius.size() + obstacles.size();
  GrowingBins bins(PointCells(box.min, box.max, own + largest + box.gap, expected), expected);
  for (const StartItem& item : obstacles) bins.insert(item.position, item.radius);

  std::vector<std::size_t> order(radius.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return radius[a] > radius[b]; });
  const Real tries = static_cast<Real>(box.tries) / box.share;
  std::vector<Vec3> positions(radius.size());
  for (std::size_t n = 0; n < order.size(); ++n) {
    const Real r = radius[order[n]];
    bool found = false;
    for (std::int64_t attempt = 0; static_cast<Real>(attempt) < tries && !found && fits(box, r); ++attempt) {
      positions[order[n]] = random_position(box, r, random);
      found = bins.is_clear(positions[order[n]], r, box.gap) && is_free(positions[order[n]], r);
    }
    if (!found) return std::vector<Vec3>(n);
    bins.insert(positions[order[n]], r);
  }
  return positions;
}

std::string packing_trouble(const PackingBox& box, std::vector<Real> radius, const std::string& region) {
  constexpr Real kCertain = 20;  // expected failures: success then has a probability of 10^-8
  std::sort(radius.begin(), radius.end(), std::greater<>());
  PackingSums sums;
  const Real volume = volume_of(box, 0);
  for (const Real r : radius) sums.add(box.dimension, r, 1 / volume);
  const bool equal = !radius.empty() && radius.front() == radius.back();
  const Real most_of_all = equal ? densest_fraction(box.dimension) : 1;
  Real most = most_of_all;
  const char* bound = "no packing fills more than";
  if (radius.size() >= kMany && expected_failures(box, radius, 1) > kCertain) {
    most = 0;
    for (Real high = std::min(sums.fraction, most_of_all); high - most > 1e-3;) {
      const Real middle = (most + high) / 2;
      (expected_failures(box, radius, middle / sums.fraction) > kCertain ? high : most) = middle;
    }
    bound = "random insertion fills at most about";
  }
  if (sums.fraction <= most) return "";
  return fmt::format(
      "the particles are {:.3g} of the {} of their {}, and {} {:.2g} of it{}; a larger {}, fewer or smaller "
      "particles are needed",
      sums.fraction, box.dimension == 2 ? "area" : "volume", region, bound, most,
      radius.size() < kMany ? "" : fmt::format(" in {} tries each", box.tries),
      region.substr(0, region.find(' ')));
}

std::vector<Real> draw(const Distribution& distribution, std::int64_t count, IdRange part,
                       RandomNumbers& random) {
  std::vector<Real> values(static_cast<std::size_t>(part.size()), distribution.smallest());
  if (distribution.is_constant()) return values;
  for (std::int64_t i = 0; i < count; ++i) {
    const Real value = draw_one(distribution, random);
    if (i >= part.first && i < part.last) values[static_cast<std::size_t>(i - part.first)] = value;
  }
  return values;
}

}  // namespace scree
