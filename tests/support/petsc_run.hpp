// MPI and PETSc for test programs: started at the first use, ended when the program ends.
#pragma once

#include <mpi.h>

#include <optional>

#include "mbs/petsc_session.hpp"

namespace scree {

class PetscRun {
 public:
  PetscRun() {
    MPI_Init(nullptr, nullptr);
    // Nothing asks for this option: it is what unused_options() must find.
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
