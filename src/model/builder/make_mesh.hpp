// Triangles of a table of [[meshes]].
#pragma once

#include <optional>

#include "deck/deck.hpp"
#include "mesh/triangle_mesh.hpp"
#include "physics/spatial_rotation.hpp"

namespace scree {

// deviation: facet_deviation() of a parametric shape [m]; not known for files and lines.
struct MadeMesh {
  TriangleMesh triangles;
  std::optional<Real> deviation;
};

// In the frame of the mesh's owner. Lines are extruded along z to half_depth at least [m], without end caps.
// Throws InputError with place, key and value, or with the text alone for an error in a file; IoError where
// the file cannot be read.
MadeMesh make_mesh(const DeckTable& table, Real half_depth);
// The solid of a line: its points as given, extruded along z, with end caps where it is closed. Throws
// InputError, also where a closed line intersects itself.
TriangleMesh make_line_solid(const DeckTable& table);
// Throws InputError where the orientation of `table`, a line or a solid of one, leaves the x-y plane.
void check_rotated_about_z(const DeckTable& table, const Mat3& axes);
// Whether the mesh is an open (two-sided) surface.
bool is_open_surface(const DeckTable& table);

}  // namespace scree
