// KLU with reused pivots as a factor package of PETSc, beside PETSc's own interface to KLU, which repeats
// the full factorization each time.
#pragma once

#include <petscmat.h>

#include "mbs/kkt_matrix.hpp"

namespace scree {

class KluFactors;

inline constexpr const char* kKluRefactor = "klu_refactor";

// Registers the package with PETSc, for LU of sequential matrices. It takes the options of PETSc's own
// interface (prefix_mat_klu_pivot_tol, _use_btf, _ordering, _row_scale) with the same defaults; the
// ordering, unless given, is chosen as in KluFactors.
PetscErrorCode register_klu_refactor();

// Attaches the matrix' own pattern, which marks its weak diagonals and must outlive it.
PetscErrorCode attach_pattern(Mat matrix, const SparsePattern& pattern);

// The factors behind a factor matrix of this package, which owns them.
PetscErrorCode factors_of(Mat factor, KluFactors** factors);

}  // namespace scree
