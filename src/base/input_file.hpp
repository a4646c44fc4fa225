// Checks of input files that do not depend on their format.
#pragma once

#include <string>
#include <string_view>

namespace scree {

// Whether the file is a Git LFS pointer, a few lines of text in place of a file that has not been fetched
// (https://github.com/git-lfs/git-lfs/blob/main/docs/spec.md). beginning: its first bytes.
bool is_lfs_pointer(std::string_view beginning);
inline constexpr const char* kLfsPointerError =
    "is a Git LFS pointer in place of the file; \"git lfs pull\" fetches the file";

// Why a file cannot serve as input, as the end of a sentence: "cannot be read: No such file or directory",
// "is a folder; must be a file", "is not a regular file", kLfsPointerError; empty if it can be read. Pipes
// and devices are refused, because input is read more than once.
std::string input_file_error(const std::string& path);

}  // namespace scree
