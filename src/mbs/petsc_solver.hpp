// Sparse direct solution of the saddle-point systems through PETSc.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "mbs/kkt_matrix.hpp"

namespace scree {

// KSP preonly + LU, overruled by PETSc options with the prefix mbs_. The factor package is the first one that
// there is of: KLU with kept pivots (petsc_klu.hpp), PETSc's KLU, SuperLU, UMFPACK, MUMPS, PETSc's own LU.
// The symbolic factorization is done once.
class PetscSolver {
 public:
  // Without a PetscSession, as in a check that is to start no MPI, another library solves (Eigen's SparseLU):
  // good for the few solutions at t = 0. Throws InputError on an mbs_ option that PETSc refuses.
  explicit PetscSolver(const SparsePattern& pattern);
  ~PetscSolver();
  PetscSolver(const PetscSolver&) = delete;
  PetscSolver& operator=(const PetscSolver&) = delete;

  std::span<Real> values();                // of the matrix, in the pattern's order
  std::span<Real> rhs();                   // [rows]
  std::span<const Real> solution() const;  // [rows]

  // Powers of two [rows]: rows and unknowns are multiplied by them for the factorization, which chooses its
  // pivots by size, and by nothing else, as this costs no digits. Empty: by 1.
  void set_units(std::vector<Real> units);

  // Solves for rhs(). refactor: values() changed since the last call; otherwise its factors are used again.
  // False: the matrix is singular, or the solution is not finite. Throws SimulationError on any other failure
  // of PETSc.
  bool solve(bool refactor);

  // e.g. "petsc 3.18.5, preonly + lu (klu_refactor)"; without a PetscSession that of one without options
  std::string description() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace scree
