// Between which bodies, and which of their points, the joints and force elements of one deck table stand.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/mat3.hpp"
#include "deck/deck.hpp"
#include "model/data/model.hpp"
#include "model/data/names.hpp"

namespace scree {

// The two ends of a connection, each in the frame of its body.
using Ends = std::array<Marker, 2>;

// One element: its name and its two bodies, and its ends where the deck gives markers.
struct Connection {
  std::string name;
  int body[2] = {kGround, kGround};
  std::optional<Ends> markers{};
};

// From the keys bodies, markers, chain or each. Throws InputError.
std::vector<Connection> find_connections(const DeckTable& table, const ModelNames& names);

// Of a joint or force element between these: the kind of its bodies, which is the same for both; the ground
// is of either kind.
BodyKind between(const Model& model, const int (&body)[2]);

// For messages: the text behind the label of the deck's table that it is about, where there is one.
std::string with_label(const std::string& deck_label, const std::string& text);

// Position at t = 0 of a body's centre; the origin for the ground [m].
Vec3 start_position(const Model& model, int body);
Real start_angle(const Model& model, int body);  // of a planar body [rad]
// A direction, or a point [m], between the global frame and a body's, at t = 0.
Vec3 to_body_point(const Model& model, int body, Vec3 global);
Vec3 to_global_point(const Model& model, int body, Vec3 local);
Vec3 to_body_direction(const Model& model, int body, Vec3 global);
Vec3 to_global_direction(const Model& model, int body, Vec3 local);

// A point of the deck, in a body's frame from its origin, from the body's centre of mass [m].
Vec3 from_center(const Model& model, int body, Vec3 local);
// A point and a frame (rows x, y, z) at t = 0 in the global frame, as a marker of the body.
Marker marker_at(const Model& model, int body, Vec3 point, const Mat3& frame);
Mat3 global_frame(const Model& model, int body, const Quaternion& orientation);  // at t = 0, rows x, y, z

// The markers of a connection; without, the deck's point or local_points (left out: the body's centre of
// mass, or midway between the two), and on either body these axes: rows x, y, z at t = 0 in the global frame.
Ends find_ends(const DeckTable& table, const Model& model, const Connection& connection,
               const Mat3 (&frame)[2]);
// The same of the points alone, without markers.
void find_common_points(const DeckTable& table, const Model& model, const Connection& connection,
                        Vec3 local[2]);
// Refuses these keys of the table beside markers.
void check_without_markers(const DeckTable& table, std::initializer_list<const char*> keys);

// Fills the two local points from markers, local_points, points or the bodies' centres. Throws InputError
// where the ground needs a point that is not given.
void find_end_points(const DeckTable& table, const Model& model, const Connection& connection, Vec3 local[2]);
// Refuses a planar and a spatial body together.
void check_same_kind(const DeckTable& table, const Model& model, const Connection& connection);
// Refuses `key` together with chain or each: one global point cannot hold for several elements.
void check_single(const DeckTable& table, const std::string& key);

// Whether the two sides of a joint meet at t = 0.
struct JointGap {
  Vec3 end[2];   // the joint's point on either body [m]
  Real size;     // how far they are from meeting [m]
  Real allowed;  // round-off of coordinates is far below [m]

  bool meets() const { return size <= allowed; }
};
JointGap joint_gap(const Model& model, const Joint& joint);
// Whether it keeps its two points together.
bool points_coincide(const Joint& joint);

// Distance between two points of these bodies at t = 0; of planar ones within their plane [m].
Real start_distance(const Model& model, const int (&body)[2], const Vec3 (&point)[2]);

// Per joint, whether it has no row of its own: a driver's row replaces it, or it is a cylinder.
std::vector<bool> rowless_joints(const Model& model);
bool has_spatial_bodies(const Model& model);
bool is_spatial(const Model& model, int body);  // the ground is not
// Of joints, drivers and couplers: the number of the multibody side's constraint equations.
int constraint_count(const Model& model);
// How many numbers motors and friction on joints remember.
int memory_count(const Model& model);
// Pairs of bodies, smaller index first, that a joint or a force element connects; sorted, each once.
std::vector<std::pair<int, int>> connected_bodies(const Model& model);
// One entry per body: whether joints, springs or bushings hold it, through other bodies or not, to the
// ground.
std::vector<bool> held_bodies(const Model& model);
// Whether each body moves as the ground, fixed joints and drivers of revolute and translational joints
// prescribe, whatever forces act on it: contacts meet it as if its mass were infinite.
std::vector<bool> prescribed_bodies(const Model& model);

}  // namespace scree
