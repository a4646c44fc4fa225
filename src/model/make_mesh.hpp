// The triangles that a table of [[meshes]] stands for.
#pragma once

#include "deck/deck.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

// In the frame of what carries the mesh. Lines are drawn along z to half_depth at least [m], closed ones
// with ends. Throws InputError with place, key and value, or with the text alone that is wrong with a file;
// IoError where it cannot be read.
TriangleMesh make_mesh(const DeckTable& table, Real half_depth);
// Whether it has two sides.
bool is_sheet(const DeckTable& table);

}  // namespace scree
