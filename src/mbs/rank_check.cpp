#include "mbs/rank_check.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace scree {

namespace {

// Pivot of A^T A, the squared distance of a column from the columns before it.
constexpr Real kSuspect = 1e-8;
constexpr Real kTakesPart = 1e-6;    // coefficient of a dependency, relative to the largest
constexpr Real kRoundOff = 1e-12;    // coefficients that count as zero, relative to the largest
constexpr Real kPivotShift = 1e-14;  // keeps the factorization going past a pivot that vanishes
constexpr Real kNearPart = 1e-3;     // coefficient of a near dependency that counts, relative to the largest
constexpr int kPasses = 2;           // of projections, each of which leaves their round-off

using Matrix = Eigen::SparseMatrix<Real>;
using Vector = Eigen::VectorXd;

// Eigen's own sums over dense vectors trigger a warning of GCC 12 in its AVX-512 header.
Real dot(const Vector& a, const Vector& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), Real(0));
}
Real largest(const Vector& a) {
  Real size = 0;
  for (const Real value : a) size = std::max(size, std::abs(value));
  return size;
}

// lengths: receives the divisors of the columns.
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

Matrix selected(const Matrix& a, const std::vector<int>& columns) {
  std::vector<Eigen::Triplet<Real>> triplets;
  for (std::size_t j = 0; j < columns.size(); ++j)
    for (Matrix::InnerIterator it(a, columns[j]); it; ++it)
      triplets.emplace_back(static_cast<int>(it.row()), static_cast<int>(j), it.value());
  Matrix b(a.rows(), static_cast<int>(columns.size()));
  b.setFromTriplets(triplets.begin(), triplets.end());
  return b;
}

// Columns of A that are well independent of each other, and the suspects, which may depend on them.
class Basis {
 public:
  // A column close to the ones before it spoils the pivots of those after it. The remaining columns are
  // therefore factored again until none is suspect. suspect: threshold of a pivot.
  Basis(const Matrix& a, Real suspect) : columns_(static_cast<std::size_t>(a.cols())) {
    std::iota(columns_.begin(), columns_.end(), 0);
    factors_.setShift(kPivotShift);
    for (bool found = true; found;) {
      b_ = selected(a, columns_);
      factors_.compute(Matrix(b_.transpose()) * b_);
      const Vector pivots = factors_.vectorD();
      std::vector<bool> stays(columns_.size(), true);
      for (Eigen::Index k = 0; k < pivots.size(); ++k)
        if (const int j = factors_.permutationPinv().indices()[k]; !(pivots[k] > suspect)) {
          stays[static_cast<std::size_t>(j)] = false;
          suspects_.push_back(columns_[static_cast<std::size_t>(j)]);
        }
      std::vector<int> left;
      for (std::size_t j = 0; j < stays.size(); ++j)
        if (stays[j]) left.push_back(columns_[j]);
      found = left.size() < columns_.size();
      columns_ = std::move(left);
    }
  }

  const std::vector<int>& suspects() const { return suspects_; }
  // Subtracts from `rest` its combination of the basis, and from `weight` the coefficients of it, by column
  // of A.
  void project(Vector& rest, Vector& weight) const {
    if (columns_.empty()) return;
    for (int pass = 0; pass < kPasses; ++pass) {
      const Vector c = factors_.solve(Vector(b_.transpose() * rest));
      rest -= b_ * c;
      for (std::size_t j = 0; j < columns_.size(); ++j)
        weight[columns_[j]] -= c[static_cast<Eigen::Index>(j)];
    }
  }

 private:
  std::vector<int> columns_, suspects_;  // of A
  Matrix b_;
  Eigen::SimplicialLDLT<Matrix> factors_;
};

// A suspect that is no combination of others: A weight is of length one.
struct Independent {
  Vector direction, weight;
};

Dependency dependency_of(const Vector& weight, const std::vector<Real>& lengths,
                         Real takes_part = kTakesPart) {
  const Real most = largest(weight);
  Dependency dependency;
  for (int j = 0; j < static_cast<int>(weight.size()); ++j) {
    const Real size = std::abs(weight[j]);
    if (size > kRoundOff * most)
      dependency.weight.emplace_back(j, weight[j] / lengths[static_cast<std::size_t>(j)]);
    if (size > takes_part * most) dependency.columns.push_back(j);
  }
  return dependency;
}

bool are_finite(const std::vector<MatrixEntry>& entries) {
  return std::all_of(entries.begin(), entries.end(),
                     [](const MatrixEntry& entry) { return std::isfinite(entry.value); });
}

}  // namespace

std::vector<Dependency> column_dependencies(int rows, int columns, const std::vector<MatrixEntry>& entries,
                                            Real distance) {
  if (columns == 0 || !are_finite(entries)) return {};
  std::vector<Real> lengths;
  const Matrix a = unit_columns(rows, columns, entries, lengths);
  const Basis basis(a, std::max(kSuspect, distance * distance));
  std::vector<Dependency> dependencies;
  std::vector<Independent> independent;
  for (const int column : basis.suspects()) {
    Vector rest = a.col(column), weight = Vector::Zero(columns);
    weight[column] = 1;
    basis.project(rest, weight);
    for (int pass = 0; pass < kPasses; ++pass)
      for (const Independent& other : independent) {
        const Real part = dot(other.direction, rest);
        rest -= part * other.direction, weight -= part * other.weight;
      }
    if (largest(rest) <= distance * largest(weight)) {
      dependencies.push_back(dependency_of(weight, lengths));
    } else {
      const Real length = std::sqrt(dot(rest, rest));
      independent.push_back({rest / length, weight / length});
    }
  }
  return dependencies;
}

// With w = (A^T A)^-1 e_j and columns of length one the product A w / w_j is column j less its combination
// of the others, of length 1 / sqrt(w_j).
std::vector<NearDependency> nearest_combinations(int rows, int columns,
                                                 const std::vector<MatrixEntry>& entries,
                                                 const std::vector<int>& of) {
  if (columns == 0 || !are_finite(entries)) return {};
  std::vector<Real> lengths;
  const Matrix a = unit_columns(rows, columns, entries, lengths);
  Eigen::SimplicialLDLT<Matrix> factors;
  factors.setShift(kPivotShift);
  factors.compute(Matrix(a.transpose()) * a);
  std::vector<NearDependency> found;
  for (const int column : of) {
    Vector unit = Vector::Zero(columns);
    unit[column] = 1;
    const Vector weight = factors.solve(unit);
    const Real square = 1 / weight[column];
    found.push_back({square > 0 ? std::sqrt(square) : 0, dependency_of(weight, lengths, kNearPart)});
  }
  return found;
}

std::vector<int> dependent_columns(int rows, int columns, const std::vector<MatrixEntry>& entries) {
  const std::vector<Dependency> dependencies = column_dependencies(rows, columns, entries);
  return dependencies.empty() ? std::vector<int>{} : dependencies.front().columns;
}

}  // namespace scree
