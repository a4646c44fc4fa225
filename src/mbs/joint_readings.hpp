// Coordinates of joints as the history shows them.
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

// Of the first Output::history_coordinates joints that have coordinates, each of these.
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
