// Checkpoint: the whole state as named arrays in one HDF5 file, written beside and renamed.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/types.hpp"

namespace scree {

// What the step loop packs and unpacks; this room gives no meaning to it. Values return bit for bit. Names
// may hold
// '/' for groups.
struct Checkpoint {
  std::map<std::string, std::vector<Real>> reals;
  std::map<std::string, std::vector<std::int64_t>> integers;
  std::map<std::string, std::string> texts;  // the deck's fingerprint, version, commit

  // Throw IoError naming the file and what is missing.
  const std::vector<Real>& real_array(const std::string& name) const;
  const std::vector<std::int64_t>& integer_array(const std::string& name) const;
  const std::string& text(const std::string& name) const;
  std::string path;  // where it was read from, for messages
};

// Writes PATH.tmp, syncs it to disk and renames it to PATH. Throws IoError; PATH is then what it was before.
void write_checkpoint(const std::string& path, const Checkpoint& checkpoint);
// Throws IoError on a missing, truncated or foreign file.
Checkpoint read_checkpoint(const std::string& path);

}  // namespace scree
