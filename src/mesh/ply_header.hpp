// The header of a PLY file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mesh/token_reader.hpp"

namespace scree {

struct PlyType {
  const char *name, *other_name;
  std::size_t bytes;
  bool whole, has_sign;
};

struct PlyProperty {
  std::string name;
  const PlyType* type;
  const PlyType* count_type;  // type of the length of a list; nullptr: a single value
};

struct PlyElement {
  std::string name;
  std::int64_t count;
  std::vector<PlyProperty> properties;  // at least one
};

enum class PlyForm { ascii, low_byte_first, high_byte_first };

struct PlyHeader {
  PlyForm form = PlyForm::ascii;
  std::vector<PlyElement> elements;
};

// Reads up to the end of the line of end_header. Throws InputError for statements outside PLY 1.0.
PlyHeader read_ply_header(TokenReader& words);

}  // namespace scree
