// Files that survive a crash: synced to disk, written beside and renamed. What is created is a new file,
// whatever had its name before: links are not followed.
#pragma once

#include <string>

namespace scree {

// All of a file. Throws IoError with the system's reason, of a folder, too.
std::string read_text_file(const std::string& path);

// Copies a file, in the place of an old one where there is one. Throws IoError; a part may then have been
// copied.
void copy_file(const std::string& from, const std::string& to);

// Waits until the file's content is on disk. Throws IoError.
void sync_file(const std::string& path);

// Reserves the disk space of an existing file up to its size, so that no later write into it meets a full
// disk. Throws IoError where there is not enough. Returns false where the file system cannot reserve.
bool reserve_file(const std::string& path);

// Waits until the names of the files in PATH's folder are on disk. Throws IoError.
void sync_folder_of(const std::string& path);

// Gives a synced file its final name at one instant, replacing what was there, and syncs the directory.
// Throws IoError; `to` is then what it was before.
void replace_file(const std::string& from, const std::string& to);

// Gives the synced file HIDDEN the name PATH at one instant, and the file that had it, if any, the name
// HIDDEN. Whether that one is there; some file systems need the name ASIDE for it meanwhile. Does not sync
// the folder. Throws IoError.
bool exchange_files(const std::string& hidden, const std::string& path, const std::string& aside);

// Writes PATH.tmp, syncs it and renames it to PATH. Throws IoError; PATH is then what it was before.
void write_text_file(const std::string& path, const std::string& text);

// Adds text at the end of an existing file and syncs it. Throws IoError; a part may then have been written.
void append_text_file(const std::string& path, const std::string& text);

}  // namespace scree
