// Every joint, once: which rows it is made of, and which coordinate it leaves that a driver can prescribe.
#pragma once

#include "mbs/joint_parts.hpp"
#include "model/data/bodies.hpp"
#include "model/derived/scalar_function.hpp"

namespace scree {

// rowless: as rowless_joints() says. Throws InputError naming a joint that is refused.
void add_joint(const Joint& joint, bool rowless, JointParts& parts);
// One row: the coordinate is the motion.
void add_driver(JointCoordinate coordinate, ScalarFunction motion, JointParts& parts);

}  // namespace scree
