// Bodies and points that the joints and force elements of a table of the deck connect.
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

// One element: its name, its two bodies, and its ends where the deck gives markers.
struct Connection {
  std::string name;
  int body[2] = {kGround, kGround};
  std::optional<Ends> markers{};
};

// Reads the keys bodies, markers, chain or each. Throws InputError.
std::vector<Connection> find_connections(const DeckTable& table, const ModelNames& names);

// The kind of the bodies that a joint or force element connects, equal for both; the ground is of either
// kind.
BodyKind between(const Model& model, const int (&body)[2]);

// The text with the label of the deck's table in front, where there is one, for messages.
std::string with_label(const std::string& deck_label, const std::string& text);

// Position at t = 0 of a body's centre; the origin for the ground [m].
Vec3 start_position(const Model& model, int body);
Real start_angle(const Model& model, int body);  // of a planar body [rad]
// Transforms a direction, or a point [m], between the global frame and the body's frame at t = 0.
Vec3 to_body_point(const Model& model, int body, Vec3 global);
Vec3 to_global_point(const Model& model, int body, Vec3 local);
Vec3 to_body_direction(const Model& model, int body, Vec3 global);
Vec3 to_global_direction(const Model& model, int body, Vec3 local);

// Transforms a point in a body's frame from its origin to its centre of mass [m].
Vec3 from_center(const Model& model, int body, Vec3 local);
// The marker of a body with this point and frame (rows x, y, z), both at t = 0 in the global frame.
Marker marker_at(const Model& model, int body, Vec3 point, const Mat3& frame);
// Frame of a body's marker at t = 0, rows x, y, z.
Mat3 global_frame(const Model& model, int body, const Quaternion& orientation);

// The markers of a connection. Without markers: the deck's point or local_points (left out: the body's centre
// of mass, or midway between the two), and on either body these axes (rows x, y, z at t = 0 in the global
// frame).
Ends find_ends(const DeckTable& table, const Model& model, const Connection& connection,
               const Mat3 (&frame)[2]);
// find_ends() for elements that have points only, without markers.
void find_common_points(const DeckTable& table, const Model& model, const Connection& connection,
                        Vec3 local[2]);
// Throws InputError where these keys are given beside markers.
void check_without_markers(const DeckTable& table, std::initializer_list<const char*> keys);

// Sets the two local points from markers, local_points, points or the bodies' centres. Throws InputError
// where a point on the ground is not given.
void find_end_points(const DeckTable& table, const Model& model, const Connection& connection, Vec3 local[2]);
// Throws InputError where a planar and a spatial body are connected.
void check_same_kind(const DeckTable& table, const Model& model, const Connection& connection);
// Throws InputError where `key` is given with chain or each: one global point cannot hold for several
// elements.
void check_single(const DeckTable& table, const std::string& key);

// Mismatch of the two sides of a joint at t = 0.
struct JointGap {
  Vec3 end[2];   // the joint's point on either body [m]
  Real size;     // distance between the two sides [m]
  Real allowed;  // far above the round-off of coordinates [m]

  bool meets() const { return size <= allowed; }
};
JointGap joint_gap(const Model& model, const Joint& joint);
// Whether the joint keeps its two points coincident.
bool points_coincide(const Joint& joint);

// Distance between two points of these bodies at t = 0, for planar bodies within their plane [m].
Real start_distance(const Model& model, const int (&body)[2], const Vec3 (&point)[2]);

// Whether each joint has no constraint row of its own: it is a cylinder, or a driver's row replaces it.
std::vector<bool> rowless_joints(const Model& model);
bool has_spatial_bodies(const Model& model);
bool is_spatial(const Model& model, int body);  // false for the ground
// Number of constraint equations of joints, drivers and couplers on the multibody side.
int constraint_count(const Model& model);
// Number of history values of motors and friction on joints.
int memory_count(const Model& model);
// Pairs of bodies that a joint or force element connects, smaller index first; sorted, each once.
std::vector<std::pair<int, int>> connected_bodies(const Model& model);
// Whether each body is connected to the ground by joints, springs or bushings, directly or through other
// bodies.
std::vector<bool> held_bodies(const Model& model);
// Whether the motion of each body is prescribed by the ground, fixed joints, and drivers of revolute and
// translational joints: in contacts its mass counts as infinite.
std::vector<bool> prescribed_bodies(const Model& model);

}  // namespace scree
