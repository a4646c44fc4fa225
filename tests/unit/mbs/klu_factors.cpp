#if SCREE_REFACTORS
#include "mbs/klu_factors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "support/bits.hpp"
#include "support/catch.hpp"

using namespace scree;
using Result = KluFactors::Result;

namespace {

// Matrices [A, B^T; B, 0] of a chain of bodies at these angles: coordinates (x, y, angle) of every body, two
// rows for every joint.
SparsePattern chain_pattern(int links) {
  SparsePattern pattern;
  std::vector<std::vector<int>> columns(static_cast<std::size_t>(5 * links));
  for (int link = 0; link < links; ++link) {
    for (int k = 0; k < 3; ++k) columns[static_cast<std::size_t>(3 * link + k)].push_back(3 * link + k);
    for (int axis = 0; axis < 2; ++axis) {
      const int row = 3 * links + 2 * link + axis;
      columns[static_cast<std::size_t>(row)].push_back(row);
      for (int side = link == 0 ? 1 : 0; side < 2; ++side) {
        const int first = 3 * (link - 1 + side);
        for (const int column : {first + axis, first + 2}) {
          columns[static_cast<std::size_t>(row)].push_back(column);
          columns[static_cast<std::size_t>(column)].push_back(row);
        }
      }
    }
  }
  pattern.row_start.push_back(0);
  for (std::vector<int>& row : columns) {
    std::sort(row.begin(), row.end());
    pattern.column.insert(pattern.column.end(), row.begin(), row.end());
    pattern.row_start.push_back(static_cast<int>(pattern.column.size()));
  }
  return pattern;
}

// angle: [links]; all bodies have mass 1, and the inertia and half length given.
std::vector<Real> chain_values(const SparsePattern& pattern, const std::vector<Real>& angle, Real inertia,
                               Real half_length) {
  const int links = static_cast<int>(angle.size());
  const auto entry = [&](int row, int column) -> Real {
    if (row > column) std::swap(row, column);
    if (row == column) return row >= 3 * links ? 0 : row % 3 == 2 ? inertia : 1;
    const int joint = (column - 3 * links) / 2, axis = (column - 3 * links) % 2, link = row / 3;
    const Real sign = link == joint ? 1 : -1;
    if (row % 3 != 2) return sign;
    const Real turned = angle[static_cast<std::size_t>(link)];
    return half_length * (axis == 0 ? std::sin(turned) : -std::cos(turned));
  };
  std::vector<Real> values;
  for (int row = 0; row < pattern.rows(); ++row) {
    const auto at = [&](int i) {
      return static_cast<std::size_t>(pattern.row_start[static_cast<std::size_t>(i)]);
    };
    for (std::size_t i = at(row); i < at(row + 1); ++i) values.push_back(entry(row, pattern.column[i]));
  }
  return values;
}

std::vector<Real> solution(KluFactors& factors, int rows) {
  std::vector<Real> vector(static_cast<std::size_t>(rows));
  for (std::size_t i = 0; i < vector.size(); ++i) vector[i] = std::cos(static_cast<Real>(i));
  REQUIRE(factors.solve(vector));
  return vector;
}

std::vector<Real> solution_anew(const SparsePattern& pattern, const std::vector<Real>& values,
                                Real tolerance) {
  KluFactors factors;
  factors.options().tol = tolerance;
  REQUIRE(factors.analyze(pattern));
  REQUIRE(factors.factor(values) == Result::factored);
  return solution(factors, pattern.rows());
}

}  // namespace

TEST_CASE(
    "reused pivots give the bits of pivots chosen anew, and are given up where KLU would choose others") {
  constexpr int kLinks = 30;
  const SparsePattern pattern = chain_pattern(kLinks);
  std::mt19937 random(7);
  std::uniform_real_distribution<Real> turn(-1, 1);
  for (const Real tolerance : {1e-3, 0.1, 1.0}) {
    KluFactors factors;
    factors.options().tol = tolerance;
    REQUIRE(factors.analyze(pattern));
    std::vector<Real> angle(kLinks, 0.3);
    int reused = 0, chosen = 0;
    for (int i = 0; i < 300; ++i) {
      // Mostly small rotations; at times other lengths and inertias, whose pivots differ.
      for (Real& a : angle) a += (i % 10 == 0 ? 1 : 0.01) * turn(random);
      const Real scale = i % 50 < 25 ? 1 : 1e3;
      const std::vector<Real> values = chain_values(pattern, angle, 1e-3 * scale, 0.5 * std::sqrt(scale));
      const Result result = factors.factor(values);
      REQUIRE((result == Result::factored || result == Result::refactored));
      (result == Result::refactored ? reused : chosen)++;
      REQUIRE(same_bits(solution(factors, pattern.rows()), solution_anew(pattern, values, tolerance)));
    }
    INFO("tolerance " << tolerance << ": " << reused << " kept, " << chosen << " chosen");
    CHECK(reused > 0);
    CHECK(chosen > 1);
    if (tolerance < 0.01) CHECK(reused > 200);
  }
}

// Rows with a zero diagonal and few columns are the first that AMD eliminates.
TEST_CASE("an order that counts on zero diagonals is given up for one that does not") {
  constexpr int kLinks = 200;
  SparsePattern pattern;
  std::vector<std::vector<int>> columns(3 * kLinks);
  const auto connect = [&](int row, int column) {
    columns[static_cast<std::size_t>(row)].push_back(column);
    columns[static_cast<std::size_t>(column)].push_back(row);
  };
  for (int i = 0; i < kLinks; ++i) {  // coordinates i and kLinks + i, a constraint on the first of neighbours
    for (const int row : {i, kLinks + i, 2 * kLinks + i})
      columns[static_cast<std::size_t>(row)].push_back(row);
    connect(i, kLinks + i);
    connect(2 * kLinks + i, i);
    if (i > 0) connect(2 * kLinks + i, i - 1), connect(i, i - 1), connect(kLinks + i, kLinks + i - 1);
  }
  pattern.row_start.push_back(0);
  for (std::vector<int>& row : columns) {
    std::sort(row.begin(), row.end());
    pattern.column.insert(pattern.column.end(), row.begin(), row.end());
    pattern.row_start.push_back(static_cast<int>(pattern.column.size()));
  }
  const auto ordering = [&](int first_weak, bool given) {
    pattern.first_weak_diagonal = first_weak;
    KluFactors factors;
    REQUIRE(factors.analyze(pattern, given));
    return factors.options().ordering;
  };
  CHECK(ordering(2 * kLinks, false) == 1);  // COLAMD
  CHECK(ordering(2 * kLinks, true) == 0);
  CHECK(ordering(-1, false) == 0);
}

// Bodies that many joints connect fill their factors; a third of the entries is zero.
TEST_CASE("factors in blocks of rows are those of single entries, also where a pivot changes or vanishes") {
  constexpr int kRows = 44;
  SparsePattern pattern{{0}, {}};
  std::mt19937 random(3);
  std::uniform_real_distribution<Real> entry(-1, 1);
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kRows; ++column)
      if (row == column || (row * column) % 3 != 1) pattern.column.push_back(column);
    pattern.row_start.push_back(static_cast<int>(pattern.column.size()));
  }
  const auto matrix = [&](Real diagonal) {
    std::vector<Real> values;
    for (int row = 0; row < kRows; ++row)
      for (int i = pattern.row_start[static_cast<std::size_t>(row)];
           i < pattern.row_start[static_cast<std::size_t>(row) + 1]; ++i) {
        const bool own = pattern.column[static_cast<std::size_t>(i)] == row;
        values.push_back(own ? diagonal : i % 3 == 0 ? 0 : entry(random));
      }
    return values;
  };
  KluFactors factors;
  factors.options().scale = -1;  // none, as in the solver
  REQUIRE(factors.analyze(pattern));
  const auto same_as_anew = [&](const std::vector<Real>& values) {
    KluFactors fresh;
    fresh.options().scale = -1;
    REQUIRE(fresh.analyze(pattern));
    REQUIRE(fresh.factor(values) == Result::factored);
    return same_bits(solution(factors, kRows), solution(fresh, kRows));
  };
  int in_blocks = 0;
  for (int i = 0; i < 200; ++i) {
    const std::vector<Real> values = matrix(i % 90 == 89 ? 1e-4 : 20);
    in_blocks += factors.uses_blocks();
    const Result result = factors.factor(values);
    REQUIRE((result == Result::factored || result == Result::refactored));
    CHECK((i % 90 == 89 && result == Result::refactored) == false);
    REQUIRE(same_as_anew(values));
  }
  CHECK(in_blocks > 100);
  REQUIRE(factors.uses_blocks() == false);  // the pivots changed a moment ago
  for (int i = 0; i < 30; ++i) REQUIRE(factors.factor(matrix(20)) != Result::singular);
  REQUIRE(factors.uses_blocks());
  CHECK(factors.factor(std::vector<Real>(pattern.column.size(), 0)) == Result::singular);
  const std::vector<Real> sound = matrix(20);
  REQUIRE(factors.factor(sound) == Result::factored);
  CHECK(same_as_anew(sound));
}

TEST_CASE("a matrix that cannot be factored leaves no trace in the next one's factors") {
  const SparsePattern pattern = chain_pattern(3);
  const std::vector<Real> sound = chain_values(pattern, {0.1, 0.2, 0.3}, 1e-3, 0.05);
  const std::vector<Real> zero(sound.size(), 0);
  std::vector<Real> broken = sound;
  broken[4] = std::numeric_limits<Real>::quiet_NaN();
  const std::vector<Real> expected = solution_anew(pattern, sound, 1e-3);
  KluFactors factors;
  REQUIRE(factors.analyze(pattern));
  CHECK(factors.factor(zero) == Result::singular);
  CHECK(factors.factor(sound) == Result::factored);
  CHECK(factors.factor(sound) == Result::refactored);
  CHECK(factors.factor(broken) == Result::factored);  // its solution is not finite
  const std::vector<Real> undefined = solution(factors, pattern.rows());
  CHECK(std::any_of(undefined.begin(), undefined.end(), [](Real x) { return !std::isfinite(x); }));
  CHECK(factors.factor(sound) == Result::factored);
  CHECK(same_bits(solution(factors, pattern.rows()), expected));
  CHECK(factors.factor(zero) == Result::singular);
  CHECK(factors.factor(sound) == Result::factored);
  CHECK(same_bits(solution(factors, pattern.rows()), expected));
}

TEST_CASE("the transpose is solved with the same factors") {
  const SparsePattern pattern = {{0, 2, 3}, {0, 1, 1}};  // [2, 4; 0, 8]
  KluFactors factors;
  REQUIRE(factors.analyze(pattern));
  REQUIRE(factors.factor(std::vector<Real>{2, 4, 8}) == Result::factored);
  std::vector<Real> vector = {10, 8};
  REQUIRE(factors.solve(vector));
  CHECK(vector == std::vector<Real>{3, 1});
  vector = {2, 12};
  REQUIRE(factors.solve_transposed(vector));
  CHECK(vector == std::vector<Real>{1, 1});
}
#endif
