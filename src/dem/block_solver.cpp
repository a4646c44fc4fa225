#include "dem/block_solver.hpp"

#include <algorithm>
#include <cmath>

#include "base/for_each.hpp"

namespace scree {
namespace {

constexpr int kMostProducts = 2000;

Real largest_norm(std::span<const Vec3> values) {
  Real squared = 0;
  for (const Vec3& v : values) squared = std::max(squared, dot(v, v));
  return std::sqrt(squared);
}

}  // namespace

int BlockSolver::solve(const System& system, std::vector<Vec4>& d, std::vector<Vec3>& solution) const {
  const Index n = static_cast<Index>(system.residual.size());
  const Real low = 1 / (1 + system.largest_stiffening), high = 2;
  const Real center = (high + low) / 2, half_width = (high - low) / 2, sigma = center / half_width;
  SubtractMatrixItem<PackedRows> subtract = system.matrix;
  subtract.d = d.data(), subtract.residual = system.residual.data();

  Real rho = 1 / sigma, from_last = 0, from_residual = 1 / center;
  for (Index i = 0; i < n; ++i) d[i] = {}, solution[i] = {};
  int products = 0;
  while (products < kMostProducts) {
    for (Index i = 0; i < n; ++i) {
      const Vec3 step =
          from_last * xyz(d[i]) + from_residual * (system.inverse_block[i] * system.residual[i]);
      d[i] = vec4(step, 0);
      solution[i] += step;
    }
    update_halo(system.ghosts, d, n);
    for_each(Serial{}, n, subtract);
    ++products;
    if (largest_norm(system.residual) <= system.tolerance) break;
    const Real next = 1 / (2 * sigma - rho);
    from_last = next * rho, from_residual = 2 * next / half_width;
    rho = next;
  }
  return products;
}

}  // namespace scree
