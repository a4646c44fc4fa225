// Finds linearly dependent columns of a sparse matrix.
#pragma once

#include <utility>
#include <vector>

#include "base/types.hpp"

namespace scree {

struct MatrixEntry {
  int row, column;
  Real value;
};

// sum of weight * column = 0.
struct Dependency {
  std::vector<int> columns;                  // that take part, in increasing order
  std::vector<std::pair<int, Real>> weight;  // those of the others are no more than round-off
};

constexpr Real kDependent = 1e-9;

// All linear dependencies of columns, as many as the columns less the rank. Entries at equal positions add
// up; with a value that is not finite there are none. Columns are scaled to length one; one counts as
// dependent if it is a combination of others to within `distance`. The cost is that of a sparse Cholesky
// factorization of A^T A, linear in the length of a chain, and for each dependency and each column that is
// near one the cost of a solution with it.
std::vector<Dependency> column_dependencies(int rows, int columns, const std::vector<MatrixEntry>& entries,
                                            Real distance = kDependent);
// The columns of one of them; empty if the columns are independent.
std::vector<int> dependent_columns(int rows, int columns, const std::vector<MatrixEntry>& entries);

}  // namespace scree
