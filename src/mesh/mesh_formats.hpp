// Parsers of mesh files; read_mesh.hpp documents what they have in common. Each takes the bytes of a file
// and its name for messages, throws InputError, and trusts no number in the file: its result is never larger
// than the file has bytes for.
#pragma once

#include <string>
#include <string_view>

#include "mesh/triangle_mesh.hpp"

namespace scree {

TriangleMesh parse_stl(std::string_view bytes, const std::string& file);
TriangleMesh parse_obj(std::string_view bytes, const std::string& file);
TriangleMesh parse_ply(std::string_view bytes, const std::string& file);

}  // namespace scree
