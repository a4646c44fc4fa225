// Joints and force elements in snapshots: one line for each.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mbs/multibody.hpp"
#include "model/data/body_exchange.hpp"
#include "model/data/model.hpp"
#include "output/snapshot.hpp"
#include "partition/subdomain.hpp"

namespace scree {

// Kind of element that a line shows, as files store it.
enum class JointLineKind : int { joint, spring_damper, actuator, bushing, torsional_spring_damper };

// Joints, spring-dampers, torsional spring-dampers and bushings, each group in the deck's order. The line of
// a force element, or of a joint whose points may separate, connects the two points. If the points coincide
// (revolute joints, bushings), the line runs from there to the centre of mass of the second body, or of the
// first body if the second is the ground or has its centre at the point. The line of a torsional
// spring-damper connects the two centres.
class JointLines {
 public:
  // The lines at one instant.
  struct Sample {
    std::vector<Vec3> ends;  // two per line [m]
    std::vector<int> link, kind;
    std::vector<Real> force, torque, length;  // [N], [N m], [m]
    std::vector<Vec3> reaction;               // on the second body, global axes [N]

    LineSnapshot snapshot() const;  // views of this object
  };

  // Keeps a reference to the model.
  explicit JointLines(const Model& model);
  bool empty() const { return lines_.empty(); }
  std::vector<std::string> names() const;
  // motion: of the bodies in this state; t: time [s].
  Sample sample(const Multibody& multibody, const MultibodyState& state, Real t,
                std::span<const BodyMotion> motion) const;

 private:
  struct Line {
    std::string name;
    JointLineKind kind;
    int body[2];    // of the two ends
    Vec3 point[2];  // in the frames of these bodies [m]
  };
  void add(const std::string& name, JointLineKind kind, const int (&body)[2], const Vec3 (&point)[2]);
  void add_pin(const std::string& name, JointLineKind kind, const int (&body)[2], const Vec3 (&point)[2]);
  void add_forces(const Multibody& multibody, const MultibodyState& state, Real t,
                  std::span<const BodyMotion> motion, Sample& sample) const;

  const Model& model_;
  Subdomain subdomain_;
  std::vector<Line> lines_;
};

}  // namespace scree
