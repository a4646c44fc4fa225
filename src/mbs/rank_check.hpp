// Linear dependencies of the columns of a sparse matrix.
#pragma once

#include <utility>
#include <vector>

#include "base/types.hpp"

namespace scree {

struct MatrixEntry {
  int row, column;
  Real value;
};

// One dependency: sum of weight * column = 0.
struct Dependency {
  std::vector<int> columns;                  // the columns that take part, in increasing order
  std::vector<std::pair<int, Real>> weight;  // the weights of all others are round-off
};

constexpr Real kDependent = 1e-9;

// All linear dependencies of columns, as many as the columns less the rank. Entries at equal positions add
// up; none is returned where a value is not finite. Columns are scaled to length one; a column counts as
// dependent if it is a combination of others to within `distance`. The cost is that of a sparse Cholesky
// factorization of A^T A, linear in the length of a chain, plus one solution for each dependency and for
// each column near one.
std::vector<Dependency> column_dependencies(int rows, int columns, const std::vector<MatrixEntry>& entries,
                                            Real distance = kDependent);

// The distance of a column of length one from the nearest combination of all others of length one, and that
// combination with the column itself; its `columns` are those whose weight counts.
struct NearDependency {
  Real distance = 1;
  Dependency combination;
};
// Nearest combinations of the columns in `of`, whatever the order of the others. Distances above 1e-7 are
// exact to a percent; below that they are upper bounds. Empty where an entry is not finite. The cost is that
// of the factorization and of one solution for each column asked for.
std::vector<NearDependency> nearest_combinations(int rows, int columns,
                                                 const std::vector<MatrixEntry>& entries,
                                                 const std::vector<int>& of);

// The columns of one dependency; empty if the columns are independent.
std::vector<int> dependent_columns(int rows, int columns, const std::vector<MatrixEntry>& entries);

}  // namespace scree
