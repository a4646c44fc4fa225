#include "dem/host/step_loads.hpp"

#include <utility>

#include "base/index.hpp"

namespace scree {

std::vector<BodyWrench> wrenches_of_steps(std::vector<StepLoads> loads, std::int64_t steps,
                                          const SurfaceSet& surfaces, const Ranks& ranks) {
  std::vector<BodyWrench> wrenches(as_size(steps) * surfaces.parents());
  if (steps == 0) return wrenches;
  for (const StepLoads& of : merged_by_key(ranks.gather(std::move(loads)))) {
    const auto parent = as_size(surfaces.at(of.sums.surface).parent);
    wrenches[as_size(of.step) * surfaces.parents() + parent] += of.sums.wrench();
  }
  return wrenches;
}

}  // namespace scree
