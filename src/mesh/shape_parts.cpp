#include "mesh/shape_parts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scree {

namespace {

constexpr Real kPi = std::numbers::pi_v<Real>;

}  // namespace

// With lifters an arc has an even number of parts.
DrumArcs drum_arcs(const DrumShape& shape) {
  if (shape.lifters == 0) return {shape.segments, 0, 2 * kPi / shape.segments, 0, 0};
  DrumArcs arcs{};
  arcs.foot_angle = std::asin(shape.lifter_width / 2 / shape.radius);
  arcs.segments = 2 * ((shape.segments + 2 * shape.lifters - 1) / (2 * shape.lifters));
  arcs.below = static_cast<Index>(std::ceil(shape.segments * arcs.foot_angle / kPi));
  arcs.angle = (2 * kPi / shape.lifters - 2 * arcs.foot_angle) / arcs.segments;
  arcs.angle_below = 2 * arcs.foot_angle / arcs.below;
  return arcs;
}

ScrewParts screw_parts(const ScrewShape& shape) {
  const Real rise = std::abs(shape.pitch), half_sector = kPi * shape.thickness / rise;
  const auto segments_of = [&](Real revolutions, Index least) {
    return std::max(least, static_cast<Index>(std::ceil(shape.segments * revolutions)));
  };
  return {segments_of(shape.length / rise, 1), segments_of(1 - half_sector / kPi, 2),
          segments_of(half_sector / kPi, 1),
          segments_of((1 - shape.core_radius / shape.flight_radius) / (2 * kPi), 1)};
}

}  // namespace scree
