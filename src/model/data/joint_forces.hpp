// Motors, springs, limits and friction on the coordinates of joints, and couplers between these coordinates.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "deck/choices.hpp"
#include "model/data/bodies.hpp"

namespace scree {

// A coordinate c of a joint is an angle [rad] or a displacement [m] (model/derived/joint_coordinates.hpp), or
// the length of a cylinder [m]; where none is named, the only one, or the first. An effort is the generalized
// force on c [N m, N]; above 0 it increases c.

// A function of c or of its rate, given by points; beyond them it is extrapolated linearly. Empty: 0.
struct Curve {
  std::vector<Real> at, values;
  Interpolation interpolation = Interpolation::linear;
};

struct Motor {
  std::string name;
  int joint = 0;
  MotorKind kind = MotorKind::effort;
  Real limit = kInfinity;  // of the effort, in either direction
  TimeFunction effort;     // effort: as given
  // line: command (stall_effort) (1 - rate / (command free_rate)) = stall_effort (command - rate / free_rate)
  Real stall_effort = 0, free_rate = 0;  // [N m, N], [rad/s, m/s]
  TimeFunction command;                  // fraction of the full voltage or throttle [-]
  // speed: gain e + integral_gain (integral of e), e = rate - c'
  TimeFunction rate;                 // demanded [rad/s, m/s]
  Real gain = 0, integral_gain = 0;  // [N m s/rad, N s/m], [N m/rad, N/m]
  // position: position_gain e + rate_gain e', e = position - c
  TimeFunction position;                  // demanded [rad, m]
  Real position_gain = 0, rate_gain = 0;  // [N m/rad, N/m], [N m s/rad, N s/m]
  std::optional<JointCoordinate> coordinate{};
};

// Spring: effort = -(k (c - free) + d c' + F(c) + G(c')). Where free is left out it is c at t = 0.
struct JointSpring {
  std::string name;
  int joint = 0;
  Real stiffness = 0, damping = 0;  // k, d
  std::optional<Real> free;
  Curve elastic, dissipative;  // F, G
  std::optional<JointCoordinate> coordinate{};
};

// Stop: at a distance d beyond lower or upper the effort K d^n + C d' pushes back.
struct JointLimit {
  std::string name;
  int joint = 0;
  Real lower = -kInfinity, upper = kInfinity;
  Real stiffness = 0, damping = 0, exponent = 1;  // K, C, n
  std::optional<JointCoordinate> coordinate{};
};

// Dry friction: stiction is a spring; the joint slides once the effort reaches s (effort + lever F), F: the
// force that the joint transmits [N], s = 1 + (static_ratio - 1) exp(-(c'/stribeck_rate)^2).
struct JointFriction {
  std::string name;
  int joint = 0;
  Real effort = 0;  // [N m or N]
  Real lever = 0;   // angle: friction coefficient times radius [m]; otherwise friction coefficient [-]
  Real stiffness = 0, damping = 0;  // of the stiction spring [N m/rad, N/m], [N m s/rad, N s/m]
  Real static_ratio = 1;            // at least 1
  Real stribeck_rate = kInfinity;   // [rad/s, m/s]
  std::optional<JointCoordinate> coordinate{};
};

// Coupler: sum of coefficient[k] c[k] = its value at t = 0.
struct Coupler {
  std::string name;
  std::vector<int> joints;
  std::vector<Real> coefficients;
  std::vector<JointCoordinate>
      coordinates{};         // for each joint; empty: the only coordinate of each, or the first
  std::string deck_label{};  // as Joint::deck_label
};

}  // namespace scree
