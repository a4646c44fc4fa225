// Warns where drivers and cylinders prescribe impossible distances of two points.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "model/checks/deck_checks.hpp"
#include "model/derived/joint_coordinates.hpp"
#include "model/derived/scalar_function.hpp"

namespace scree {

namespace {

// Times at which a length is evaluated: many equidistant ones, and those of the function [s].
std::vector<Real> instants_of(const TimeFunction& function, Real end) {
  constexpr int kParts = 1000;
  std::vector<Real> instants;
  for (int k = 0; k <= kParts; ++k) instants.push_back(end * k / kParts);
  for (const Real t : {function.start, function.end})
    if (t > 0 && t < end) instants.push_back(t);
  for (const Real t : function.times)
    if (t > 0 && t < end) instants.push_back(t);
  return instants;
}

void warn_of_length(const std::string& owner, const TimeFunction& length, Real end, Log& log) {
  const ScalarFunction wanted(length, owner, end);
  Real least = kInfinity, when = 0;
  for (const Real t : instants_of(length, end))
    if (const Real value = wanted(t).value; value < least) least = value, when = t;
  if (least > 0) return;
  log.warning(fmt::format(
      "{} asks for a length of {:.4g} m at t = {:.4g} s, which two points cannot have: the run ends "
      "before, where they meet; a length must stay above 0",
      owner, least, when));
}

}  // namespace

void check_driven_lengths(const Model& model, Log& log) {
  for (const Driver& driver : model.drivers) {
    const Joint& joint = model.joints[static_cast<std::size_t>(driver.joint)];
    if (coordinate_of(driver.name, joint, driver.coordinate) == JointCoordinate::length)
      warn_of_length(fmt::format("{}: driver '{}'", driver.deck_label, driver.name), driver.motion,
                     model.time.end, log);
  }
  for (const Motor& motor : model.motors)
    if (motor.kind == MotorKind::position && model.joints[static_cast<std::size_t>(motor.joint)].telescopes)
      warn_of_length(fmt::format("cylinder '{}'", motor.name), motor.position, model.time.end, log);
}

}  // namespace scree
