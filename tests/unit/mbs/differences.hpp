// Dense matrices from sparse terms and from central differences.
#pragma once

#include <functional>
#include <vector>

#include "mbs/sparse_term.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

// Round-off of central differences of half width 1e-6, of terms of up to 100, and their truncation.
inline constexpr Real kDifferences = 3e-8;

using Matrix = std::vector<std::vector<Real>>;

inline Matrix dense(const SparseTerm& term, int rows, int columns) {
  Matrix matrix(static_cast<std::size_t>(rows), std::vector<Real>(static_cast<std::size_t>(columns), 0));
  for (std::size_t i = 0; i < term.size(); ++i) {
    matrix[static_cast<std::size_t>(term.row(i))][static_cast<std::size_t>(term.column(i))] += term.value(i);
  }
  return matrix;
}

// d f / d x by central differences of half width `step`.
inline Matrix differences(const std::function<std::vector<Real>(const std::vector<Real>&)>& f,
                          std::vector<Real> x, Real step = 1e-6) {
  Matrix matrix(f(x).size(), std::vector<Real>(x.size()));
  for (std::size_t j = 0; j < x.size(); ++j) {
    const Real centre = x[j];
    x[j] = centre + step;
    const std::vector<Real> after = f(x);
    x[j] = centre - step;
    const std::vector<Real> before = f(x);
    x[j] = centre;
    for (std::size_t i = 0; i < after.size(); ++i) matrix[i][j] = (after[i] - before[i]) / (2 * step);
  }
  return matrix;
}

inline void check_equal(const Matrix& a, const Matrix& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < a[i].size(); ++j) {
      CAPTURE(i, j);
      CHECK(near(a[i][j], b[i][j], {.relative = kDifferences, .absolute = kDifferences}));
    }
  }
}

}  // namespace scree
