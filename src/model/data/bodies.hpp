// The multibody side of the model: rigid bodies, joints, drivers and force elements.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "deck/choices.hpp"
#include "physics/orientation.hpp"

namespace scree {

inline constexpr int kGround = -1;  // body index of the ground; its frame is the global one

// Points fixed to bodies are relative to the centre of mass, along the axes of the body's frame. In the deck
// they are relative to the frame's origin.

inline constexpr int kNoMaterial = -1;  // material of what takes no part in contact

// Circle (2D) or sphere (3D) fixed to a body.
struct Shape {
  Vec3 offset;      // of the centre, in the body frame [m]
  Real radius = 0;  // [m]
  int material = 0;
};

// Triangles fixed to a body.
struct MeshShape {
  Vec3 offset;   // of the mesh's origin, in the body frame; the axes are those of the body [m]
  int mesh = 0;  // index into Model::meshes
  int material = 0;
};

// A planar body moves in its plane z = position.z and rotates about z.
struct Body {
  std::string name;
  bool in_row = false;  // belongs to a row, whose bodies share their keys
  Real mass = 0;        // [kg]
  // Moment about the z axis through the centre of mass; spatial: the smallest principal moment [kg m^2].
  Real inertia = 0;
  Vec3 position;              // of the centre of mass at t = 0 [m]
  Real angle = 0;             // [rad]
  Vec3 velocity;              // [m/s]
  Real angular_velocity = 0;  // [rad/s]
  std::vector<Shape> shapes;
  std::vector<MeshShape> meshes;
  BodyKind kind = BodyKind::planar;
  // For a spatial body, in place of inertia, angle and angular_velocity.
  Sym3 inertia_tensor;     // J about the centre of mass, in the body's frame [kg m^2]
  Quaternion orientation;  // of the body's frame at t = 0
  Vec3 spin;               // angular velocity in the body's frame [rad/s]
  // Centre of mass relative to the origin of the body's frame, to which the deck's position and velocity
  // refer [m].
  Vec3 center_of_mass{};
  bool of_solids = false;  // mass and inertia are those of solids
  // Shapes and meshes that take no part in contact: in pictures and results only.
  std::vector<Shape> drawn_shapes{};
  std::vector<MeshShape> drawn_meshes{};
};

// A point and axes fixed to a body, or to the ground (in the global frame).
struct Marker {
  Vec3 point;  // [m]
  // From components in the marker's frame to the body's frame; the marker's axis is z.
  Quaternion orientation;
};

// A joint between body[0] and body[1]; either may be the ground. Points and axis are in the body frames.
struct Joint {
  std::string name;
  JointKind kind = JointKind::revolute;
  int body[2] = {kGround, kGround};
  Vec3 point[2];          // [m]
  Vec3 axis{1, 0, 0};     // translational: unit vector in the frame of body[0]
  Real distance = 0;      // distance joint [m]
  Real angle_offset = 0;  // fixed, translational: angle of body[1] minus angle of body[0] at t = 0 [rad]
  Real lead = 0;          // screw: displacement in one revolution, right-handed above 0 [m]
  Real advance = 0;       // screw: displacement at angle 0 [m]
  // Spatial bodies, in place of axis and angle_offset: orientation of the joint's frame in each body's frame,
  // axis along z. Universal: the first body's arm is x, the second body's arm is y.
  Quaternion marker[2];
  // Label of its table for messages: "deck.toml:38:1: joints.hinge"; empty without a deck.
  std::string deck_label;
  // Distance joint that is a cylinder with a free length: it has no constraint row; motors and stops act on
  // its length.
  bool telescopes = false;
};

// A scalar function of time, with two continuous derivatives where a driver needs them.
struct TimeFunction {
  using Kind = TimeFunctionKind;
  Kind kind = Kind::constant;
  Real value = 0;           // constant; start value of ramp, sine and step
  Real rate = 0;            // ramp: slope [1/s]
  Real amplitude = 0;       // sine: value + amplitude sin(2 pi frequency t + phase)
  Real frequency = 0;       // [Hz]
  Real phase = 0;           // [rad]
  Real end_value = 0;       // step: value up to start, end_value from end on
  Real start = 0, end = 0;  // step; ramp with end > start: constant up to start, full slope from end on [s]
  std::vector<Real> times, values;  // table
  Interpolation interpolation = Interpolation::natural;
  std::array<Real, 2> end_rates{};  // clamped [1/s]
};

// Prescribes a coordinate of a joint (model/derived/joint_coordinates.hpp) [rad, m].
struct Driver {
  std::string name;
  int joint = 0;
  TimeFunction motion;
  std::optional<JointCoordinate> coordinate{};  // empty: the only coordinate, or the first
  std::string deck_label{};                     // as Joint::deck_label
};

// Spring-damper-actuator between two points: tension = k (l - free_length) + c dl/dt + actuator(t).
struct SpringDamper {
  std::string name;
  int body[2] = {kGround, kGround};
  Vec3 point[2];          // in the body frames [m]
  Real stiffness = 0;     // k [N/m]
  Real damping = 0;       // c [N s/m]
  Real free_length = 0;   // [m]
  TimeFunction actuator;  // [N], positive pulls the points together
};

// Torsional spring-damper: torque on body[1] = -(k (theta - free_angle) + c dtheta/dt), theta = angle[1] -
// angle[0]; the opposite torque on body[0].
struct TorsionalSpringDamper {
  std::string name;
  int body[2] = {kGround, kGround};
  Real stiffness = 0;   // [N m/rad]
  Real damping = 0;     // [N m s/rad]
  Real free_angle = 0;  // [rad]
};

// Rows of a symmetric matrix.
using Matrix6 = std::array<std::array<Real, 6>, 6>;

// Bushing between two spatial bodies, or one and the ground: K x + C x' + preload acts on the second body
// towards the first body's frame. x: displacement of the second point along the first frame's axes [m], then
// the rotation vector from the first frame to the second [rad].
struct Bushing {
  std::string name;
  int body[2] = {kGround, kGround};
  Vec3 point[2];                  // in the body frames [m]
  Quaternion marker[2];           // orientation of the bushing's frame in each body's frame
  Matrix6 stiffness{};            // K [N/m, N/rad; N m/m, N m/rad]
  Matrix6 damping{};              // C, in the units of K times s
  std::array<Real, 6> preload{};  // [N, N m]

  bool resists_rotation() const;
};
// The rotation vector jumps at pi; the limit leaves the distance that two bodies can rotate in one step.
inline constexpr Real kMaxBushingRotation = 2.6;  // [rad]

// Force at a point of a body, and a torque. The direction is global, or turns with the body: of a spatial
// body that of the torque too.
struct AppliedForce {
  std::string name;
  int body = 0;
  Vec3 point;                   // in the body frame [m]
  TimeFunction fx, fy, torque;  // [N], [N], [N m]
  bool follows_body = false;
  TimeFunction fz{}, torque_x{}, torque_y{};  // of spatial bodies; torque is that about z
  Quaternion axes{};  // of the components, in the frame of the spatial body that they follow
};

}  // namespace scree
