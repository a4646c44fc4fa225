// Files that a user gives as input, before anything is known of their format.
#pragma once

#include <string>
#include <string_view>

namespace scree {

// Whether a file that begins with these bytes is what Git leaves in place of a file that Git LFS has not
// fetched: a few lines of text that name it (https://github.com/git-lfs/git-lfs/blob/main/docs/spec.md).
bool is_lfs_pointer(std::string_view beginning);
inline constexpr const char* kLfsPointerTrouble =
    "is a pointer of Git LFS, not the file itself, which \"git lfs pull\" fetches";

// Why a file is no input, whatever it is meant to hold, as the end of a sentence on it: "cannot be read: No
// such file or directory", "is a folder; must be a file", "is no regular file", kLfsPointerTrouble; ""
// where it can be read. Input is read more than once, so that pipes and devices are none.
std::string input_file_trouble(const std::string& path);

}  // namespace scree
