// Joints and force elements as snapshots show them: a line for each.
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

// What a line stands for, as files have it.
enum class LinkKind : int { joint, spring_damper, actuator, bushing, torsional_spring_damper };

// Joints, spring-dampers, torsional ones and bushings, each in the deck's order. The line of a force element
// is between its two points, and so is that of a joint whose points may part. Where the two coincide, as in a
// pin or a bushing, it is from there to the centre of mass of the second body or, where that is the ground or
// the point itself, of the first one; of a torsional spring-damper from centre to centre.
class LinkLines {
 public:
  // At one instant.
  struct Look {
    std::vector<Vec3> ends;  // two of each [m]
    std::vector<int> link, kind;
    std::vector<Real> force, torque, length;  // [N], [N m], [m]
    std::vector<Vec3> reaction;               // on the second body, global axes [N]

    LineSnapshot snapshot() const;  // views of it
  };

  // The model is kept.
  explicit LinkLines(const Model& model);
  bool empty() const { return lines_.empty(); }
  std::vector<std::string> names() const;
  // motion: of the bodies in this state, at the time t.
  Look look(const Multibody& multibody, const MultibodyState& state, Real t,
            std::span<const BodyMotion> motion) const;

 private:
  struct Line {
    std::string name;
    LinkKind kind;
    int body[2];    // at either end
    Vec3 point[2];  // in their frames [m]
  };
  void add(const std::string& name, LinkKind kind, const int (&body)[2], const Vec3 (&point)[2]);
  void add_pin(const std::string& name, LinkKind kind, const int (&body)[2], const Vec3 (&point)[2]);
  void add_forces(const Multibody& multibody, const MultibodyState& state, Real t,
                  std::span<const BodyMotion> motion, Look& look) const;

  const Model& model_;
  Subdomain subdomain_;
  std::vector<Line> lines_;
};

}  // namespace scree
