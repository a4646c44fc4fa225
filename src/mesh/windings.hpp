// The ways in which the triangles of a mesh run through their corners.
#pragma once

#include <vector>

#include "base/types.hpp"
#include "mesh/weld.hpp"

namespace scree {

// Turns triangles of a sheet so that two at an edge run alike, as few as that takes of each piece; a sheet
// with one side alone, as a Moebius strip is, keeps edges where they do not. Returns the numbers of those
// turned, increasing.
std::vector<Index> turn_alike(NumberedMesh& sheet);

// The same of a mesh with two triangles at each edge, and then whole shells, so that the mesh has its solid
// inside: a shell that lies in no solid is turned outward; in one, its windings say whether it bounds a
// cavity. Those within a shell that was turned are turned with it where that makes cavities. Without a change
// where a shell has one side alone, where a shell lies in a solid in any case (mesh_checks.hpp names it), and
// where an edge has not two triangles.
std::vector<Index> turn_outward(NumberedMesh& closed);

}  // namespace scree
