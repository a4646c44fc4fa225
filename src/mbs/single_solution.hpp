// A single solution of the saddle-point systems without PETSc, and so without MPI.
#pragma once

#include <span>

#include "base/types.hpp"
#include "mbs/kkt_matrix.hpp"

namespace scree {

// Solves by Eigen's SparseLU, which pivots in every column. values: of the matrix, in the pattern's order.
// False: the matrix is singular, or the solution is not finite.
bool solve_once(const SparsePattern& pattern, std::span<const Real> values, std::span<const Real> rhs,
                std::span<Real> solution);

}  // namespace scree
