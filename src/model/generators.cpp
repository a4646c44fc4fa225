#include "model/generators.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "model/point_bins.hpp"

namespace scree {

namespace {

Vec3 random_place(const PackingBox& box, Real radius, RandomNumbers& random) {
  const Real x = random.uniform(box.min.x + radius, box.max.x - radius);
  const Real y = random.uniform(box.min.y + radius, box.max.y - radius);
  return {x, y, box.dimension == 3 ? random.uniform(box.min.z + radius, box.max.z - radius) : 0};
}

bool fits(const PackingBox& box, Real radius) {
  const Vec3 extent = box.max - box.min;
  return extent.x >= 2 * radius && extent.y >= 2 * radius && (box.dimension == 2 || extent.z >= 2 * radius);
}

Real largest(const std::vector<Real>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

Real draw_normal(const DeckTable& table, RandomNumbers& random) {
  // A window that the distribution almost never meets is a mistake in the deck.
  constexpr int kMostDraws = 100000;
  const Real mean = table.real("mean"), sd = table.real("sd"), min = table.real("min"),
             max = table.real("max");
  for (int i = 0; i < kMostDraws; ++i) {
    const Real value = mean + sd * random.normal();
    if (value >= min && value <= max) return value;
  }
  table.fail("mean", fmt::format("{} draws found no value from {} to {}", kMostDraws, min, max));
}

void check_distribution(const DeckTable& table) {
  const std::string& kind = table.text("kind");
  if ((kind == "uniform" || kind == "normal") && table.real("min") > table.real("max")) {
    table.fail("max", fmt::format("must be at least min = {}", table.real("min")));
  }
  if (kind != "table") return;
  const std::size_t count = table.reals("values").size();
  if (count == 0) table.fail("values", "must have an entry");
  if (table.has("weights") && table.reals("weights").size() != count) {
    table.fail("weights", fmt::format("must have {} entries, as values", count));
  }
}

Real draw_table(const std::vector<Real>& values, const std::vector<Real>& weights, RandomNumbers& random) {
  Real rest = random.uniform() * std::accumulate(weights.begin(), weights.end(), Real(0));
  for (std::size_t i = 0; i + 1 < values.size(); ++i) {
    rest -= weights[i];
    if (rest < 0) return values[i];
  }
  return values.back();
}

}  // namespace

std::vector<Vec3> lattice_positions(Vec3 origin, Vec3 spacing, const std::array<std::int64_t, 3>& size,
                                    std::int64_t count) {
  std::vector<Vec3> positions;
  positions.reserve(static_cast<std::size_t>(count));
  for (std::int64_t i = 0; i < count; ++i) {
    const auto x = static_cast<Real>(i % size[0]);
    const auto y = static_cast<Real>(i / size[0] % size[1]);
    const auto z = static_cast<Real>(i / (size[0] * size[1]));
    positions.push_back(origin + Vec3{x * spacing.x, y * spacing.y, z * spacing.z});
  }
  return positions;
}

std::vector<Vec3> random_packing(const PackingBox& box, const std::vector<Real>& radius,
                                 const Obstacles& obstacles, RandomNumbers& random) {
  const Real own = largest(radius);
  const Real reach = own + std::max(own, largest(obstacles.radius)) + box.gap;
  PointBins bins(box.min, box.max, reach, radius.size() + obstacles.position.size());
  Obstacles placed = obstacles;
  for (const Vec3 position : obstacles.position) bins.insert(position);

  std::vector<std::size_t> order(radius.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return radius[a] > radius[b]; });
  std::vector<Vec3> positions(radius.size());
  for (std::size_t n = 0; n < order.size(); ++n) {
    const Real r = radius[order[n]];
    bool found = false;
    for (std::int64_t attempt = 0; attempt < box.tries && !found && fits(box, r); ++attempt) {
      const Vec3 place = random_place(box, r, random);
      found = bins.for_near(place, [&](int other) {
        const auto j = static_cast<std::size_t>(other);
        return norm(place - placed.position[j]) >= r + placed.radius[j] + box.gap;
      });
      positions[order[n]] = place;
    }
    if (!found) return std::vector<Vec3>(n);
    bins.insert(positions[order[n]]);
    placed.position.push_back(positions[order[n]]);
    placed.radius.push_back(r);
  }
  return positions;
}

std::vector<Real> draw(const DeckTable& distribution, std::size_t count, RandomNumbers& random) {
  check_distribution(distribution);
  const std::string& kind = distribution.text("kind");
  if (kind == "constant") return std::vector<Real>(count, distribution.real("value"));
  std::vector<Real> weights;
  if (kind == "table") {
    weights = distribution.has("weights") ? distribution.reals("weights")
                                          : std::vector<Real>(distribution.reals("values").size(), 1);
  }
  std::vector<Real> values(count);
  for (Real& value : values) {
    if (kind == "uniform") value = random.uniform(distribution.real("min"), distribution.real("max"));
    if (kind == "normal") value = draw_normal(distribution, random);
    if (kind == "table") value = draw_table(distribution.reals("values"), weights, random);
  }
  return values;
}

}  // namespace scree
