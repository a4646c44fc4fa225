// Which coordinates a joint has: what drivers prescribe, motors push and couplers tie to others.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "deck/deck.hpp"
#include "model/model.hpp"

namespace scree {

// The angle of a revolute joint, the displacement of a translational one, both of cylindrical joints and
// screws, the length of a distance joint; of others none. An angle is that of body[1] less that of body[0]
// about the joint's axis [rad]: in space that of the joint's frames, 0 where they coincide, and counted on
// over whole turns.
std::vector<JointCoordinate> coordinates_of(JointKind kind);
bool has_coordinate(JointKind kind, JointCoordinate coordinate);
inline bool is_angle(JointCoordinate coordinate) { return coordinate == JointCoordinate::angle; }

// The wanted one; where none is wanted, the only one, or the first. Throws InputError, which begins with
// `title`, where the joint has no such coordinate.
JointCoordinate coordinate_of(const std::string& title, const Joint& joint,
                              std::optional<JointCoordinate> wanted);

// What table.coordinate says of this joint, the only one where the key is left out; of a screw the angle.
// Throws InputError where the joint has no such coordinate, or two and the key is left out.
JointCoordinate read_coordinate(const DeckTable& table, const Joint& joint);

// Whether the whole turns of a joint's angle are counted: in space. A planar angle is never wrapped.
bool counts_turns(const Model& model, const Joint& joint);
int counted_angles(const Model& model);

}  // namespace scree
