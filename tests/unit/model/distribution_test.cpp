// Distributions of sizes: quantiles and moments against closed forms, by number and by mass.
#include "model/derived/distribution.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "model/derived/generators.hpp"
#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kQuadrature = 1e-11;  // relative error of moments
// Of probabilities at quantiles: the round-off of ln x over the narrowest spread among the cases, 1e-4.
constexpr Real kInverse = 1e-10;

using Kind = DistributionKind;

DistributionParameters uniform(CountedBy by, Real min, Real max) {
  return {.kind = Kind::uniform, .by = by, .min = min, .max = max};
}
DistributionParameters normal(CountedBy by, Real mean, Real sd, Real min, Real max) {
  return {.kind = Kind::normal, .by = by, .min = min, .max = max, .mean = mean, .sd = sd};
}
DistributionParameters lognormal(CountedBy by, Real median, Real geometric_sd, Real min, Real max) {
  return {.kind = Kind::lognormal,
          .by = by,
          .min = min,
          .max = max,
          .median = median,
          .geometric_sd = geometric_sd};
}
DistributionParameters rosin_rammler(CountedBy by, Real scale, Real exponent, Real min, Real max) {
  return {
      .kind = Kind::rosin_rammler, .by = by, .min = min, .max = max, .scale = scale, .exponent = exponent};
}
DistributionParameters table(CountedBy by, std::vector<Real> values, std::vector<Real> weights) {
  return {.kind = Kind::table, .by = by, .values = std::move(values), .weights = std::move(weights)};
}

std::vector<DistributionParameters> all(CountedBy by) {
  return {uniform(by, 0.001, 0.01),
          normal(by, 0.002, 0.0005, 0.0008, 0.0035),
          normal(by, 0.002, 2e-7, 0.0001, 0.03),
          normal(by, 0.002, 0.01, 1e-5, 0.03),
          lognormal(by, 0.002, 1.5, 0.0005, 0.006),
          lognormal(by, 0.002, 1.001, 0.0001, 0.06),
          lognormal(by, 0.002, 3, 0.00002, 0.2),
          rosin_rammler(by, 0.003, 0.8, 0.0001, 0.02),
          rosin_rammler(by, 0.003, 3, 0.0001, 0.01),
          rosin_rammler(by, 0.003, 40, 0.0001, 0.01),
          table(by, {0.004, 0.001, 0.002}, {1, 2, 3})};
}

// The probability of a standard normal number below z.
Real phi(Real z) { return std::erfc(-z / std::numbers::sqrt2) / 2; }

Real lognormal_z(const DistributionParameters& p, int shift, Real x) {
  const Real sd = std::log(p.geometric_sd);
  return (std::log(x / p.median) - shift * sd * sd) / sd;
}

// The probability of a standard normal number from a to b, without cancellation in the upper tail.
Real between(Real a, Real b) { return a > 0 ? phi(-a) - phi(-b) : phi(b) - phi(a); }

// Moment of a truncated lognormal distribution by number.
Real lognormal_moment(const DistributionParameters& p, int power) {
  const Real sd = std::log(p.geometric_sd);
  const auto inside = [&](int shift) {
    return between(lognormal_z(p, shift, p.min), lognormal_z(p, shift, p.max));
  };
  return std::pow(p.median, power) * std::exp(power * power * sd * sd / 2) * inside(power) / inside(0);
}

// The share of particles below x, by number, of distributions by number.
Real below(const DistributionParameters& p, Real x) {
  const auto whole = [&](Real at) -> Real {
    switch (p.kind) {
      case Kind::uniform:
        return at;
      case Kind::normal:
        return phi((at - p.mean) / p.sd);
      case Kind::lognormal:
        return phi(lognormal_z(p, 0, at));
      default:
        return -std::exp(-std::pow(at / p.scale, p.exponent));
    }
  };
  return (whole(x) - whole(p.min)) / (whole(p.max) - whole(p.min));
}

// Share of the mass of spheres that is in those larger than x; values at equal steps of u.
Real mass_above(const Distribution& radius, Real x, int steps) {
  Real sum = 0, above = 0;
  for (int k = 0; k < steps; ++k) {
    const Real r = radius.quantile((k + Real(0.5)) / steps), mass = r * r * r;
    sum += mass, above += r > x ? mass : 0;
  }
  return above / sum;
}

}  // namespace

TEST_CASE("quantiles invert the distributions by number") {
  for (const DistributionParameters& p : all(CountedBy::number)) {
    if (p.kind == Kind::table) continue;
    const Distribution distribution(p, 3);
    CAPTURE(word_of(p.kind), p.sd, p.geometric_sd, p.exponent);
    for (const Real u : {1e-6, 0.01, 0.25, 0.5, 0.9, 0.999})
      CHECK(near(below(p, distribution.quantile(u)), u, {.absolute = kInverse}));
  }
}

TEST_CASE("quantiles rise from the smallest to the largest value") {
  for (const CountedBy by : {CountedBy::number, CountedBy::mass})
    for (const DistributionParameters& p : all(by)) {
      const Distribution distribution(p, 3);
      CAPTURE(word_of(by), word_of(p.kind), p.sd, p.geometric_sd, p.exponent);
      Real last = distribution.smallest();
      for (int k = 0; k <= 1000; ++k) {
        const Real x = distribution.quantile(std::min(k / 1000.0, 1 - 0x1p-53));
        REQUIRE(x >= last);
        last = x;
      }
      CHECK(last <= distribution.largest());
    }
}

TEST_CASE("moments of the truncated lognormal distribution, by number and by mass") {
  for (const Real spread : {1.05, 1.5, 3.0}) {
    const DistributionParameters by_number = lognormal(CountedBy::number, 0.002, spread, 0.0007, 0.005),
                                 by_mass = lognormal(CountedBy::mass, 0.002, spread, 0.0007, 0.005);
    // A lognormal distribution by mass is one by number with another median (Hatch, Choate, 1929).
    DistributionParameters shifted = by_number;
    shifted.median *= std::exp(-3 * std::log(spread) * std::log(spread));
    for (const int power : {-3, 1, 2, 3}) {
      CHECK(near(Distribution(by_number, 3).moment(power), lognormal_moment(by_number, power),
                 {.relative = kQuadrature}));
      CHECK(near(Distribution(by_mass, 3).moment(power), lognormal_moment(shifted, power),
                 {.relative = kQuadrature}));
    }
  }
}

TEST_CASE("mean and variance of the truncated normal distribution") {
  const DistributionParameters p = normal(CountedBy::number, 0.002, 0.0005, 0.0018, 0.0035);
  const Real a = (p.min - p.mean) / p.sd, b = (p.max - p.mean) / p.sd, inside = phi(b) - phi(a);
  const auto density = [](Real z) { return std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi); };
  const Real mean = p.mean + p.sd * (density(a) - density(b)) / inside;
  const Real square =
      p.sd * p.sd * (1 + (a * density(a) - b * density(b)) / inside) + 2 * p.mean * mean - p.mean * p.mean;
  const Distribution distribution(p, 3);
  CHECK(near(distribution.moment(1), mean, {.relative = kQuadrature}));
  CHECK(near(distribution.moment(2), square, {.relative = kQuadrature}));
}

TEST_CASE("the mean mass of a distribution by mass is the inverse of the mean inverse mass") {
  for (const int power : {1, 2, 3})
    for (const DistributionParameters& p : all(CountedBy::mass)) {
      const Distribution by_mass(p, power);
      CAPTURE(word_of(p.kind), power, p.sd, p.geometric_sd, p.exponent);
      CHECK(near(by_mass.moment(power) * by_mass.other_reading().moment(-power), 1, {.relative = 1e-10}));
    }
}

TEST_CASE("Rosin-Rammler by mass: the share exp(-(d / d')^n) of the mass is in larger particles") {
  for (const Real exponent : {0.9, 2.0, 3.5}) {
    const DistributionParameters p = rosin_rammler(CountedBy::mass, 0.003, exponent, 0.0008, 0.009);
    const Distribution radius(p, 3);
    const auto above = [&](Real x) { return std::exp(-std::pow(x / p.scale, exponent)); };
    for (const Real x : {0.001, 0.002, 0.003, 0.005, 0.007}) {
      const Real exact = (above(x) - above(p.max)) / (above(p.min) - above(p.max));
      // A step in u at the threshold is one particle of up to 9 mm.
      CHECK(near(mass_above(radius, x, 100000), exact, {.absolute = 1e-3}));
    }
  }
}

TEST_CASE("uniform by mass, and tables by mass") {
  const Real a = 0.001, b = 0.004;
  const auto quantile = [&](int power, Real u) {
    return Distribution(uniform(CountedBy::mass, a, b), power).quantile(u);
  };
  for (const Real u : {0.0, 0.3, 0.8}) {
    CHECK(near(quantile(1, u), a * std::pow(b / a, u), {.relative = 1e-12}));
    CHECK(near(1 / quantile(2, u), (1 - u) / a + u / b, {.relative = 1e-12}));
    CHECK(near(std::pow(quantile(3, u), -2), (1 - u) / (a * a) + u / (b * b), {.relative = 1e-12}));
  }
  // Equal masses of 1 mm and 2 mm: eight small ones for one large.
  const Distribution sieve(table(CountedBy::mass, {0.002, 0.001}, {1, 1}), 3);
  CHECK(sieve.quantile(8.0 / 9 - 1e-12) == 0.001);
  CHECK(sieve.quantile(8.0 / 9 + 1e-12) == 0.002);
  CHECK(near(mass_above(sieve, 0.0015, 9000), 0.5, {.absolute = 1e-3}));
}

TEST_CASE("drawn values keep within the Kolmogorov-Smirnov bound of their distribution") {
  constexpr std::int64_t kCount = 100000;
  for (const DistributionParameters& p : all(CountedBy::number)) {
    if (p.kind == Kind::table) continue;
    RandomNumbers random(1);
    std::vector<Real> drawn = draw(Distribution(p, 3), kCount, {0, kCount}, random);
    std::ranges::sort(drawn);
    Real largest = 0;
    for (std::size_t k = 0; k < drawn.size(); ++k)
      largest = std::max(largest, std::abs(below(p, drawn[k]) - (static_cast<Real>(k) + 0.5) / kCount));
    CAPTURE(word_of(p.kind), p.sd, p.geometric_sd, p.exponent);
    CHECK(largest < 1.63 / std::sqrt(Real(kCount)));  // exceeded by 1 % of all seeds
  }
}

TEST_CASE("a part of the values drawn is that of all of them") {
  const Distribution radius(lognormal(CountedBy::mass, 0.002, 1.5, 0.0005, 0.006), 3);
  RandomNumbers random(4), again(4);
  const std::vector<Real> whole = draw(radius, 100, {0, 100}, random),
                          part = draw(radius, 100, {60, 80}, again);
  CHECK(std::equal(part.begin(), part.end(), whole.begin() + 60));
}

TEST_CASE("distributions of a deck: what they count must be said, and limits must hold something") {
  const auto error = [](const std::string& radius) {
    return model_error(kSmallDeck +
                       "[[contact.pairs]]\nstiffness = 1e4\n[[particles]]\nname = \"p\"\nkind = "
                       "\"list\"\npositions = [[0, 0]]\nmass = 1.0\nradius = " +
                       radius + "\n");
  };
  const std::string limits = ", min = 0.001, max = 0.01";
  CHECK(contains(
      error("{ kind = \"lognormal\", median = 0.003, geometric_sd = 1.4" + limits + " }"),
      "particles.p.radius.by: missing; with kind = \"lognormal\" it must be one of \"number\", \"mass\""));
  CHECK(error("{ kind = \"lognormal\", by = \"mass\", median = 0.003, geometric_sd = 1.4" + limits + " }")
            .empty());
  CHECK(error("{ kind = \"rosin_rammler\", by = \"mass\", scale = 0.003, exponent = 2.5" + limits + " }")
            .empty());
  CHECK(contains(error("{ kind = \"rosin_rammler\", by = \"mass\", scale = 0.003, exponent = 2.5 }"),
                 "particles.p.radius.min: missing"));
  CHECK(contains(
      error("{ kind = \"lognormal\", by = \"mass\", median = 0.3, geometric_sd = 1.4" + limits + " }"),
      "of the distribution is from min to max = 0.01"));
  CHECK(contains(
      error("{ kind = \"lognormal\", by = \"mass\", median = 0.3, geometric_sd = 1.0" + limits + " }"),
      "must be a number above 1"));
}

TEST_CASE("the mean mass of a group, and that of the other reading") {
  const std::string deck = kSmallDeck +
                           "[[contact.pairs]]\nstiffness = 1e4\n[[particles]]\nkind = \"list\"\n"
                           "positions = [[0, 0]]\n";
  const auto mean = [&](const std::string& keys) {
    return model_of(deck + keys).particles.groups[0].mean_mass;
  };
  CHECK_FALSE(mean("radius = 0.1\nmass = 2.0\n").has_value());
  const std::optional<MeanMass> discs =
      mean("radius = { kind = \"table\", values = [0.1, 0.2] }\ndensity = 100.0\nthickness = 0.5\n");
  REQUIRE(discs.has_value());
  const Real small = 50 * std::numbers::pi * 0.01;
  CHECK(discs->by == CountedBy::number);
  CHECK(near(discs->mass, 2.5 * small, {.relative = 1e-12}));
  CHECK(near(discs->of_other_reading, 1.6 * small, {.relative = 1e-12}));  // four small ones for one large
}

}  // namespace scree
