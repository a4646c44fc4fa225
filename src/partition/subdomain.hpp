// Who owns which cells. One rank owns them all; the vocabulary is that of many.
#pragma once

#include "base/box.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "model/data/model.hpp"

namespace scree {

// Times that a particle crossed each periodic side, so that its unwrapped position is known.
struct ImageCount {
  std::int32_t x = 0, y = 0, z = 0;
};

// p moved by whole periods, rounded once: the same from whichever of its images.
SCREE_HD Vec3 moved_by_periods(Vec3 p, const ImageCount& count, Vec3 period) {
  return {std::fma(Real(count.x), period.x, p.x), std::fma(Real(count.y), period.y, p.y),
          std::fma(Real(count.z), period.z, p.z)};
}

// The position inside the periodic box that starts at min, and the periods taken off it; exact. period: 0
// along axes that are not periodic. Coordinates that no particle of a sound run has stay as they are.
SCREE_HD Vec3 wrap(Vec3 min, Vec3 period, Vec3 p, ImageCount& image) {
  constexpr Real kMostPeriods = 1e6;
  const auto axis = [](Real& x, Real start, Real length, std::int32_t& count) {
    if (x >= start && x < start + length) return;
    if (length == 0 || !(std::abs(x - start) < kMostPeriods * length)) return;
    const Real periods = std::floor((x - start) / length);
    x = std::fma(-periods, length, x);
    count += static_cast<std::int32_t>(periods);
    while (x < start) x += length, --count;
    while (x >= start + length) x -= length, ++count;
  };
  axis(p.x, min.x, period.x, image.x);
  axis(p.y, min.y, period.y, image.y);
  axis(p.z, min.z, period.z, image.z);
  return p;
}

// Wraps the position of a particle. Whether steps can have led there since the last list was built: it is
// finite, and across one periodic side of an axis at most. One that drifts was wrapped when it left and keeps
// its coordinates from then on: far outside, where quanta are lost, taking off a period would not be exact.
SCREE_HD bool wrap_if_sound(Vec3 min, Vec3 period, bool drifts, Vec3& p, ImageCount& image) {
  if (drifts) return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  const ImageCount before = image;
  p = wrap(min, period, p, image);
  const auto sound = [](Real x, Real start, Real length, std::int32_t crossed) {
    if (length == 0) return std::isfinite(x);
    // Wrapped but for round-off at a side.
    return x >= start - length && x <= start + 2 * length && crossed >= -1 && crossed <= 1;
  };
  return sound(p.x, min.x, period.x, image.x - before.x) && sound(p.y, min.y, period.y, image.y - before.y) &&
         sound(p.z, min.z, period.z, image.z - before.z);
}

using OpenBox = Box;  // of the sides of the space that are not periodic

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
  bool inside(Vec3 p) const { return box_.inside(p); }
  const OpenBox& box() const { return box_; }
  // The periodic sides of the space; the others are at infinity.
  const Box& periodic_box() const { return periodic_; }
  // Whether the point lies beyond a side that is a wall.
  bool beyond_wall(Vec3 p) const { return walls_.beyond(p); }
  // The position inside the periodic box and the periods taken off it; exact.
  Vec3 wrap(Vec3 p, ImageCount& image) const { return ::scree::wrap(space_.min, period_, p, image); }

 private:
  Space space_;
  OpenBox box_;
  Box periodic_, walls_;
  Vec3 period_, snap_;
};

// Rounds a displacement to the quanta of the periodic axes; the identity where the constant is 0.
SCREE_HD Vec3 snap(Vec3 displacement, Vec3 constant) {
  return {(displacement.x + constant.x) - constant.x, (displacement.y + constant.y) - constant.y,
          (displacement.z + constant.z) - constant.z};
}

}  // namespace scree
