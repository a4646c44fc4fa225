// What kind of file begins with some bytes: for messages on files that are no input of the kind that was
// wanted.
#pragma once

#include <string>
#include <string_view>

namespace scree {

// So many first bytes are enough.
inline constexpr std::size_t kFileBeginning = 512;

bool is_hdf5(std::string_view beginning);

// "an HDF5 file", "a ZIP archive, as spreadsheets are (.xlsx, .ods)", "XML", ...; "" of text that may be
// anything. beginning: the first kFileBeginning bytes, or all.
std::string kind_of_file(std::string_view beginning);

// The first kFileBeginning bytes of a file, or what it has; "" where it cannot be read.
std::string beginning_of_file(const std::string& path);

}  // namespace scree
