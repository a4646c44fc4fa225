// The coordinate of a joint, as drivers prescribe it, motors act on it and couplers relate it to others.
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
// for coordinate_of (model/derived/joint_coordinates.hpp). Throws InputError, whose text begins with `title`,
// for a joint without such a coordinate.
std::unique_ptr<Constraint> joint_coordinate(const std::string& title, const Model& model, int joint,
                                             std::optional<JointCoordinate> wanted, const BodyLayout& layout);

// c and c' = c_q v of a row from joint_coordinate(). gradient: receives c_q.
CoordinateInstant coordinate_at(const Constraint& coordinate, const BodyPoses& poses, const SystemInstant& at,
                                SparseTerm& gradient);
// c'' = c_q a + v.c_qq v at an instant with accelerations, with c_q from coordinate_at().
Real second_rate(const Constraint& coordinate, const BodyPoses& poses, const SystemInstant& at,
                 const SparseTerm& gradient);

}  // namespace scree
