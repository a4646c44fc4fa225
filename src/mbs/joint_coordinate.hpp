// The coordinate of a joint: what a driver prescribes, a motor pushes and a coupler ties to another.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mbs/constraints.hpp"
#include "mbs/joint_laws.hpp"
#include "mbs/mechanical_system.hpp"
#include "model/data/body_layout.hpp"
#include "model/data/model.hpp"

namespace scree {

// C = c, one row: the row of a driver (mbs/joints.hpp) with the motion f = 0. joint: its number; wanted: as
// of coordinate_of (model/derived/joint_coordinates.hpp). Throws InputError, which begins with `title`, for a
// joint without such a coordinate.
std::unique_ptr<Constraint> joint_coordinate(const std::string& title, const Model& model, int joint,
                                             std::optional<JointCoordinate> wanted, const BodyLayout& layout);

// c and c' = c_q v of such a row. gradient: gets c_q.
CoordinateInstant coordinate_at(const Constraint& coordinate, const BodyPoses& poses, const SystemInstant& at,
                                SparseTerm& gradient);
// c'' = c_q a + v.c_qq v at an instant with accelerations, and with c_q there.
Real second_rate(const Constraint& coordinate, const BodyPoses& poses, const SystemInstant& at,
                 const SparseTerm& gradient);

}  // namespace scree
