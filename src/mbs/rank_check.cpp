#include "mbs/rank_check.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

namespace scree {

namespace {

constexpr Real kSuspect = 1e-8;      // pivot of A^T A, the squared distance of a column from those before it
constexpr Real kTakesPart = 1e-6;    // coefficient of a dependency, relative to the largest
constexpr Real kPivotShift = 1e-14;  // keeps the factorization going past a pivot that vanishes

using Matrix = Eigen::SparseMatrix<Real>;
using RowMajorMatrix = Eigen::SparseMatrix<Real, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;

// lengths: what the columns are divided by.
Matrix unit_columns(int rows, int columns, const std::vector<MatrixEntry>& entries,
                    std::vector<Real>& lengths) {
  std::vector<Eigen::Triplet<Real>> triplets;
  triplets.reserve(entries.size());
  for (const MatrixEntry& entry : entries) triplets.emplace_back(entry.row, entry.column, entry.value);
  Matrix matrix(rows, columns);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  for (int j = 0; j < columns; ++j) {
    const Real length = matrix.col(j).norm();
    lengths.push_back(length > 0 ? length : 1);
    matrix.col(j) /= lengths.back();
  }
  return matrix;
}

using Combination = std::map<int, Real, std::greater<>>;  // coefficient by place in the order of elimination

// With P A^T A P^T = L D L^T and l the part of L's row k left of the diagonal, the first k columns of A P^T
// combine by L_11^-T l to what is nearest to column k. The combination minus column k; without columns that
// depend on others themselves.
Combination combination(const RowMajorMatrix& l, int k, const std::vector<bool>& depends) {
  Combination c, left;
  const auto subtract = [&](int row, Real scale) {
    for (RowMajorMatrix::InnerIterator it(l, row); it; ++it) {
      const int i = static_cast<int>(it.col());
      if (i < row && !depends[static_cast<std::size_t>(i)]) left[i] -= scale * it.value();
    }
  };
  subtract(k, -1);
  while (!left.empty()) {
    const auto [i, value] = *left.begin();
    left.erase(left.begin());
    c[i] = value;
    subtract(i, value);
  }
  c[k] = -1;
  return c;
}

// Largest component of A P^T c.
Real length_of(const Matrix& a, const std::vector<int>& column_at, const Combination& c) {
  std::map<int, Real> sum;
  for (const auto& [place, weight] : c)
    for (Matrix::InnerIterator it(a, column_at[static_cast<std::size_t>(place)]); it; ++it)
      sum[static_cast<int>(it.row())] += weight * it.value();
  Real largest = 0;
  for (const auto& [row, value] : sum) largest = std::max(largest, std::abs(value));
  return largest;
}

}  // namespace

std::vector<Dependency> column_dependencies(int rows, int columns, const std::vector<MatrixEntry>& entries,
                                            Real distance) {
  for (const MatrixEntry& entry : entries) {
    if (!std::isfinite(entry.value)) return {};
  }
  if (columns == 0) return {};
  std::vector<Real> lengths;
  const Matrix a = unit_columns(rows, columns, entries, lengths);
  const Matrix normal = Matrix(a.transpose()) * a;
  Eigen::SimplicialLDLT<Matrix> factors;
  factors.setShift(kPivotShift);
  factors.compute(normal);
  const Vector pivots = factors.vectorD();
  const RowMajorMatrix l = Matrix(factors.matrixL());
  std::vector<int> column_at(static_cast<std::size_t>(columns));  // by place in the order of elimination
  for (int j = 0; j < columns; ++j)
    column_at[static_cast<std::size_t>(factors.permutationP().indices()[j])] = j;
  std::vector<Dependency> dependencies;
  std::vector<bool> depends(static_cast<std::size_t>(columns), false);
  for (int k = 0; k < columns; ++k) {
    if (pivots[k] > std::max(kSuspect, distance * distance)) continue;
    const Combination c = combination(l, k, depends);
    Real largest = 0;
    for (const auto& [place, weight] : c) largest = std::max(largest, std::abs(weight));
    if (length_of(a, column_at, c) > distance * largest) continue;
    depends[static_cast<std::size_t>(k)] = true;
    Dependency& dependency = dependencies.emplace_back();
    for (const auto& [place, weight] : c) {
      const int column = column_at[static_cast<std::size_t>(place)];
      dependency.weight.emplace_back(column, weight / lengths[static_cast<std::size_t>(column)]);
      if (std::abs(weight) > kTakesPart * largest) dependency.columns.push_back(column);
    }
    std::sort(dependency.columns.begin(), dependency.columns.end());
  }
  return dependencies;
}

std::vector<int> dependent_columns(int rows, int columns, const std::vector<MatrixEntry>& entries) {
  const std::vector<Dependency> dependencies = column_dependencies(rows, columns, entries);
  return dependencies.empty() ? std::vector<int>{} : dependencies.front().columns;
}

}  // namespace scree
