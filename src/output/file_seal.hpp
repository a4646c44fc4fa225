// A checksum of a whole file, in a line of text at its end: what was damaged on a disk or on the way is told
// before anybody makes sense of it. HDF5 does not look behind its own content, and cuts the line off where it
// changes the file.
#pragma once

#include <string>

#include "partition/ranks.hpp"

namespace scree {

enum class Seal {
  intact,
  broken,  // the content is not what was sealed
  none     // the file ends without one
};

// Appends the seal and syncs it to disk; the ranks read the file together. Throws IoError. Collective.
void seal_file(const std::string& path, const Ranks& ranks);
// Throws IoError where the file cannot be read. Collective.
Seal check_seal(const std::string& path, const Ranks& ranks);

}  // namespace scree
