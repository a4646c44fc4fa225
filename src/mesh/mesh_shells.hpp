// The pieces that a mesh consists of.
#pragma once

#include <vector>

#include "base/types.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

// Triangles that hang together over shared edges are a shell: of each triangle the number of its shell, from
// 0 in the order of their first triangles.
std::vector<Index> shells_of(const TriangleMesh& mesh);

// Of each shell [m^3]; below 0 where its windings look inwards. mesh: closed.
std::vector<Real> shell_volumes(const TriangleMesh& mesh, const std::vector<Index>& shell_of_triangle);

// How the shells of a closed mesh lie in each other, whatever their windings.
struct ShellNesting {
  std::vector<Real> volume;                // as shell_volumes() has them
  std::vector<std::vector<Index>> around;  // of each shell, those that enclose it; of more than 10,000 none
};
// Judged by points just inside each shell, so that shells may touch; of those that cut through each other by
// most of these points.
ShellNesting shell_nesting(const TriangleMesh& mesh, const std::vector<Index>& shell_of_triangle);

struct MisplacedShell {
  Index shell;
  Real volume;  // [m^3]
};

// Of a closed mesh, the shells that do not fit to where they are: those inside others that do not bound a
// cavity (volume above 0), and those that bound a cavity of nothing (below 0). In order. Judged by points
// just inside the solid that a shell bounds, up to 16 of each shell, so that shells may touch. crossing:
// shells, increasing, that are not judged as they cut through others. None is found among more than 10,000.
std::vector<MisplacedShell> misplaced_shells(const TriangleMesh& mesh,
                                             const std::vector<Index>& shell_of_triangle,
                                             const std::vector<Index>& crossing = {});

}  // namespace scree
