// Drivers that ask for a motion which the mechanism cannot follow.
#pragma once

#include <string>
#include <vector>

#include "mbs/rank_check.hpp"
#include "mbs/rigid_body_system.hpp"

namespace scree {

// A text for a run that fails at or near this instant: it names the driver whose motion leads to a position
// in which its row of Phi is a combination of others, a dead point, where velocities and reactions grow
// without bound; with the constraints that become dependent. repeated: those that were at the start, whose
// drivers contradict others where they do. Empty where no driver's row takes part. The system is left
// evaluated at this instant.
std::string dead_point(RigidBodySystem& system, const std::vector<Real>& position,
                       const std::vector<Real>& velocity, Real t, const std::vector<Dependency>& repeated);

}  // namespace scree
