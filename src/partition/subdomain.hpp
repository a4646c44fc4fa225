// The domain of a rank: periodic sides, walls, and exact wrapping of positions.
#pragma once

#include "base/box.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "model/data/model.hpp"

namespace scree {

// Number of crossings of each periodic side, from which the unwrapped position follows.
struct ImageCount {
  std::int32_t x = 0, y = 0, z = 0;
};

// p shifted by whole periods, rounded once: the result does not depend on which image p is.
SCREE_HD Vec3 moved_by_periods(Vec3 p, const ImageCount& count, Vec3 period) {
  return {std::fma(Real(count.x), period.x, p.x), std::fma(Real(count.y), period.y, p.y),
          std::fma(Real(count.z), period.z, p.z)};
}

// The position inside the periodic box that starts at min, and the periods subtracted; exact. period: 0 along
// axes that are not periodic. Coordinates beyond any valid run stay unchanged.
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

// Wraps the position of a particle. Returns whether steps since the last list build can lead there: it is
// finite, and has crossed at most one periodic side per axis. A ballistic particle outside the domain was
// wrapped when it escaped and keeps its coordinates afterwards: far outside, where quanta are lost,
// subtracting a period would not be exact.
SCREE_HD bool wrap_if_sound(Vec3 min, Vec3 period, bool drifts, Vec3& p, ImageCount& image) {
  if (drifts) return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  const ImageCount before = image;
  p = wrap(min, period, p, image);
  const auto sound = [](Real x, Real start, Real length, std::int32_t crossed) {
    if (length == 0) return std::isfinite(x);
    // Inside the box up to round-off at a side, after at most one crossing.
    return x >= start - length && x <= start + 2 * length && crossed >= -1 && crossed <= 1;
  };
  return sound(p.x, min.x, period.x, image.x - before.x) && sound(p.y, min.y, period.y, image.y - before.y) &&
         sound(p.z, min.z, period.z, image.z - before.z);
}

using OpenBox = Box;  // bounded by the sides of the domain that are not periodic

// The domain in the form that ownership and halo need. Positions along periodic axes are multiples of a
// quantum that divides the period: shifts by a period are then exact, and results do not depend on when, or
// on which rank, they happen.
class Subdomain {
 public:
  explicit Subdomain(const Space& space);

  Vec3 period() const { return period_; }  // [m], 0 along axes that are not periodic
  // Rounding constants for snap(); 0 along axes that are not periodic.
  Vec3 snap_constant() const { return snap_; }
  // Whether the point is within the sides that are not periodic.
  bool inside(Vec3 p) const { return box_.inside(p); }
  const OpenBox& box() const { return box_; }
  // The periodic sides of the domain; the other sides are at infinity.
  const Box& periodic_box() const { return periodic_; }
  // Whether the point is beyond a side that is a wall.
  bool is_beyond_wall(Vec3 p) const { return walls_.beyond(p); }
  // The position inside the periodic box, and the periods subtracted; exact.
  Vec3 wrap(Vec3 p, ImageCount& image) const { return ::scree::wrap(space_.min, period_, p, image); }

 private:
  Space space_;
  OpenBox box_;
  Box periodic_, walls_;
  Vec3 period_, snap_;
};

// Rounds a displacement to multiples of the quanta of the periodic axes; the identity if the constant is 0.
SCREE_HD Vec3 snap(Vec3 displacement, Vec3 constant) {
  return {(displacement.x + constant.x) - constant.x, (displacement.y + constant.y) - constant.y,
          (displacement.z + constant.z) - constant.z};
}

}  // namespace scree
