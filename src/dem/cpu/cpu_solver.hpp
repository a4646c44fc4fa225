// The loop of the linear solves of implicit steps on the CPU.
#pragma once

#include <cmath>
#include <span>

#include "base/for_each.hpp"
#include "dem/implicit/block_solver.hpp"
#include "partition/halo.hpp"
#include "partition/ranks.hpp"

namespace scree {

// of: the system, by its first(weights), direction(product) and product(product, weights): see
// `ThreeFreedoms`. tolerance: on the largest |residual| [N]. Returns the number of products. Collective.
template <class System>
int solve_on_host(const Halo& halo, const Ranks& ranks, Index owned, System& of, Real largest_stiffness_ratio,
                  Real tolerance) {
  ChebyshevWeights weights = solver_weights(largest_stiffness_ratio);
  for_each(Serial{}, owned, of.first(weights));
  for (int product = 0; product < kMostProducts; ++product) {
    weights.advance();
    halo.update(std::span(of.direction(product)), owned);
    const auto item = of.product(product, weights);
    const auto subtract = [&](Index i) { return item.subtract_product(i); };
    const Real largest = ranks.max(max_over(Serial{}, owned, subtract));
    if (!(std::sqrt(largest) > tolerance)) return product + 1;
    for_each(Serial{}, owned, [&](Index i) { item.find_next(i); });
  }
  return kMostProducts;
}

}  // namespace scree
