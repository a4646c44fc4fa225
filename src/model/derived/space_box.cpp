#include "model/derived/space_box.hpp"

namespace scree {

namespace {

constexpr Real kFar = kInfinity;

// distance(boundary, length): outward displacement of a side with this boundary from its position in the deck
// [m]; length: of the domain along its axis [m].
template <class Distance>
Box box_of(const Space& space, const Distance& distance) {
  Box box{{-kFar, -kFar, -kFar}, {kFar, kFar, kFar}};
  const auto axis = [&](std::size_t side, Real Vec3::*along) {
    const Real length = space.max.*along - space.min.*along;
    box.min.*along = space.min.*along - distance(space.boundary[side], length);
    box.max.*along = space.max.*along + distance(space.boundary[side + 1], length);
  };
  axis(kXMin, &Vec3::x);
  axis(kYMin, &Vec3::y);
  if (space.dimension == 3) axis(kZMin, &Vec3::z);
  return box;
}

}  // namespace

Box open_box(const Space& space) {
  return box_of(space, [](Boundary side, Real) { return side == Boundary::periodic ? kFar : 0; });
}

Box periodic_box(const Space& space) {
  return box_of(space, [](Boundary side, Real) { return side == Boundary::periodic ? 0 : kFar; });
}

Box wall_box(const Space& space) {
  return box_of(space, [](Boundary side, Real) { return side == Boundary::wall ? 0 : kFar; });
}

Box start_box(const Space& space) {
  constexpr Real kMostPeriods = 1e6;
  return box_of(space, [](Boundary side, Real length) {
    return side == Boundary::periodic ? kMostPeriods * length : 0;
  });
}

}  // namespace scree
