#include "mbs/rank_check.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>

namespace scree {

namespace {

constexpr Real kSuspect = 1e-8;      // pivot of A^T A, the squared distance of a column from those before it
constexpr Real kDependent = 1e-9;    // distance itself, computed from the columns
constexpr Real kTakesPart = 1e-6;    // coefficient of a dependency, relative to the largest
constexpr Real kPivotShift = 1e-14;  // keeps the factorization going past a pivot that vanishes

using Matrix = Eigen::SparseMatrix<Real>;
using Vector = Eigen::VectorXd;

Matrix unit_columns(int rows, int columns, const std::vector<MatrixEntry>& entries) {
  std::vector<Eigen::Triplet<Real>> triplets;
  triplets.reserve(entries.size());
  for (const MatrixEntry& entry : entries) triplets.emplace_back(entry.row, entry.column, entry.value);
  Matrix matrix(rows, columns);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  for (int j = 0; j < columns; ++j) {
    const Real length = matrix.col(j).norm();
    if (length > 0) matrix.col(j) /= length;
  }
  return matrix;
}

// With P A^T A P^T = L D L^T and l the part of L's row k left of the diagonal, the first k columns of A P^T
// combine by L_11^-T l to what is nearest to column k. The combination minus column k, in the order of A's
// columns.
Vector combination(const Matrix& l, int k, const Eigen::SimplicialLDLT<Matrix>& factors) {
  Vector c = Vector::Zero(l.rows());
  for (int i = 0; i < k; ++i) c[i] = l.coeff(k, i);
  for (int i = k; i-- > 0;) {
    for (Matrix::InnerIterator it(l, i); it; ++it) {
      if (it.row() > i && it.row() < k) c[i] -= it.value() * c[it.row()];
    }
  }
  c[k] = -1;
  return factors.permutationPinv() * c;
}

}  // namespace

std::vector<int> dependent_columns(int rows, int columns, const std::vector<MatrixEntry>& entries) {
  for (const MatrixEntry& entry : entries) {
    if (!std::isfinite(entry.value)) return {};
  }
  if (columns == 0) return {};
  const Matrix a = unit_columns(rows, columns, entries);
  const Matrix normal = Matrix(a.transpose()) * a;
  Eigen::SimplicialLDLT<Matrix> factors;
  factors.setShift(kPivotShift);
  factors.compute(normal);
  const Vector pivots = factors.vectorD();
  const Matrix l = factors.matrixL();
  for (int k = 0; k < columns; ++k) {
    if (pivots[k] > kSuspect) continue;
    const Vector c = combination(l, k, factors);
    const Vector rest = a * c;
    Real largest = 0, distance = 0;
    for (const Real x : c) largest = std::max(largest, std::abs(x));
    for (const Real x : rest) distance = std::max(distance, std::abs(x));
    if (distance > kDependent * largest) continue;
    std::vector<int> dependent;
    for (int j = 0; j < columns; ++j) {
      if (std::abs(c[j]) > kTakesPart * largest) dependent.push_back(j);
    }
    return dependent;
  }
  return {};
}

}  // namespace scree
