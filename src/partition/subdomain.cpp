#include "partition/subdomain.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "model/derived/space_box.hpp"

namespace scree {
namespace {

// Such that twice the largest coordinate of the axis, including the halo, is less than 2^52 quanta.
Real rounding_constant(Real min, Real max) {
  int exponent = 0;
  std::frexp(4 * std::max(std::abs(min), std::abs(max)), &exponent);
  return std::ldexp(1.5, exponent);
}

}  // namespace

Subdomain::Subdomain(const Space& space)
    : space_(space), box_(open_box(space)), periodic_(::scree::periodic_box(space)), walls_(wall_box(space)) {
  const auto axis = [&](int side, Real Vec3::*along) {
    if (space.boundary[as_size(side)] != Boundary::periodic) return;
    const Real min = space.min.*along, max = space.max.*along;
    const Real constant = rounding_constant(min, max);
    snap_.*along = constant;
    period_.*along = ((max - min) + constant) - constant;
  };
  axis(kXMin, &Vec3::x);
  axis(kYMin, &Vec3::y);
  if (space.dimension == 3) axis(kZMin, &Vec3::z);
}

}  // namespace scree
