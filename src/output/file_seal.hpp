// A checksum of a complete file, in a line of text at its end: damage on a disk or in a transfer is found
// before the content is read. HDF5 ignores bytes after its own content, and cuts the line off when it
// modifies the file.
#pragma once

#include <string>

#include "partition/ranks.hpp"

namespace scree {

enum class Seal {
  intact,
  broken,  // the content does not match the checksum
  none     // the file has no checksum at its end
};

// Appends the checksum and syncs the file; the ranks read the file together. Throws IoError. Collective.
void seal_file(const std::string& path, const Ranks& ranks);
// Checks the checksum. Throws IoError if the file cannot be read. Collective.
Seal check_seal(const std::string& path, const Ranks& ranks);

}  // namespace scree
