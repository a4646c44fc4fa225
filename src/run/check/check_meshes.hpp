// What the report of `scree check` says of meshes.
#pragma once

#include <string>

#include "model/data/model.hpp"

namespace scree {

// Of each mesh its triangles, size and mass, how curved it is, and how many of them a particle is near.
std::string mesh_lines(const Model& model);

}  // namespace scree
