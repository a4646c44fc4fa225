// Candidates for births against the particles that are there: the same as by brute force.
#include "dem/search/candidate_grid.hpp"

#include <cmath>
#include <random>
#include <vector>

#include "support/catch.hpp"

namespace scree {

namespace {

using Random = std::mt19937;

Real uniform(Random& random, Real low, Real high) {
  return std::uniform_real_distribution<Real>(low, high)(random);
}

std::vector<Vec4> random_spheres(Random& random, int count, Vec3 box, Real smallest, Real largest) {
  std::vector<Vec4> out;
  for (int k = 0; k < count; ++k) {
    const Real x = uniform(random, 0, box.x), y = uniform(random, 0, box.y);
    const Real z = box.z > 0 ? uniform(random, 0, box.z) : 0;
    out.push_back(vec4({x, y, z}, uniform(random, smallest, largest)));
  }
  return out;
}

Real nearest(Real d, Real period) { return period > 0 ? d - period * std::round(d / period) : d; }

bool overlap(const Vec4& a, const Vec4& b, Vec3 period) {
  const Vec3 d{nearest(a.x - b.x, period.x), nearest(a.y - b.y, period.y), nearest(a.z - b.z, period.z)};
  return dot(d, d) < (a.w + b.w) * (a.w + b.w);
}

// Numbers of the candidates that a particle overlaps, of those that the grid shows it.
std::vector<std::uint8_t> found_by(const CandidateGrid& grid, const std::vector<Vec4>& particles,
                                   const std::vector<std::uint8_t>& drifting) {
  std::vector<std::uint8_t> overlapped(static_cast<std::size_t>(grid.size()), 0);
  const CandidateItem item{grid.views(), particles.data(), drifting.data(), overlapped.data()};
  for (std::size_t i = 0; i < particles.size(); ++i) item(static_cast<Index>(i));
  return overlapped;
}

}  // namespace

TEST_CASE("candidates that overlap a particle are those of a search through all pairs") {
  struct Case {
    Vec3 box, period;
  };
  const auto [box, period] =
      GENERATE(Case{{1, 1, 1}, {}}, Case{{1, 1, 1}, {1, 0, 0}}, Case{{1, 2, 1}, {1, 2, 1}},
               Case{{1, 1, 0}, {0, 1, 0}}, Case{{20, 0.2, 0.2}, {20, 0, 0}});
  const int count = GENERATE(1, 7, 400);
  const Real largest = GENERATE(Real(0.02), Real(0.09));
  Random random(static_cast<unsigned>(count));
  const std::vector<Vec4> candidates = random_spheres(random, count, box, 0.01, 0.03),
                          particles = random_spheres(random, 300, box, 0.01, largest);
  const CandidateGrid grid(candidates, period, largest);
  REQUIRE(grid.size() == count);
  std::vector<std::uint8_t> drifting(particles.size(), 0), expected(candidates.size(), 0);
  for (std::size_t i = 0; i < particles.size(); i += 5) drifting[i] = 1;
  for (std::size_t i = 0; i < particles.size(); ++i)
    for (std::size_t k = 0; k < candidates.size(); ++k)
      if (drifting[i] == 0 && overlap(particles[i], candidates[k], period)) expected[k] = 1;
  CHECK(found_by(grid, particles, drifting) == expected);
}

TEST_CASE("candidates far apart, or all in one place, have a grid of few cells") {
  const std::vector<Vec4> apart = {vec4({0, 0, 0}, 1e-6), vec4({1e3, 1e3, 1e3}, 1e-6)};
  const CandidateGrid wide(apart, {}, 1e-6);
  CHECK(wide.starts().size() < 1e5);
  const std::vector<Vec4> particles = {vec4({1e3, 1e3, 1e3 + 1.5e-6}, 1e-6), vec4({-1e9, 1e300, 0}, 1e-6)};
  CHECK(found_by(wide, particles, {0, 0}) == std::vector<std::uint8_t>{0, 1});
  const std::vector<Vec4> same(10, vec4({0.5, 0.5, 0.5}, 0.1));
  const CandidateGrid narrow(same, {}, 0.1);
  CHECK(found_by(narrow, {vec4({0.5, 0.69, 0.5}, 0.1)}, {0}) == std::vector<std::uint8_t>(10, 1));
  CHECK(found_by(narrow, {vec4({0.5, 0.71, 0.5}, 0.1)}, {0}) == std::vector<std::uint8_t>(10, 0));
}

}  // namespace scree
