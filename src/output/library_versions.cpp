#include "output/library_versions.hpp"

#include <fmt/format.h>
#include <hdf5.h>
#include <mpi.h>
#include <toml++/toml.h>

#include <array>

#include "base/index.hpp"
#include "output/shared_rows.hpp"

namespace scree {

namespace {

std::string hdf5_version() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return fmt::format("{}.{}.{}, {}", major, minor, release,
                     kParallelHdf5 ? "all ranks write" : "rank 0 writes for all");
}

// The first part of the library's text, e.g. "Open MPI v4.1.4".
std::string mpi_version() {
  std::array<char, MPI_MAX_LIBRARY_VERSION_STRING> text{};
  int length = 0;
  MPI_Get_library_version(text.data(), &length);
  const std::string sentence(text.data(), as_size(length));
  return sentence.substr(0, sentence.find_first_of(",\n"));
}

}  // namespace

std::vector<std::pair<std::string, std::string>> library_versions() {
  return {{"HDF5", hdf5_version()},
          {"MPI", mpi_version()},
          {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
          {"toml++", fmt::format("{}.{}.{}", TOML_LIB_MAJOR, TOML_LIB_MINOR, TOML_LIB_PATCH)}};
}

}  // namespace scree
