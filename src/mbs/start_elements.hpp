// Elements of joints that are checked at their start position.
#pragma once

#include <string>
#include <vector>

#include "mbs/overshooting_servos.hpp"
#include "mbs/violated_limits.hpp"

namespace scree {

class StartElements {
 public:
  explicit StartElements(const Model& model) : stops_(stops_of(model)), servos_(servos_of(model)) {}

  bool empty() const { return stops_.empty() && servos_.empty(); }
  // Warnings of violated_limits() and overshooting_servos(); throws as they do.
  std::vector<std::string> findings(const RigidBodySystem& system, const MultibodyState& start,
                                    Real weight) const {
    std::vector<std::string> all = violated_limits(system, stops_, start, weight);
    for (std::string& one : overshooting_servos(system, servos_, start)) all.push_back(std::move(one));
    return all;
  }

 private:
  std::vector<Stop> stops_;
  std::vector<Servo> servos_;
};

}  // namespace scree
