// Reader of triangle files.
#pragma once

#include <string>
#include <string_view>

#include "mesh/triangle_mesh.hpp"

namespace scree {

// Reads STL, OBJ or PLY, by the extension, in the file's own unit of length, with triangles in the order of
// its faces. Decimal numbers become the nearest double, so that a plane at 0.1 is where a deck's is; binary
// STL has 7 digits. Vertices are not welded yet (weld.hpp), and the surface is not checked
// (mesh_checks.hpp). Throws IoError for a file that cannot be read, InputError for one that is not a mesh;
// both name the file.
TriangleMesh read_mesh(const std::string& path);
// Parses the bytes of a file as read_mesh() does; path: for messages, and for the format by its extension.
TriangleMesh parse_mesh(std::string_view bytes, const std::string& path);

}  // namespace scree
