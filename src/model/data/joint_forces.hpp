// Motors, springs, limits and friction on the coordinates of joints, and couplers between these coordinates.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "deck/choices.hpp"
#include "model/data/bodies.hpp"

namespace scree {

// A coordinate c of a joint is what a driver could prescribe (model/derived/joint_coordinates.hpp), an angle
// [rad] or a displacement [m], or the length of a cylinder [m]; where none is named, the only one, or the
// first. An effort [N m, N] above 0 pushes c up.

// A function of c or of its rate by its points; past them it goes on with its rate there. Empty: 0.
struct Curve {
  std::vector<Real> at, values;
  Interpolation interpolation = Interpolation::linear;
};

struct Motor {
  std::string name;
  int joint = 0;
  MotorKind kind = MotorKind::effort;
  Real limit = kInfinity;  // of the effort, either way
  TimeFunction effort;     // effort: as it is
  // line: command (stall_effort) (1 - rate / (command free_rate)) = stall_effort (command - rate / free_rate)
  Real stall_effort = 0, free_rate = 0;  // [N m, N], [rad/s, m/s]
  TimeFunction command;                  // of the full voltage or throttle [-]
  // speed: gain e + integral_gain (integral of e), e = rate - c'
  TimeFunction rate;                 // wanted [rad/s, m/s]
  Real gain = 0, integral_gain = 0;  // [N m s/rad, N s/m], [N m/rad, N/m]
  // position: position_gain e + rate_gain e', e = position - c
  TimeFunction position;                  // wanted [rad, m]
  Real position_gain = 0, rate_gain = 0;  // [N m/rad, N/m], [N m s/rad, N s/m]
  std::optional<JointCoordinate> coordinate{};
};

// Effort -(k (c - free) + d c' + F(c) + G(c')); free is left out: c at t = 0.
struct JointSpring {
  std::string name;
  int joint = 0;
  Real stiffness = 0, damping = 0;  // k, d
  std::optional<Real> free;
  Curve elastic, dissipative;  // F, G
  std::optional<JointCoordinate> coordinate{};
};

// Beyond lower or upper a contact's law pushes back: K d^n + C d', d being how far c is beyond.
struct JointLimit {
  std::string name;
  int joint = 0;
  Real lower = -kInfinity, upper = kInfinity;
  Real stiffness = 0, damping = 0, exponent = 1;  // K, C, n
  std::optional<JointCoordinate> coordinate{};
};

// Sticks on a spring until the effort reaches s (effort + lever F), then slides with it; F: the force that
// the joint transmits [N], s = 1 + (static_ratio - 1) exp(-(c'/stribeck_rate)^2).
struct JointFriction {
  std::string name;
  int joint = 0;
  Real effort = 0;                  // [N m or N]
  Real lever = 0;                   // of an angle friction coefficient times radius [m], else [-]
  Real stiffness = 0, damping = 0;  // while it sticks [N m/rad, N/m], [N m s/rad, N s/m]
  Real static_ratio = 1;            // at least 1
  Real stribeck_rate = kInfinity;   // [rad/s, m/s]
  std::optional<JointCoordinate> coordinate{};
};

// sum of coefficient[k] c[k] = its value at t = 0.
struct Coupler {
  std::string name;
  std::vector<int> joints;
  std::vector<Real> coefficients;
  std::vector<JointCoordinate> coordinates{};  // per joint; empty: of each the only one, or the first
  std::string deck_label{};                    // as of a joint
};

}  // namespace scree
