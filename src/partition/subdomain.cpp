#include "partition/subdomain.hpp"

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

// Twice the largest coordinate of the axis, halo included, fits into 2^52 quanta.
Real rounding_constant(Real min, Real max) {
  int exponent = 0;
  std::frexp(4 * std::max(std::abs(min), std::abs(max)), &exponent);
  return std::ldexp(1.5, exponent);
}

}  // namespace

Subdomain::Subdomain(const Space& space) : space_(space) {
  box_ = {{-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity}};
  const auto axis = [&](int side, Real Vec3::*along) {
    const Real min = space.min.*along, max = space.max.*along;
    if (space.boundary[static_cast<std::size_t>(side)] == Boundary::periodic) {
      const Real constant = rounding_constant(min, max);
      snap_.*along = constant;
      period_.*along = ((max - min) + constant) - constant;
    } else {
      box_.min.*along = min, box_.max.*along = max;
    }
  };
  axis(kXMin, &Vec3::x);
  axis(kYMin, &Vec3::y);
  if (space.dimension == 3) axis(kZMin, &Vec3::z);
}

bool Subdomain::beyond_wall(Vec3 p) const {
  const bool beyond[kSides] = {p.x<space_.min.x, p.x> space_.max.x, p.y<space_.min.y, p.y> space_.max.y,
                               p.z<space_.min.z, p.z> space_.max.z};
  for (std::size_t side = 0; side < (space_.dimension == 3 ? kSides : kZMin); ++side)
    if (beyond[side] && space_.boundary[side] == Boundary::wall) return true;
  return false;
}

}  // namespace scree
