// The triangles that a table of [[meshes]] stands for.
#pragma once

#include <optional>

#include "deck/deck.hpp"
#include "mesh/triangle_mesh.hpp"
#include "physics/spatial_rotation.hpp"

namespace scree {

// deviation: facet_deviation() of a shape made from a few numbers [m]; of files and lines nothing is known.
struct MadeMesh {
  TriangleMesh triangles;
  std::optional<Real> deviation;
};

// In the frame of what carries the mesh. Lines are drawn along z to half_depth at least [m], without ends.
// Throws InputError with place, key and value, or with the text alone that is wrong with a file; IoError
// where it cannot be read.
MadeMesh make_mesh(const DeckTable& table, Real half_depth);
// What a solid of a line is made of: its points as they are given, drawn to some depth; a closed one has
// ends. Throws InputError, also where a closed line crosses itself.
TriangleMesh make_line_solid(const DeckTable& table);
// Throws InputError where the axes of `table`, a line or a solid of one, leave the x-y plane.
void check_turned_about_z(const DeckTable& table, const Mat3& axes);
// Whether it has two sides.
bool is_sheet(const DeckTable& table);

}  // namespace scree
