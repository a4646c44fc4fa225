// Contact sums of several explicit steps, which a backend hands over together.
#pragma once

#include <cstdint>
#include <vector>

#include "dem/surfaces/surface_sums.hpp"
#include "dem/surfaces/surfaces.hpp"
#include "model/data/body_exchange.hpp"
#include "partition/ranks.hpp"

namespace scree {

// Sums over the contacts of one surface at the end of one of the steps.
struct StepLoads {
  std::int64_t step;
  InstantSums sums;

  // Ordered by step, then by surface.
  std::int64_t key() const { return (step << 32) + sums.surface; }
  void add(const StepLoads& part) { sums.add(part.sums); }
};

// Contact wrenches on the parents at the ends of the steps 0 ... steps - 1, [step][parent]; each is as
// HostSurfaces::reduce() gives it for the sums of that step. On rank 0, zero elsewhere. Collective.
std::vector<BodyWrench> wrenches_of_steps(std::vector<StepLoads> loads, std::int64_t steps,
                                          const SurfaceSet& surfaces, const Ranks& ranks);

}  // namespace scree
