// Drivers whose prescribed motion the mechanism cannot follow.
#pragma once

#include <string>
#include <vector>

#include "mbs/mechanical_system.hpp"
#include "mbs/rank_check.hpp"
#include "mbs/rigid_body_system.hpp"

namespace scree {

// A text for a run whose step of this length [s] fails at this instant. It names the driver whose motion
// leads to a dead point, a position in which its row of Phi is a combination of other rows, so that
// velocities and reactions grow without bound, and the constraints that become dependent there. repeated:
// the dependencies at the start; their drivers contradict others where several take part. The text is empty
// where no driver's row is near a combination or becomes one within a few such steps.
std::string dead_point(RigidBodySystem& system, const SystemInstant& now, Real step,
                       const std::vector<Dependency>& repeated);

}  // namespace scree
