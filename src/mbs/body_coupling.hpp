// The blocks of Newton's matrix that couple two bodies in contact.
#pragma once

#include <vector>

#include "mbs/body_poses.hpp"
#include "mbs/mechanical_system.hpp"
#include "model/data/bodies.hpp"
#include "model/data/body_exchange.hpp"
#include "model/data/body_layout.hpp"

namespace scree {

// Adds the derivatives of each body's wrench by the motion of the other body, in their coordinates. The
// poses have the tangents of the open step.
void add_coupling(const PairStiffness& pair, const std::vector<Body>& bodies, const BodyLayout& layout,
                  const BodyPoses& poses, SystemDerivatives& derivatives);

}  // namespace scree
