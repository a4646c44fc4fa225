// The frame of reference in which a list wears.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "model/data/model.hpp"

namespace scree {

// Most that surfaces are searched farther, over the largest radius: longer rows cost every step.
inline constexpr Real kMostFrameReach = 2;

// Particles that fall together do not approach each other: pairs are covered as long as no particle has moved
// by half the skin relative to a frame that moves at a constant velocity, whichever it is. Surfaces do not
// fall: their rows are searched farther by `reach`, and the list expires when the frame has moved so far.
class ListFrame {
 public:
  // At rest: for runs whose results depend on the lists.
  ListFrame() = default;
  // Of particles whose velocities along gravity are between `least` and `most`, and whose speed is at most
  // `speed`, or `in_frame` relative to the mean of the two. skin: of the list, most_reach [m].
  ListFrame(Vec3 gravity, Real least, Real most, Real speed, Real in_frame, Real skin, Real most_reach)
      : ListFrame() {
    constexpr Real kLeastGain = 0.9;  // a small gain is not worth longer rows of surfaces
    if (!(in_frame < kLeastGain * speed)) return;
    velocity_ = mean_fall(gravity, least, most);
    const Real fall = norm(velocity_);
    reach_ = fall * skin < 2 * most_reach * in_frame ? fall * skin / (2 * in_frame) : most_reach;
  }

  // Mean of the velocities along gravity [m/s].
  SCREE_HD static Vec3 mean_fall(Vec3 gravity, Real least, Real most) {
    return ((least + most) / 2 / norm(gravity)) * gravity;
  }

  Vec3 velocity() const { return velocity_; }          // [m/s]
  Vec3 displacement() const { return displacement_; }  // since the list was built [m]
  Real reach() const { return reach_; }                // [m]
  // Opens explicit steps of length h [s].
  void move(Real h, Real steps = 1) { displacement_ += (steps * h) * velocity_; }
  // Whether surfaces are still covered, and for how many further steps of length h [s].
  bool covers_surfaces() const { return reach_ == 0 || norm(displacement_) <= reach_; }
  Real steps_left(Real h) const {
    return reach_ == 0 ? kInfinity : (reach_ - norm(displacement_)) / (h * norm(velocity_));
  }

 private:
  Vec3 velocity_{}, displacement_{};
  Real reach_ = 0;
};

}  // namespace scree
