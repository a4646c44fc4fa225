// Triangles from files of other programs.
#pragma once

#include <string>

#include "mesh/triangle_mesh.hpp"

namespace scree {

// STL (ASCII or binary), OBJ or PLY, by the name's end; in the file's own unit of length and order, polygons
// cut into triangles. Vertices are not joined yet (weld.hpp), nothing else is judged (mesh_checks.hpp).
// Throws IoError for a file that cannot be read, InputError for one that is no mesh; both name the file.
TriangleMesh read_mesh(const std::string& path);

}  // namespace scree
