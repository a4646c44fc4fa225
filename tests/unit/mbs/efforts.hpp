// Motors, a spring and limits for tests of derivatives: each has effort, stiffness and damping at the
// joint's position.
#pragma once

#include "model/data/model.hpp"

namespace scree {

// Adds them to the first joint of the model; `function`: of time.
inline void add_efforts(Model& model, const TimeFunction& function,
                        std::optional<JointCoordinate> coordinate = {}) {
  Motor line;
  line.kind = MotorKind::line;
  line.stall_effort = 3, line.free_rate = 2, line.command = function;
  Motor speed;
  speed.kind = MotorKind::speed;
  speed.gain = 2, speed.integral_gain = 5, speed.rate = function;
  Motor servo;
  servo.kind = MotorKind::position;
  servo.position_gain = 8, servo.rate_gain = 1.5, servo.position = function;
  model.motors = {line, speed, servo};
  const Curve elastic{{-3, -1, 0, 1, 3}, {-2, -1, 0.5, 1, 4}, Interpolation::natural};
  const Curve dissipative{{-9, -1, 0, 2, 9}, {-3, -1, 0, 1, 5}, Interpolation::monotone};
  model.joint_springs = {{"spring", 0, 7, 3, 0.2, elastic, dissipative}};
  model.joint_limits = {{"lower", 0, 5, 6, 11, 0, 1.5}, {"upper", 0, -6, -5, 13, 0, 1}};
  for (Motor& e : model.motors) e.coordinate = coordinate;
  for (JointSpring& e : model.joint_springs) e.coordinate = coordinate;
  for (JointLimit& e : model.joint_limits) e.coordinate = coordinate;
}

}  // namespace scree
