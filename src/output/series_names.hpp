// Names of the objects that fields of a VTKHDF series number.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "output/hdf5_file.hpp"

namespace scree {

// Entry k is the name of object k.
struct SeriesNames {
  std::string name;  // of the list
  std::vector<std::string> entries;
};

// Creates the dataset /Scree/NAME with one name per line in a new file. For VTK the names are also texts in
// the field data of every snapshot, stored once for all.
void create_names(Hdf5File& file, const SeriesNames& names, std::int64_t steps_per_chunk);
// Adds a snapshot, or cuts the file to so many. Files without field data are left unchanged.
void append_names(Hdf5File& file);
void cut_names(Hdf5File& file, std::int64_t snapshots);

}  // namespace scree
