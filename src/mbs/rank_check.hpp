// Finds linearly dependent columns of a sparse matrix.
#pragma once

#include <vector>

#include "base/types.hpp"

namespace scree {

struct MatrixEntry {
  int row, column;
  Real value;
};

// All linear dependencies of columns, as many as the columns less the rank; of each the columns that take
// part, in increasing order. Entries at equal positions add up; with a value that is not finite there are
// none. Columns are scaled to length one; one counts as dependent if it is a combination of others to within
// 1e-9. The cost is that of a sparse Cholesky factorization of A^T A, linear in the length of a chain, and
// for each dependency that of the columns from which it is found.
std::vector<std::vector<int>> column_dependencies(int rows, int columns,
                                                  const std::vector<MatrixEntry>& entries);
// One of them; empty if the columns are independent.
std::vector<int> dependent_columns(int rows, int columns, const std::vector<MatrixEntry>& entries);

}  // namespace scree
