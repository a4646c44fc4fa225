#include "partition/subdomain.hpp"

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

constexpr Real kMostPeriods = 1e6;

// Twice the largest coordinate of the axis, halo included, fits into 2^52 quanta.
Real rounding_constant(Real min, Real max) {
  int exponent = 0;
  std::frexp(4 * std::max(std::abs(min), std::abs(max)), &exponent);
  return std::ldexp(1.5, exponent);
}

}  // namespace

Subdomain::Subdomain(const Space& space) : space_(space) {
  const auto axis = [&](int side, Real min, Real max, Real& period, Real& constant) {
    if (space.boundary[static_cast<std::size_t>(side)] != Boundary::periodic) return;
    constant = rounding_constant(min, max);
    period = ((max - min) + constant) - constant;
  };
  axis(kXMin, space.min.x, space.max.x, period_.x, snap_.x);
  axis(kYMin, space.min.y, space.max.y, period_.y, snap_.y);
  if (space.dimension == 3) axis(kZMin, space.min.z, space.max.z, period_.z, snap_.z);
}

bool Subdomain::inside(Vec3 p) const {
  const auto within = [](Real x, Real min, Real max, Real period) {
    return period > 0 || (x >= min && x <= max);
  };
  return within(p.x, space_.min.x, space_.max.x, period_.x) &&
         within(p.y, space_.min.y, space_.max.y, period_.y) &&
         (space_.dimension == 2 || within(p.z, space_.min.z, space_.max.z, period_.z));
}

bool Subdomain::beyond_wall(Vec3 p) const {
  const bool beyond[kSides] = {p.x<space_.min.x, p.x> space_.max.x, p.y<space_.min.y, p.y> space_.max.y,
                               p.z<space_.min.z, p.z> space_.max.z};
  for (std::size_t side = 0; side < (space_.dimension == 3 ? kSides : kZMin); ++side)
    if (beyond[side] && space_.boundary[side] == Boundary::wall) return true;
  return false;
}

Vec3 Subdomain::wrap(Vec3 p, ImageCount& image) const {
  // Coordinates that no particle of a sound run has stay as they are; the cell sort then reports them.
  const auto axis = [](Real& x, Real min, Real period, std::int32_t& count) {
    if (period == 0 || !(std::abs(x - min) < kMostPeriods * period)) return;
    const Real periods = std::floor((x - min) / period);
    x -= periods * period;
    count += static_cast<std::int32_t>(periods);
    while (x < min) x += period, --count;
    while (x >= min + period) x -= period, ++count;
  };
  axis(p.x, space_.min.x, period_.x, image.x);
  axis(p.y, space_.min.y, period_.y, image.y);
  axis(p.z, space_.min.z, period_.z, image.z);
  return p;
}

}  // namespace scree
