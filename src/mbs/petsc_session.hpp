// Starts and ends PETSc on rank 0 alone.
#pragma once

#include <string>
#include <vector>

namespace scree {

// options: the command line's words behind "--", in PETSc's syntax. Throws InputError on an option that PETSc
// refuses. PETSC_COMM_WORLD is MPI_COMM_SELF. Construct on rank 0, after MPI_Init.
class PetscSession {
 public:
  PetscSession(const std::string& program, const std::vector<std::string>& options);
  ~PetscSession();
  PetscSession(const PetscSession&) = delete;
  PetscSession& operator=(const PetscSession&) = delete;
};

// e.g. "3.18.5"
std::string petsc_version();

}  // namespace scree
