// The lines of `scree check` on meshes.
#pragma once

#include <string>

#include "model/data/model.hpp"

namespace scree {

// Per mesh: triangles, size, mass, curvature, and the number of triangles near a particle in contact.
std::string mesh_lines(const Model& model);

}  // namespace scree
