// The files that meshes come in: read_mesh.hpp says what is common. Each takes a file's bytes and its name
// for messages, throws InputError, and trusts no number of the file: what it makes is never larger than what
// the file has bytes for.
#pragma once

#include <string>
#include <string_view>

#include "mesh/triangle_mesh.hpp"

namespace scree {

TriangleMesh parse_stl(std::string_view bytes, const std::string& file);
TriangleMesh parse_obj(std::string_view bytes, const std::string& file);
TriangleMesh parse_ply(std::string_view bytes, const std::string& file);

}  // namespace scree
