#include "mbs/overshooting_servos.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/derived/scalar_function.hpp"

namespace scree {

namespace {

// Overshoot of a first step of length h whose motion has a period that h does not resolve, as a fraction of
// c'' h^2, for alpha from -0.05 to 0 (Hilber and Hughes, Earthquake Engineering and Structural Dynamics 6,
// 1978). The fraction is measured.
constexpr Real kOvershoot = 1e-3;
constexpr Real kMost = 0.3;      // fraction of the distance to the position
constexpr Real kVisible = 1e-4;  // of 1 rad or the length scale

}  // namespace

std::vector<Servo> servos_of(const Model& model) {
  std::vector<Servo> servos;
  if (model.time.control != StepControl::fixed) return servos;
  for (std::size_t k = 0; k < model.motors.size(); ++k) {  // the order of JointForces
    const Motor& motor = model.motors[k];
    if (motor.kind != MotorKind::position) continue;
    const TimeValue wanted = ScalarFunction(motor.position, motor.name, model.time.end)(0);
    servos.push_back({motor.name, model.joints[static_cast<std::size_t>(motor.joint)].name, wanted.value,
                      wanted.rate, model.time.step, k});
  }
  return servos;
}

std::vector<std::string> overshooting_servos(const RigidBodySystem& system, const std::vector<Servo>& servos,
                                             const MultibodyState& start) {
  std::vector<std::string> findings;
  const SystemInstant at{0, start.position, start.velocity, &start.multipliers, &start.acceleration};
  const BodyPoses poses = system.poses_at(at);
  for (const Servo& servo : servos) {
    const JointForce& force = system.joint_forces().all()[servo.number];
    const JointForce::Sample sample = force.sample(poses, at, 0);
    const Real off = std::abs(servo.position - sample.at.value),
               scale = force.is_angle() ? 1 : system.length_scale(),
               distance = off + servo.step * std::abs(servo.rate - sample.at.rate),
               overshoot = kOvershoot * std::abs(sample.at.second) * servo.step * servo.step;
    if (overshoot <= std::max(kMost * distance, kVisible * scale)) continue;
    findings.push_back(fmt::format(
        "servo '{0}' starts {1:.4g} {2} off its position, and a fixed step of {3:.4g} s does not resolve "
        "its response: joint '{4}' may overshoot by {5:.3g} {2} in the first steps. Give it a limit or a "
        "position that starts where the joint is, take time.step = {6:.2g} s, or time.control = \"adaptive\"",
        servo.name, off, force.is_angle() ? "rad" : "m", servo.step, servo.joint, overshoot,
        servo.step * std::sqrt(kMost * distance / overshoot)));
  }
  return findings;
}

}  // namespace scree
