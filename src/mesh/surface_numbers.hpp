// How many surfaces, and features of a mesh, the names of contacts can tell apart.
#pragma once

namespace scree {

// Bits of the number of a surface where there are meshes, and of that of a feature.
inline constexpr int kSurfaceBits = 20, kFeatureBits = 28;

}  // namespace scree
