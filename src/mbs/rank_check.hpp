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

// How far a column of length one is from the nearest combination of all others of length one, and that
// combination with the column itself; its `columns` are those whose weight counts.
struct NearDependency {
  Real distance = 1;
  Dependency combination;
};
// Of each column in `of`, whatever the order of the others: distances above 1e-7 are exact to a percent,
// below that they are no more than small. None where an entry is not finite. The cost is that of the
// factorization and of one solution for each column asked for.
std::vector<NearDependency> nearest_combinations(int rows, int columns,
                                                 const std::vector<MatrixEntry>& entries,
                                                 const std::vector<int>& of);

// The columns of one of them; empty if the columns are independent.
std::vector<int> dependent_columns(int rows, int columns, const std::vector<MatrixEntry>& entries);

}  // namespace scree
