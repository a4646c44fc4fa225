// The one definition of every joint: its constraint rows, and the coordinate that a driver can prescribe.
#pragma once

#include "mbs/joint_parts.hpp"
#include "model/data/bodies.hpp"
#include "model/derived/scalar_function.hpp"

namespace scree {

// rowless: as in rowless_joints(). Throws InputError with the name of a joint that is refused.
void add_joint(const Joint& joint, bool rowless, JointParts& parts);
// Adds one row: the coordinate equals the motion.
void add_driver(JointCoordinate coordinate, ScalarFunction motion, JointParts& parts);

}  // namespace scree
