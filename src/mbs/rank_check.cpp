#include "mbs/rank_check.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <Eigen/SparseQR>
#include <algorithm>
#include <cmath>

namespace scree {

namespace {

constexpr Real kDependent = 1e-10;
constexpr Real kTakesPart = 1e-6;  // of the largest coefficient of a dependency

using Matrix = Eigen::SparseMatrix<Real>;

Matrix scaled_columns(int rows, int columns, const std::vector<MatrixEntry>& entries) {
  std::vector<Eigen::Triplet<Real>> triplets;
  triplets.reserve(entries.size());
  for (const MatrixEntry& entry : entries) triplets.emplace_back(entry.row, entry.column, entry.value);
  Matrix matrix(rows, columns);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  for (int j = 0; j < columns; ++j) {
    const Real length = matrix.col(j).norm();
    if (length > 0) matrix.col(j) /= length;
  }
  matrix.makeCompressed();
  return matrix;
}

}  // namespace

std::vector<int> dependent_columns(int rows, int columns, const std::vector<MatrixEntry>& entries) {
  if (columns == 0) return {};
  for (const MatrixEntry& entry : entries) {
    if (!std::isfinite(entry.value)) return {};
  }
  Eigen::SparseQR<Matrix, Eigen::COLAMDOrdering<int>> qr;
  qr.setPivotThreshold(kDependent);
  qr.compute(scaled_columns(rows, columns, entries));
  const int rank = static_cast<int>(qr.rank());
  if (rank == columns) return {};
  // A P = Q [R_11, R_12; 0, 0]: the first dependent column equals the independent ones times R_11^-1 R_12.
  const Matrix r = qr.matrixR();
  const Matrix r11 = r.topLeftCorner(rank, rank);
  const Eigen::VectorXd r12 = Eigen::VectorXd(r.col(rank)).head(rank);
  const Eigen::VectorXd coefficient = r11.triangularView<Eigen::Upper>().solve(r12);
  Real largest = 1;
  for (const Real c : coefficient) largest = std::max(largest, std::abs(c));
  const auto& permutation = qr.colsPermutation().indices();
  std::vector<int> dependent{static_cast<int>(permutation[rank])};
  for (int i = 0; i < rank; ++i) {
    if (std::abs(coefficient[i]) > kTakesPart * largest) dependent.push_back(static_cast<int>(permutation[i]));
  }
  std::sort(dependent.begin(), dependent.end());
  return dependent;
}

}  // namespace scree
