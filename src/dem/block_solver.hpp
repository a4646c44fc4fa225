// Linear solve of the particles' Newton matrix, matrix-free over the touching pairs and free of reductions
// other than maxima: Chebyshev iteration (Golub and Varga, Numer. Math. 3, 1961) with the 3x3 diagonal blocks
// D.
#pragma once

#include <span>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "dem/step_items.hpp"
#include "partition/halo.hpp"

namespace scree {

// The matrix is M' + sum over pairs of [b; -b][b; -b]^T with M' = mass / (1 + alpha): each pair term is at
// most twice its own diagonal, so D^-1 A has no eigenvalue above 2, and none below 1 / (1 + largest
// stiffening).
class BlockSolver {
 public:
  struct System {
    SubtractMatrixItem<PackedRows> matrix;  // d and residual are set by the solver
    std::span<const Sym3> inverse_block;
    std::span<Vec3> residual;  // in: right-hand side; out: what is left of it
    std::span<const Ghost> ghosts;
    Real largest_stiffening;
    Real tolerance;  // on the largest |residual| [N]
  };

  // Solves A x = residual into `solution` [owned]. d: search directions of all items; the caller has set the
  // entries of ghosts and shapes. Returns the number of matrix products.
  int solve(const System& system, std::vector<Vec4>& d, std::vector<Vec3>& solution) const;
};

}  // namespace scree
