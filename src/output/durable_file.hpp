// Files that survive a crash: they are synced to disk, and written under another name before a rename. A
// created file replaces any file of its name; links are not followed.
#pragma once

#include <string>

namespace scree {

// Content of a file. Throws IoError with the system's reason, also for a folder.
std::string read_text_file(const std::string& path);

// Copies a file over an existing one, if any. Throws IoError; the copy may then be incomplete.
void copy_file(const std::string& from, const std::string& to);

// Waits until the content of the file is on disk. Throws IoError.
void sync_file(const std::string& path);

// Reserves disk space for an existing file up to its size, so that later writes within it cannot fail on a
// full disk. Throws IoError if the space is missing. Returns false if the file system cannot reserve.
bool reserve_file(const std::string& path);

// Waits until the names of the files in the folder of `path` are on disk. Throws IoError.
void sync_folder_of(const std::string& path);

// Atomically renames a synced file to `to`, replacing an existing file, and syncs the folder. Throws IoError,
// with `to` unchanged.
void replace_file(const std::string& from, const std::string& to);

// Atomically gives the synced file `hidden` the name `path`, and the previous file of that name, if any, the
// name `hidden`. Returns whether that file exists. Some file systems need the name `aside` for it meanwhile.
// Does not sync the folder. Throws IoError.
bool exchange_files(const std::string& hidden, const std::string& path, const std::string& aside);

// Writes PATH.tmp, syncs it and renames it to PATH. Throws IoError, with PATH unchanged.
void write_text_file(const std::string& path, const std::string& text);

// Appends text to an existing file and syncs it. Throws IoError; a part of the text may then have been
// written.
void append_text_file(const std::string& path, const std::string& text);

}  // namespace scree
