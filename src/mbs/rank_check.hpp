// Finds linearly dependent columns of a sparse matrix.
#pragma once

#include <vector>

#include "base/types.hpp"

namespace scree {

struct MatrixEntry {
  int row, column;
  Real value;
};

// The columns that take part in one linear dependency, in increasing order; empty if the columns are independent.
// Entries at equal positions add up; a value that is not finite makes the answer empty. Rank-revealing sparse QR;
// columns are first scaled to length one, and a column counts as dependent if less than 1e-10 of it is left.
std::vector<int> dependent_columns(int rows, int columns, const std::vector<MatrixEntry>& entries);

}  // namespace scree
