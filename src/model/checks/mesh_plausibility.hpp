// What meshes stand for and how finely, against the particles that touch them.
#pragma once

#include <string>
#include <vector>

#include "deck/deck.hpp"
#include "model/data/model.hpp"

namespace scree {

// How many triangles are within the list's reach of a sphere that touches a mesh somewhere, on average; in 2D
// segments of a line.
Real triangles_near(const Model& model, const SurfaceMesh& mesh, Real radius);
// How many triangles side by side are as wide as such a sphere, on average; in 2D segments.
Real triangles_wide(const Model& model, const SurfaceMesh& mesh, Real radius);

// Warnings about the meshes, one text for each finding: nobody uses or touches them, their shells cut through
// each other, particles are too large for their curves, their facets too coarse for the overlaps, or too fine
// for the particles, contacts too soft for their folds, their surfaces run across themselves.
std::vector<std::string> implausible_meshes(const DeckTable& deck, const Model& model);

}  // namespace scree
