#include "mbs/klu_factors.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace scree {

namespace {

// Quotients are rounded: within this margin of a limit klu_factor decides.
constexpr double kMargin = 1e-12;
// KLU's numbers of orderings.
constexpr int kAmd = 0, kColamd = 1;
// With so few rows even full factors cost little.
constexpr int kFewRows = 128;
// Fraction of weak diagonals that is tolerated.
constexpr double kWeakFraction = 1.0 / 16;
// Refactorizations with the same pivots after which a plan of blocks pays.
constexpr int kLasting = 20;

// Column k of L in one of KLU's blocks, without its diagonal of ones: row indices, then values from the next
// multiple of eight bytes (klu_internal.h).
struct Column {
  std::span<const int> row;
  const double* value;
};

Column column_of_l(const klu_numeric& numeric, int block, int k) {
  const auto* start = static_cast<const double*>(numeric.LUbx[block]) + numeric.Lip[k];
  const auto length = static_cast<std::size_t>(numeric.Llen[k]);
  const std::size_t units = (length * sizeof(int) + sizeof(double) - 1) / sizeof(double);
  return {{reinterpret_cast<const int*>(start), length}, start + units};
}

// Calls visit(block, first column of the block, column) for the columns that have pivots to choose.
template <class Visit>
void for_each_column(const klu_symbolic& symbolic, const Visit& visit) {
  for (int block = 0; block < symbolic.nblocks; ++block) {
    const int first = symbolic.R[block], end = symbolic.R[block + 1];
    if (end - first == 1) continue;
    for (int k = first; k < end; ++k) visit(block, first, k);
  }
}

}  // namespace

bool KluFactors::analyze(const SparsePattern& pattern, bool ordering_given) {
  pattern_ = pattern;
  numeric_.reset();
  if (!order()) return false;
  if (ordering_given || common_.ordering != kAmd || pattern.rows() < kFewRows || !needs_other_pivots())
    return true;
  common_.ordering = kColamd;
  return order();
}

bool KluFactors::order() {
  symbolic_.reset(klu_analyze(pattern_.rows(), pattern_.row_start.data(), pattern_.column.data(), &common_));
  return symbolic_ != nullptr;
}

// Whether the order places many weak diagonals before all other entries of their rows, where elimination has
// added nothing to them.
bool KluFactors::needs_other_pivots() const {
  if (pattern_.first_weak_diagonal < 0) return false;
  std::vector<int> position(static_cast<std::size_t>(pattern_.rows()));
  for (int k = 0; k < pattern_.rows(); ++k) position[static_cast<std::size_t>(symbolic_->Q[k])] = k;
  const auto position_of = [&](int row) { return position[static_cast<std::size_t>(row)]; };
  int bare = 0;
  for (int row = pattern_.first_weak_diagonal; row < pattern_.rows(); ++row) {
    const auto begin = pattern_.column.begin() + pattern_.row_start[static_cast<std::size_t>(row)],
               end = pattern_.column.begin() + pattern_.row_start[static_cast<std::size_t>(row) + 1];
    bare += std::none_of(begin, end, [&](int column) { return position_of(column) < position_of(row); });
  }
  return bare > kWeakFraction * (pattern_.rows() - pattern_.first_weak_diagonal);
}

// KLU expects columns and gets rows, so that it factors the transpose.
KluFactors::Result KluFactors::factor(std::span<const Real> values) {
  auto* array = const_cast<double*>(values.data());  // KLU only reads it
  if (numeric_ != nullptr && refactor(array)) return Result::refactored;
  return factor_anew(array);
}

KluFactors::Result KluFactors::factor_anew(double* values) {
  numeric_.reset();
  numeric_.reset(
      klu_factor(pattern_.row_start.data(), pattern_.column.data(), values, symbolic_.get(), &common_));
  if (numeric_ == nullptr) {
    return common_.status == KLU_OUT_OF_MEMORY ? Result::out_of_memory : Result::singular;
  }
  record_pivots();
  blocks_.forget(), refactored_ = 0;
  return Result::factored;
}

bool KluFactors::refactor(double* values) {
  if (uses_blocks()) return blocks_.refactor(values, *numeric_) && pivots_unchanged();
  const bool done = klu_refactor(pattern_.row_start.data(), pattern_.column.data(), values, symbolic_.get(),
                                 numeric_.get(), &common_) != 0 &&
                    common_.status == KLU_OK && pivots_unchanged();
  if (done && ++refactored_ == kLasting) blocks_.plan(pattern_, values, *symbolic_, *numeric_);
  return done;
}

// A quotient has the absolute value 1 exactly where its entry is as large as the pivot.
void KluFactors::record_pivots() {
  find_diagonals();
  ties_.clear();
  std::size_t entry = 0;
  for_each_column(*symbolic_, [&](int block, int, int k) {
    const Column column = column_of_l(*numeric_, block, k);
    for (std::size_t i = 0; i < column.row.size(); ++i, ++entry) {
      if (std::abs(column.value[i]) == 1) ties_.push_back(entry);
    }
  });
}

// The row that counts as a column's diagonal is at first its own. Where another row becomes the pivot, the
// diagonal row takes its place (klu_kernel.c).
void KluFactors::find_diagonals() {
  const auto n = static_cast<std::size_t>(symbolic_->n);
  std::vector<int> position(n), row(n), column(n);
  for (std::size_t k = 0; k < n; ++k)
    position[static_cast<std::size_t>(symbolic_->P[k])] = static_cast<int>(k);
  std::iota(row.begin(), row.end(), 0);        // row[k]: the diagonal of column k
  std::iota(column.begin(), column.end(), 0);  // its inverse
  diagonal_.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    const int diagonal = row[k];
    const int pivot = position[static_cast<std::size_t>(numeric_->Pnum[k])];
    diagonal_[k] = diagonal;
    const int other = column[static_cast<std::size_t>(pivot)];
    row[static_cast<std::size_t>(other)] = diagonal;
    column[static_cast<std::size_t>(diagonal)] = other;
    row[k] = pivot;
    column[static_cast<std::size_t>(pivot)] = static_cast<int>(k);
  }
  // From rows to their positions among the pivots; `column` is now the inverse of the pivots' order.
  for (int& diagonal : diagonal_) diagonal = column[static_cast<std::size_t>(diagonal)];
}

// klu_factor takes the diagonal if it is at least tol times the largest entry of its column. Otherwise it
// takes the first of the largest entries, in an order that depends only on the earlier pivots. The pivot is
// the first of the entries that were as large when it was chosen; for other entries that have become so the
// order is unknown.
bool KluFactors::pivots_unchanged() const {
  const double least = common_.tol * (1 - kMargin), most = (1 - kMargin) / common_.tol;
  bool stay = true;
  std::size_t entry = 0, tie = 0;
  for_each_column(*symbolic_, [&](int block, int first, int k) {
    const Column column = column_of_l(*numeric_, block, k);
    const int diagonal = diagonal_[static_cast<std::size_t>(k)];
    if (diagonal == k) {  // most columns: without branches
      bool small = true;
      for (std::size_t i = 0; i < column.row.size(); ++i) small &= std::abs(column.value[i]) <= most;
      stay &= small;
      entry += column.row.size();
      while (tie < ties_.size() && ties_[tie] < entry) ++tie;
      return;
    }
    for (std::size_t i = 0; i < column.row.size(); ++i, ++entry) {
      const double size = std::abs(column.value[i]);
      const bool was_tie = tie < ties_.size() && ties_[tie] == entry;
      tie += was_tie;
      stay = stay && (size < 1 || (size == 1 && was_tie)) &&
             (column.row[i] + first != diagonal || size <= least);
    }
  });
  return stay;
}

bool KluFactors::solve(std::span<Real> vector) {
  return klu_tsolve(symbolic_.get(), numeric_.get(), pattern_.rows(), 1, vector.data(), &common_) != 0;
}

bool KluFactors::solve_transposed(std::span<Real> vector) {
  return klu_solve(symbolic_.get(), numeric_.get(), pattern_.rows(), 1, vector.data(), &common_) != 0;
}

}  // namespace scree
