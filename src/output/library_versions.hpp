// Versions of the libraries in use, as each library reports them.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace scree {

// {name, version}, e.g. {"fmt", "9.1.0"}; for HDF5 with the ranks that write. For MPI the version loaded at
// run time; for header libraries the compiled version. petsc_version() (mbs) gives that of PETSc. May be
// called before MPI_Init.
std::vector<std::pair<std::string, std::string>> library_versions();

}  // namespace scree
