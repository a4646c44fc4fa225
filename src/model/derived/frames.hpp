// Orientations in the deck.
#pragma once

#include <string>

#include "base/mat3.hpp"
#include "deck/deck.hpp"
#include "physics/orientation.hpp"

namespace scree {

// Reads the orientation_keys() with this prefix; without them: no rotation. Throws InputError.
Quaternion read_orientation(const DeckTable& table, const std::string& prefix = "");
// Reads a direction, normalized. Throws InputError where the vector is 0.
Vec3 read_direction(const DeckTable& table, const std::string& key);

// The vector `local` of the frame of the body of this table, in the global frame at t = 0.
Vec3 rotated_at_start(const DeckTable& body, Vec3 local);

// Axes of a frame (rows x, y, z): z = axis, of length 1; x the global axis that is most nearly across.
Mat3 frame_about(Vec3 axis);
// The frame after the shortest rotation that takes `from` to `to`, unit vectors that are not opposite.
Mat3 rotated_frame(const Mat3& frame, Vec3 from, Vec3 to);
// The angle between two directions of any length but 0, at most pi [rad].
Real angle_between(Vec3 a, Vec3 b);

}  // namespace scree
