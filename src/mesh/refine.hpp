// Meshes of the same surface with smaller triangles.
#pragma once

#include "base/types.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

// A welded mesh whose edges are all at most edge_length [m]: the longest that is longer, of all, is split in
// its middle with all its triangles, until there is none (ties: the edge of lower vertices first), so that no
// vertex hangs on an edge and angles stay bounded (Rivara, Int. J. Numer. Meth. Eng. 20, 1984). Parts of a
// triangle stand together, in its place. The surface stays: curved shapes keep their facets; made of more
// segments they come nearer. Throws InputError where more than most_triangles would be made.
TriangleMesh refined(const TriangleMesh& mesh, Real edge_length, Index most_triangles = 100'000'000);

}  // namespace scree
