#include "dem/implicit/block_solver.hpp"

#include <algorithm>
#include <cmath>

#include "base/for_each.hpp"

namespace scree {
namespace {

Real largest_norm(std::span<const Vec3> values) {
  Real squared = 0;
  for (const Vec3& v : values) squared = std::max(squared, dot(v, v));
  return std::sqrt(squared);
}

}  // namespace

int BlockSolver::solve(const System& system, std::vector<Vec4>& d, std::vector<Vec3>& solution) const {
  const Index n = static_cast<Index>(system.residual.size());
  SubtractMatrixItem<PackedRows> subtract = system.matrix;
  subtract.d = d.data(), subtract.residual = system.residual.data();

  for (Index i = 0; i < n; ++i) d[i] = {}, solution[i] = {};
  return iterate_chebyshev(
      system.largest_stiffness_ratio, system.tolerance, [&](const ChebyshevWeights& weights) {
        const DirectionItem direction{system.inverse_block.data(), system.residual.data(), weights.from_last,
                                      weights.from_residual};
        for (Index i = 0; i < n; ++i) {
          const Vec3 step = direction.next(i, xyz(d[i]));
          d[i] = vec4(step, 0);
          solution[i] += step;
        }
        system.halo.update(std::span<Vec4>(d), n);
        for_each(Serial{}, n, subtract);
        return system.ranks.max(largest_norm(system.residual));
      });
}

}  // namespace scree
