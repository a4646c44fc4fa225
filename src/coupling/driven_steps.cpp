// Explicit steps of particles beside walls with prescribed motion and conveyors, without bodies. The motion
// of such walls does not depend on the particles, so that many steps can be computed at once.
#include <algorithm>
#include <span>

#include "base/index.hpp"
#include "coupling/coupled_step.hpp"

namespace scree {
namespace {

// The most substeps whose motion is computed and broadcast at once.
constexpr std::size_t kMotionsAhead = 1024;

}  // namespace

// Start of the first substep and ends of all substeps of steps of length h that begin at `times` [s].
std::vector<Real> CoupledStep::instants_of(const std::vector<Real>& times, Real h, Real end) const {
  const int substeps = model_.integrator.substeps;
  std::vector<Real> instants{times.front()};
  for (std::size_t k = 0; k < times.size(); ++k) {
    for (int s = 1; s < substeps; ++s) instants.push_back(times[k] + h * s / substeps);
    instants.push_back(k + 1 < times.size() ? times[k + 1] : end);
  }
  return instants;
}

// Returns the number of steps taken.
std::size_t CoupledStep::driven_steps(ExplicitRun& run, MultibodyState& bodies,
                                      const std::vector<Real>& instants) {
  const std::size_t all = instants.size() - 1;
  std::size_t closed = 0;
  std::vector<BodyWrench> wrenches;
  for (bool open = true; open;) {
    const std::size_t most = std::min(kMotionsAhead, all - closed);
    const std::span<const Real> ahead(instants.data() + closed, most + 1);
    std::vector<BodyMotion> motion;
    {
      const auto scope = timers_.time(Stage::broadcast_motion);
      motion = body_coupling_.motion_of_walls(ahead.subspan(1));
    }
    const StepsTaken taken = run.take_driven_steps(motion, closed + most < all, wrenches, timers_);
    {
      const auto scope = timers_.time(Stage::reduce_wrench);
      body_coupling_.account_driven_walls(bodies, ahead.first(as_size(taken.closed) + 1), motion, wrenches);
    }
    closed += as_size(taken.closed), open = taken.open;
  }
  return closed / as_size(model_.integrator.substeps);
}

}  // namespace scree
