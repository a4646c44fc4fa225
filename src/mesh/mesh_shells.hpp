// Shells, the connected pieces of a mesh.
#pragma once

#include <vector>

#include "base/types.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

// Number of the shell of each triangle, from 0 in the order of the shells' first triangles. Triangles that
// are connected over shared edges are one shell.
std::vector<Index> shells_of(const TriangleMesh& mesh);

// Volume of each shell [m^3]; negative where its windings are inverted. mesh: closed.
std::vector<Real> shell_volumes(const TriangleMesh& mesh, const std::vector<Index>& shell_of_triangle);

// Nesting of the shells of a closed mesh, whatever their windings.
struct ShellNesting {
  std::vector<Real> volume;  // as from shell_volumes()
  // Per shell, those that enclose it; not determined for more than 10,000 shells.
  std::vector<std::vector<Index>> around;
};
// Tested at points just inside each shell, so that shells may touch; for intersecting shells the majority of
// these points counts.
ShellNesting shell_nesting(const TriangleMesh& mesh, const std::vector<Index>& shell_of_triangle);

struct MisplacedShell {
  Index shell;
  Real volume;  // [m^3]
};

// The shells of a closed mesh whose orientation does not suit their position: shells inside others that do
// not bound a cavity (volume positive), and shells that bound a cavity outside any solid (negative). In
// increasing order. Tested at up to 16 points just inside the solid that a shell bounds, so that shells may
// touch. crossing: intersecting shells, increasing, which are not tested. More than 10,000 shells are not
// tested.
std::vector<MisplacedShell> misplaced_shells(const TriangleMesh& mesh,
                                             const std::vector<Index>& shell_of_triangle,
                                             const std::vector<Index>& crossing = {});

}  // namespace scree
