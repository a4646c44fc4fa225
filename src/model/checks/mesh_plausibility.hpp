// Warnings about meshes and their resolution, relative to the particles that touch them.
#pragma once

#include <string>
#include <vector>

#include "deck/deck.hpp"
#include "model/data/model.hpp"

namespace scree {

// Average number of triangles within the list's range of a sphere that touches a mesh; in 2D of segments of a
// line.
Real triangles_near(const Model& model, const SurfaceMesh& mesh, Real radius);
// Average number of triangles across the width of such a sphere; in 2D of segments.
Real triangles_wide(const Model& model, const SurfaceMesh& mesh, Real radius);

// Warnings about the meshes, one text for each finding: unused meshes, meshes without contacts, intersecting
// shells, particles too large for the curvature, facets too coarse for the overlaps or too fine for the
// particles, contacts too soft for the folds, and surfaces that intersect themselves.
std::vector<std::string> implausible_meshes(const DeckTable& deck, const Model& model);

}  // namespace scree
