// Who owns which cells. One rank owns them all; the vocabulary is that of many.
#pragma once

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "model/model.hpp"

namespace scree {

// Times that a particle crossed each periodic side, so that its unwrapped position is known.
struct ImageCount {
  std::int32_t x = 0, y = 0, z = 0;
};

// The space in the form that ownership and halo need. Positions along periodic axes lie on a grid of quanta
// that the period is a multiple of: moving a particle by a period is then exact, and results do not depend on
// when, or on which rank, that happens.
class Subdomain {
 public:
  explicit Subdomain(const Space& space);

  Vec3 period() const { return period_; }  // [m], 0 along axes that are not periodic
  // Rounding constants for snap(): 0 along axes that are not periodic.
  Vec3 snap_constant() const { return snap_; }
  // Whether the point lies within the sides that are not periodic.
  bool inside(Vec3 p) const;
  // Whether the point lies beyond a side that is a wall.
  bool beyond_wall(Vec3 p) const;
  // The position inside the periodic box and the periods taken off it; exact.
  Vec3 wrap(Vec3 p, ImageCount& image) const;

 private:
  Space space_;
  Vec3 period_, snap_;
};

// Rounds a displacement to the quanta of the periodic axes; the identity where the constant is 0.
SCREE_HD Vec3 snap(Vec3 displacement, Vec3 constant) {
  return {(displacement.x + constant.x) - constant.x, (displacement.y + constant.y) - constant.y,
          (displacement.z + constant.z) - constant.z};
}

}  // namespace scree
