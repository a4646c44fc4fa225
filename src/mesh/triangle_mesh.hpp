// A surface as triangles, as read from a file or made from a few numbers, without derived data.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"

namespace scree {

// Corners counterclockwise seen from outside.
struct TriangleMesh {
  std::vector<Vec3> vertices;                   // [m]
  std::vector<std::array<Index, 3>> triangles;  // of vertices
};

}  // namespace scree
