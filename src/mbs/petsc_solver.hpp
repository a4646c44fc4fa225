// Sparse direct solution of the saddle-point systems through PETSc.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "mbs/kkt_matrix.hpp"

namespace scree {

// KSP preonly + LU, overruled by PETSc options with the prefix mbs_. The factor package is the first
// available of: KLU with reused pivots (petsc_klu.hpp), PETSc's KLU, SuperLU, UMFPACK, MUMPS, PETSc's own
// LU. The symbolic factorization is done once.
class PetscSolver {
 public:
  // Without a PetscSession, as in a check that starts no MPI, Eigen's SparseLU solves: good for the few
  // solutions at t = 0. Throws InputError on an mbs_ option that PETSc refuses.
  explicit PetscSolver(const SparsePattern& pattern);
  ~PetscSolver();
  PetscSolver(const PetscSolver&) = delete;
  PetscSolver& operator=(const PetscSolver&) = delete;

  std::span<Real> values();                // of the matrix, in the pattern's order
  std::span<Real> rhs();                   // [rows]
  std::span<const Real> solution() const;  // [rows]

  // Powers of two [rows] by which rows and unknowns are multiplied for the factorization, which chooses its
  // pivots by size; this costs no digits. Empty: all 1.
  void set_units(std::vector<Real> units);

  // Solves for rhs(). refactor: values() changed since the last call; otherwise the existing factors are
  // used. False: the matrix is singular, or the solution is not finite. Throws SimulationError on any other
  // failure of PETSc.
  bool solve(bool refactor);

  // Computes the factors of values() ahead, so that the next solve() may use the existing ones. False where
  // solve() has to do it, as in PETSc's own calls, or where the matrix is singular.
  bool factor();

  // e.g. "petsc 3.18.5, preonly + lu (klu_refactor)"; without a PetscSession the description for no options
  std::string description() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace scree
