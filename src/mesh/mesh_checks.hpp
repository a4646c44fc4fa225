// What is wrong with triangles that are to be a surface.
#pragma once

#include <string>
#include <vector>

#include "base/types.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

// What keeps a welded mesh from being a surface that contacts are found on, one text per kind of trouble,
// which names the first five places; none: it is sound. Triangles are counted from 0 in their order, or have
// the `numbers` given. Sheets may end at free edges, have more than two triangles at an edge, and be wound
// anyhow.
std::vector<std::string> mesh_troubles(const TriangleMesh& mesh, bool sheet,
                                       const std::vector<Index>& numbers = {});

// A text on shells of a closed mesh without other trouble that cut through each other: their numbers, and the
// first position; "" where none do. Contacts are found on such a mesh, but the volume that two shells share
// is in both.
std::string crossing_text(const TriangleMesh& mesh, const std::vector<Index>& numbers = {});

// "triangle 12 (0, 0, 0) (1, 0, 0) (0, 1, 0)": its number and its corners.
std::string triangle_text(const TriangleMesh& mesh, Index triangle, Index number);

}  // namespace scree
