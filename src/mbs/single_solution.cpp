#include "mbs/single_solution.hpp"

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>

namespace scree {

bool solve_once(const SparsePattern& pattern, std::span<const Real> values, std::span<const Real> rhs,
                std::span<Real> solution) {
  using Rows = Eigen::SparseMatrix<Real, Eigen::RowMajor>;
  using Columns = Eigen::SparseMatrix<Real>;
  const int n = pattern.rows();
  const Eigen::Map<const Rows> by_rows(n, n, std::ssize(values), pattern.row_start.data(),
                                       pattern.column.data(), values.data());
  const Columns matrix = by_rows;
  Eigen::SparseLU<Columns> factors(matrix);
  if (factors.info() != Eigen::Success) return false;
  Eigen::Map<Eigen::VectorXd>(solution.data(), n) =
      factors.solve(Eigen::Map<const Eigen::VectorXd>(rhs.data(), n));
  return std::ranges::all_of(solution, [](Real x) { return std::isfinite(x); });
}

}  // namespace scree
