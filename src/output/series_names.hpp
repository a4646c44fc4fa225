// The names of what the fields of a VTKHDF series count.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "output/hdf5_file.hpp"

namespace scree {

// Entry k is the name of number k.
struct SeriesNames {
  std::string name;  // of the list
  std::vector<std::string> entries;
};

// In a new file: the dataset /Scree/NAME, one per line. For VTK the same as text in the field data of every
// snapshot, of which there is one copy for all.
void create_names(Hdf5File& file, const SeriesNames& names, std::int64_t steps_per_chunk);
// With each snapshot more, and where the file is cut to so many. Files without field data stay so.
void append_names(Hdf5File& file);
void cut_names(Hdf5File& file, std::int64_t snapshots);

}  // namespace scree
