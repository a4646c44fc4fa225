// The coordinates of joints, on which drivers, motors and couplers act.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "deck/deck.hpp"
#include "model/data/model.hpp"

namespace scree {

// The angle of a revolute joint, the displacement of a translational joint, both for cylindrical joints and
// screws, the length of a distance joint, the two angles of a universal joint; other joints have none. An
// angle is that of body[1] minus that of body[0] about the joint's axis [rad]; in space it is the angle
// between the joint's frames, 0 where they coincide, counted beyond full revolutions. Universal joint:
// angle_1 is the rotation of the cross relative to body[0] about its arm x_1, from y_1 to y_2; angle_2 is the
// rotation of body[1] relative to the cross about its arm y_2, from x_1 to x_2. Frame 2 is frame 1 rotated
// about its x by angle_1, then about its y by angle_2.
std::vector<JointCoordinate> coordinates_of(JointKind kind);
bool has_coordinate(JointKind kind, JointCoordinate coordinate);
bool is_angle(JointCoordinate coordinate);
// "an angle and a displacement"
std::string listed(const std::vector<JointCoordinate>& coordinates);

// The requested coordinate; without a request the only one, or the first. Throws InputError, with `title` in
// front, where the joint has no such coordinate.
JointCoordinate coordinate_of(const std::string& title, const Joint& joint,
                              std::optional<JointCoordinate> wanted);

// Whether the deck must name a coordinate: for cylindrical and universal joints.
bool needs_choice(JointKind kind);
// The coordinate that table.coordinate names; left out: the only one, for a screw the angle. Throws
// InputError where the joint has no such coordinate, or has two and the key is left out.
JointCoordinate read_coordinate(const DeckTable& table, const Joint& joint);

// The angles of a joint whose full revolutions are counted, which are those in space. Planar angles are not
// wrapped.
std::vector<JointCoordinate> rotational_coordinates(const Model& model, const Joint& joint);
int counted_angles(const Model& model);  // for all joints

}  // namespace scree
