// The part of Newton's matrix between two bodies that touch each other.
#pragma once

#include <vector>

#include "mbs/body_poses.hpp"
#include "mbs/mechanical_system.hpp"
#include "model/data/bodies.hpp"
#include "model/data/body_exchange.hpp"
#include "model/data/body_layout.hpp"

namespace scree {

// Adds to the coupling what each has of the other one's motion, in their coordinates. The poses have the
// tangents of the open step.
void add_coupling(const PairStiffness& pair, const std::vector<Body>& bodies, const BodyLayout& layout,
                  const BodyPoses& poses, SystemDerivatives& derivatives);

}  // namespace scree
