#include "mbs/joint_readings.hpp"

#include "mbs/joint_coordinate.hpp"
#include "model/derived/joint_coordinates.hpp"

namespace scree {

JointReadings::JointReadings(const Model& model, const BodyLayout& layout) {
  std::int64_t left = model.output.history_coordinates;
  for (int j = 0; j < static_cast<int>(model.joints.size()) && left > 0; ++j) {
    const Joint& joint = model.joints[static_cast<std::size_t>(j)];
    const std::vector<JointCoordinate> own = coordinates_of(joint.kind);
    for (const JointCoordinate c : own)
      readings_.push_back({joint.name, c, joint_coordinate("output", model, j, c, layout)});
    if (!own.empty()) --left;
  }
}

std::vector<JointReading> JointReadings::at(const BodyPoses& poses, const SystemInstant& instant) const {
  std::vector<JointReading> out;
  SparseTerm gradient;
  for (const Reading& reading : readings_) {
    gradient = {};
    const CoordinateInstant c = coordinate_at(*reading.value, poses, instant, gradient);
    out.push_back({reading.joint, reading.coordinate, c.value, c.rate});
  }
  return out;
}

}  // namespace scree
