// Consistent windings of the triangles of a mesh.
#pragma once

#include <vector>

#include "base/types.hpp"
#include "mesh/weld.hpp"

namespace scree {

// Reorients as few triangles as possible of each piece of an open surface so that the two triangles at an
// edge have consistent windings; a one-sided surface, as a Moebius strip, keeps edges where they do not.
// Returns the numbers of the reoriented triangles, increasing.
std::vector<Index> orient_consistently(NumberedMesh& sheet);

// Reorients a mesh with two triangles at each edge as orient_consistently(), and then whole shells, so that
// the solid is inside. A shell outside all solids is turned outward; inside a solid its windings decide
// whether it bounds a cavity. Shells within a reoriented shell are inverted with it where that makes
// cavities. Nothing changes where a shell is one-sided, where a shell lies in a solid in any case
// (mesh_checks.hpp reports it), and where an edge does not have two triangles.
std::vector<Index> orient_outward(NumberedMesh& closed);

}  // namespace scree
