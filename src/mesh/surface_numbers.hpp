// Capacity of contact keys: how many surfaces, and features of a mesh, they distinguish.
#pragma once

namespace scree {

// Bits of the number of a surface in decks with meshes, and of that of a feature.
inline constexpr int kSurfaceBits = 20, kFeatureBits = 28;

}  // namespace scree
