// Recognizes the kind of a file by its first bytes, for messages on input files of a wrong kind.
#pragma once

#include <string>
#include <string_view>

namespace scree {

// Kinds for which a message about decks has advice of its own.
inline constexpr const char *kHdf5Kind = "an HDF5 file", *kUrdfKind = "a robot model (URDF)";

// Number of bytes that suffice.
inline constexpr std::size_t kFileBeginning = 512;

bool is_hdf5(std::string_view beginning);

// "an HDF5 file", "a ZIP archive, e.g. a spreadsheet (.xlsx, .ods)", "XML", ...; empty for other text.
// beginning: the first kFileBeginning bytes, or the complete file.
std::string kind_of_file(std::string_view beginning);

// The first kFileBeginning bytes of a file, or all of a shorter one; empty if it cannot be read.
std::string beginning_of_file(const std::string& path);

}  // namespace scree
