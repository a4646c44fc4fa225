// The coordinate of a joint: what a driver prescribes, a motor pushes and a coupler ties to another.
#pragma once

#include <memory>
#include <string>

#include "mbs/constraints.hpp"
#include "model/bodies.hpp"
#include "model/body_layout.hpp"
#include "model/model.hpp"

namespace scree {

// C = c, one row: the row of a driver (mbs/joints.hpp) with the motion f = 0. Throws InputError, which begins
// with `title`, for a joint without a coordinate.
std::unique_ptr<Constraint> joint_coordinate(const std::string& title, const Joint& joint, const Model& model,
                                             const BodyLayout& layout);

}  // namespace scree
