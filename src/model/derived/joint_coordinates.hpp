// Which coordinates a joint has: what drivers prescribe, motors push and couplers tie to others.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "deck/deck.hpp"
#include "model/data/model.hpp"

namespace scree {

// The angle of a revolute joint, the displacement of a translational one, both of cylindrical joints and
// screws, the length of a distance joint, the two angles of a universal joint; of others none. An angle is
// that of body[1] less that of body[0] about the joint's axis [rad]: in space that of the joint's frames, 0
// where they coincide, and counted on over whole turns. Of a universal joint angle_1 is that of the cross
// against body[0] about its arm x_1, from y_1 to y_2, and angle_2 that of body[1] against the cross about its
// arm y_2, from x_1 to x_2: frame 2 is frame 1 turned about its x by the one, then about its y by the other.
std::vector<JointCoordinate> coordinates_of(JointKind kind);
bool has_coordinate(JointKind kind, JointCoordinate coordinate);
bool is_angle(JointCoordinate coordinate);
// "an angle and a displacement"
std::string listed(const std::vector<JointCoordinate>& coordinates);

// The wanted one; where none is wanted, the only one, or the first. Throws InputError, which begins with
// `title`, where the joint has no such coordinate.
JointCoordinate coordinate_of(const std::string& title, const Joint& joint,
                              std::optional<JointCoordinate> wanted);

// Whether the deck must name one: of cylindrical and universal joints.
bool needs_choice(JointKind kind);
// What table.coordinate says of this joint, the only one where the key is left out; of a screw the angle.
// Throws InputError where the joint has no such coordinate, or two and the key is left out.
JointCoordinate read_coordinate(const DeckTable& table, const Joint& joint);

// The angles of a joint whose whole turns are counted: those in space. A planar angle is never wrapped.
std::vector<JointCoordinate> turning_coordinates(const Model& model, const Joint& joint);
int counted_angles(const Model& model);  // of all joints

}  // namespace scree
