// MPI and PETSc for test programs: started at the first use, finalized at the end of the program.
#pragma once

#include <mpi.h>

#include <optional>

#include "mbs/petsc_session.hpp"

namespace scree {

class PetscRun {
 public:
  PetscRun() {
    MPI_Init(nullptr, nullptr);
    // An unused option, which unused_options() must find.
    session_.emplace("test", std::vector<std::string>{"-mbs_misspelt", "7"});
  }
  ~PetscRun() {
    session_.reset();
    MPI_Finalize();
  }
  const PetscSession& session() const { return *session_; }

 private:
  std::optional<PetscSession> session_;
};

inline const PetscSession& petsc() {
  static const PetscRun run;
  return run.session();
}

}  // namespace scree
