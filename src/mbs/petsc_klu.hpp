// KLU with kept pivots as a factor package of PETSc, beside PETSc's own interface to KLU, which always
// factors anew.
#pragma once

#include <petscmat.h>

#include "mbs/kkt_matrix.hpp"

namespace scree {

inline constexpr const char* kKluRefactor = "klu_refactor";

// Makes the package known to PETSc, for LU of sequential matrices. It takes the options of PETSc's own
// interface (prefix_mat_klu_pivot_tol, _use_btf, _ordering, _row_scale), with the same defaults, but that
// the ordering is chosen as KluFactors says unless it is given.
PetscErrorCode register_klu_refactor();

// Tells the package of a matrix' weak diagonals. pattern: its own, which must outlive it.
PetscErrorCode attach_pattern(Mat matrix, const SparsePattern& pattern);

}  // namespace scree
