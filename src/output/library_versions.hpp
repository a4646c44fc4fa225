// Versions of the libraries that this program runs with, as each library tells them.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace scree {

// {name, version}, e.g. {"fmt", "9.1.0"}; HDF5's with who writes. The MPI library's is the one loaded at run
// time; header libraries give the version compiled in. PETSc's is petsc_version() (mbs). May be called before
// MPI_Init.
std::vector<std::pair<std::string, std::string>> library_versions();

}  // namespace scree
