// Lists of texts in HDF5 files, which the program writes for other readers and does not read itself.
#pragma once

#include <string>
#include <vector>

#include "base/error.hpp"
#include "output/hdf5_file.hpp"
#include "output/hdf5_parts.hpp"

namespace scree {

// Texts of a dataset of variable-length strings. Throws IoError for any other dataset.
inline std::vector<std::string> read_texts(const Hdf5File& file, const std::string& name) {
  Hdf5Id dataset(H5Dopen2(file.id(), name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) throw IoError(file.path() + ": cannot open dataset " + name);
  Hdf5Id type(H5Dget_type(dataset), H5Tclose), space(H5Dget_space(dataset), H5Sclose);
  if (H5Tis_variable_str(type) <= 0) throw IoError(file.path() + ": " + name + " is not a list of texts");
  std::vector<char*> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  if (H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    throw IoError(file.path() + ": cannot read dataset " + name);
  std::vector<std::string> texts(values.begin(), values.end());
  H5Dvlen_reclaim(type, space, H5P_DEFAULT, values.data());
  return texts;
}

}  // namespace scree
