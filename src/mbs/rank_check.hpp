// Finds linearly dependent columns of a sparse matrix.
#pragma once

#include <vector>

#include "base/types.hpp"

namespace scree {

struct MatrixEntry {
  int row, column;
  Real value;
};

// The columns that take part in one linear dependency, in increasing order; empty if the columns are
// independent. Entries at equal positions add up; with a value that is not finite the answer is empty.
// Columns are scaled to length one; they count as dependent if one of them is a combination of others to
// within 1e-9. The cost is that of a sparse Cholesky factorization of A^T A: linear in the length of a chain.
std::vector<int> dependent_columns(int rows, int columns, const std::vector<MatrixEntry>& entries);

}  // namespace scree
