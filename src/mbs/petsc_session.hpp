// Starts and ends PETSc on rank 0 alone.
#pragma once

#include <string>
#include <vector>

namespace scree {

// options: the command line's words behind "--", in PETSc's syntax. Throws InputError on a word that is
// neither an option nor its value, and on an option that PETSc refuses. PETSC_COMM_WORLD is MPI_COMM_SELF.
// Construct on rank 0, after MPI_Init.
class PetscSession {
 public:
  PetscSession(const std::string& program, const std::vector<std::string>& options);
  ~PetscSession();
  PetscSession(const PetscSession&) = delete;
  PetscSession& operator=(const PetscSession&) = delete;

  // The given options that no call has used so far, e.g. because of a misspelt name; for a warning at the
  // end.
  std::vector<std::string> unused_options() const;

 private:
  std::vector<std::string> words_;  // PETSc keeps pointers to its command line
  std::vector<char*> arguments_;
};

// e.g. "3.18.5"
std::string petsc_version();

}  // namespace scree
