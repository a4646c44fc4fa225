// Coordinates of joints for the history.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mbs/constraints.hpp"
#include "mbs/mechanical_system.hpp"
#include "mbs/multibody.hpp"
#include "model/data/body_layout.hpp"
#include "model/data/model.hpp"

namespace scree {

// The coordinates of the first Output::history_coordinates joints that have any.
class JointReadings {
 public:
  JointReadings(const Model& model, const BodyLayout& layout);

  bool empty() const { return readings_.empty(); }
  std::vector<JointReading> at(const BodyPoses& poses, const SystemInstant& instant) const;

 private:
  struct Reading {
    std::string joint;
    JointCoordinate coordinate;
    std::unique_ptr<Constraint> value;
  };
  std::vector<Reading> readings_;
};

}  // namespace scree
