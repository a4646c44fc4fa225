#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "mesh/primitives.hpp"

namespace scree {

namespace {

// Keeps every shape below some 1e8 triangles.
constexpr Index kMostSegments = 10'000;
constexpr int kMostLevels = 10;
constexpr Real kMostTriangles = 1e8;

// Collects conditions and reports the first violated one.
struct Demand {
  bool met;
  std::string text;
};
std::string first_unmet(std::initializer_list<Demand> demands) {
  for (const Demand& demand : demands)
    if (!demand.met) return demand.text;
  return "";
}

Demand positive(const char* key, Real value) {
  return {value > 0, fmt::format("{} = {}: must be positive", key, value)};
}
Demand at_least(const char* key, Real value, const char* least_key, Real least) {
  return {value >= least, fmt::format("{} = {}: must be at least {} = {}", key, value, least_key, least)};
}
Demand above(const char* key, Real value, const char* other_key, Real other) {
  return {value > other, fmt::format("{} = {}: must be above {} = {}", key, value, other_key, other)};
}
Demand not_negative(const char* key, Real value) {
  return {value >= 0, fmt::format("{} = {}: must be at least 0", key, value)};
}
Demand segments_from(Index least, Index segments) {
  return {segments >= least && segments <= kMostSegments,
          fmt::format("segments = {}: must be {} to {}", segments, least, kMostSegments)};
}
Demand segments_by_four(Index segments) {
  return {segments >= 4 && segments <= kMostSegments && segments % 4 == 0,
          fmt::format("segments = {}: must be a multiple of 4, 4 to {}", segments, kMostSegments)};
}
Demand all_positive(Vec3 size) {
  return {size.x > 0 && size.y > 0 && size.z > 0,
          fmt::format("size = [{}, {}, {}]: must be positive", size.x, size.y, size.z)};
}
Demand both_positive(const char* key, Vec3 size) {
  return {size.x > 0 && size.y > 0, fmt::format("{} = [{}, {}]: must be positive", key, size.x, size.y)};
}

}  // namespace

std::string shape_defect(const BoxShape& shape) { return first_unmet({all_positive(shape.size)}); }

std::string shape_defect(const CylinderShape& shape) {
  return first_unmet(
      {positive("radius", shape.radius), positive("length", shape.length), segments_from(3, shape.segments)});
}

std::string shape_defect(const ConeShape& shape) {
  return first_unmet({positive("radius", shape.radius), not_negative("top_radius", shape.top_radius),
                      positive("length", shape.length), segments_from(3, shape.segments)});
}

std::string shape_defect(const SphereShape& shape) {
  return first_unmet({positive("radius", shape.radius),
                      {shape.levels >= 0 && shape.levels <= kMostLevels,
                       fmt::format("levels = {}: must be 0 to {}", shape.levels, kMostLevels)}});
}

std::string shape_defect(const CapsuleShape& shape) {
  return first_unmet(
      {positive("radius", shape.radius), positive("length", shape.length), segments_by_four(shape.segments)});
}

std::string shape_defect(const PlateShape& shape) {
  const Real half = std::min(shape.size.x, shape.size.y) / 2;
  return first_unmet(
      {all_positive(shape.size),
       positive("hole_radius", shape.hole_radius),
       {shape.hole_radius < half,
        fmt::format("hole_radius = {}: must be less than half of the plate, {}", shape.hole_radius, half)},
       segments_by_four(shape.segments)});
}

std::string shape_defect(const PipeShape& shape) {
  return first_unmet({positive("inner_radius", shape.inner_radius),
                      above("outer_radius", shape.outer_radius, "inner_radius", shape.inner_radius),
                      positive("length", shape.length), segments_from(3, shape.segments)});
}

std::string shape_defect(const DrumShape& shape) {
  const std::string common =
      first_unmet({positive("radius", shape.radius),
                   positive("wall", shape.wall),
                   positive("length", shape.length),
                   not_negative("end_wall", shape.end_wall),

                   {shape.lifters >= 0 && shape.lifters <= kMostSegments,
                    fmt::format("lifters = {}: must be 0 to {}", shape.lifters, kMostSegments)},
                   segments_from(3, shape.segments)});
  if (!common.empty() || shape.lifters == 0) return common;
  // Between the tips of two lifters, and between their feet, some of the drum must be free.
  const Real half = shape.lifter_width / 2, tip = shape.radius - shape.lifter_height;
  const Real half_revolution = std::numbers::pi_v<Real> / shape.lifters;
  return first_unmet(
      {positive("lifter_height", shape.lifter_height),
       positive("lifter_width", shape.lifter_width),
       {half < shape.radius && tip > 0 && std::atan2(half, tip) < half_revolution &&
            std::asin(half / shape.radius) < half_revolution,
        fmt::format("{} lifters of height {} and width {} do not fit into radius = {}", shape.lifters,
                    shape.lifter_height, shape.lifter_width, shape.radius)},
       {std::sqrt(shape.radius * shape.radius - half * half) > tip,
        fmt::format("lifter_height = {}: must be above the sag of the wall under the lifter's width, {}",
                    shape.lifter_height,
                    shape.radius - std::sqrt(shape.radius * shape.radius - half * half))}});
}

std::string shape_defect(const ScrewShape& shape) {
  const Real lead = std::abs(shape.pitch);
  return first_unmet(
      {positive("core_radius", shape.core_radius),
       above("flight_radius", shape.flight_radius, "core_radius", shape.core_radius),
       {lead > 0, "pitch = 0: must not be 0"},
       positive("thickness", shape.thickness),
       {shape.thickness < lead,
        fmt::format("thickness = {}: must be less than the pitch, {}", shape.thickness, lead)},
       positive("length", shape.length),
       at_least("core_length", shape.core_length, "length", shape.length),
       segments_from(8, shape.segments),
       {2 * shape.length / lead * shape.segments * shape.segments <= kMostTriangles,
        fmt::format("segments = {}: would make more than {} triangles", shape.segments, kMostTriangles)}});
}

std::string shape_defect(const FunnelShape& shape) {
  return first_unmet({positive("radius", shape.radius), positive("top_radius", shape.top_radius),
                      positive("length", shape.length), not_negative("outlet_length", shape.outlet_length),
                      segments_from(3, shape.segments)});
}

std::string shape_defect(const HopperShape& shape) {
  return first_unmet({both_positive("size", shape.size), both_positive("top_size", shape.top_size),
                      positive("length", shape.length), not_negative("outlet_length", shape.outlet_length)});
}

}  // namespace scree
