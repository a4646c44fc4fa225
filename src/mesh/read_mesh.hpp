// Triangles from files of other programs.
#pragma once

#include <string>
#include <string_view>

#include "mesh/triangle_mesh.hpp"

namespace scree {

// STL, OBJ or PLY, by the name's end; in the file's own unit of length, triangles in the order of its faces.
// Decimal numbers become the nearest double, so that a plane at 0.1 is where a deck's is; binary STL has 7
// digits. Vertices are not joined yet (weld.hpp), and the surface is not judged (mesh_checks.hpp). Throws
// IoError for a file that cannot be read, InputError for one that is no mesh; both name the file.
TriangleMesh read_mesh(const std::string& path);
// The same from a file's bytes; path: of the messages, and its end says the format.
TriangleMesh parse_mesh(std::string_view bytes, const std::string& path);

}  // namespace scree
