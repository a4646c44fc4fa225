// Drivers that ask for a motion which the mechanism cannot follow.
#pragma once

#include <string>
#include <vector>

#include "mbs/mechanical_system.hpp"
#include "mbs/rank_check.hpp"
#include "mbs/rigid_body_system.hpp"

namespace scree {

// A text for a run whose step of this length [s] fails at this instant: it names the driver whose motion
// leads to a position in which its row of Phi is a combination of others, a dead point, where velocities and
// reactions grow without bound; with the constraints that become dependent. repeated: those that were at the
// start, whose drivers contradict others where they do. Empty where no driver's row is next to a combination,
// or gets there within a few such steps.
std::string dead_point(RigidBodySystem& system, const SystemInstant& now, Real step,
                       const std::vector<Dependency>& repeated);

}  // namespace scree
