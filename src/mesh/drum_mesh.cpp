#include <cmath>
#include <numbers>

#include "mesh/mesh_builder.hpp"
#include "mesh/primitives.hpp"
#include "mesh/shape_parts.hpp"

namespace scree {

namespace {

constexpr Real kPi = std::numbers::pi_v<Real>;

// The drum's section. `inner` and `outer` run counterclockwise. A lifter stands between inner[foot] and
// inner[foot + 1] and has two tips. The arc from there to the next foot has an even number of segments.
// `inner` has the angles of `outer`, except between the feet of a lifter, where `under` has them instead.
struct Section {
  std::vector<Vec3> inner, outer, tips, under;  // under: of the first lifter, then of the second, ...
  std::vector<std::size_t> feet;
};

Section drum_section(const DrumShape& shape) {
  Section section;
  const Real outwards = 1 + shape.wall / shape.radius;
  const auto add = [&](std::vector<Vec3>& ring, Vec3 p) {
    ring.push_back(p);
    section.outer.push_back(outwards * p);
  };
  if (shape.lifters == 0)
    for (Index k = 0; k < shape.segments; ++k)
      add(section.inner, shape.radius * circle_point(k, shape.segments));
  const DrumArcs arcs = drum_arcs(shape);
  const Index arc = arcs.segments, below = arcs.below;
  const Real half = shape.lifter_width / 2, foot_angle = arcs.foot_angle;
  const Real foot = std::sqrt(shape.radius * shape.radius - half * half);
  for (Index i = 0; i < shape.lifters; ++i) {
    const Vec3 out = circle_point(i, shape.lifters), along{-out.y, out.x, 0};
    const auto on_arc = [&](Real angle) {
      return shape.radius * (std::cos(angle) * out + std::sin(angle) * along);
    };
    section.feet.push_back(section.inner.size());
    for (const Real side : {-half, half})
      section.tips.push_back((shape.radius - shape.lifter_height) * out + side * along);
    add(section.inner, foot * out - half * along);
    for (Index k = 1; k < below; ++k) add(section.under, on_arc(foot_angle * (2 * k - below) / below));
    add(section.inner, foot * out + half * along);
    const Real gap = 2 * kPi / shape.lifters - 2 * foot_angle;
    for (Index k = 1; k < arc; ++k) add(section.inner, on_arc(foot_angle + gap * k / arc));
  }
  return section;
}

// The vertices of the section at one height.
struct Level {
  Ring inner, tips;
};

// Contour of the free space: the inner ring, over the lifters.
Ring contour(const Section& section, const Level& level) {
  if (section.feet.empty()) return level.inner;
  Ring ring;
  for (std::size_t i = 0; i < section.feet.size(); ++i) {
    const std::size_t foot = section.feet[i];
    const std::size_t end = i + 1 < section.feet.size() ? section.feet[i + 1] : level.inner.size();
    ring.insert(ring.end(), {level.inner[foot], level.tips[2 * i], level.tips[2 * i + 1]});
    ring.insert(ring.end(), level.inner.begin() + foot + 1, level.inner.begin() + end);
  }
  return ring;
}

// The cut through wall and lifters at height z, seen from +z (up) or -z: the wall as a strip, each lifter as
// a fan about the tip before it.
void add_cut(MeshBuilder& builder, const Section& section, const Level& level, const Ring& outer, Real z,
             bool up) {
  const auto add = [&](Index a, Index b, Index c) {
    up ? builder.triangle(a, b, c) : builder.triangle(a, c, b);
  };
  const Ring under = builder.ring(section.under, z);
  const std::size_t lifters = section.feet.size(), below = lifters == 0 ? 0 : under.size() / lifters;
  Ring wall = level.inner;
  for (std::size_t i = lifters; i-- > 0;) {
    const auto foot = wall.begin() + static_cast<std::ptrdiff_t>(section.feet[i]);
    const auto first = under.begin() + static_cast<std::ptrdiff_t>(i * below);
    wall.insert(foot + 1, first, first + static_cast<std::ptrdiff_t>(below));
  }
  for (std::size_t i = 0; i < lifters; ++i) {
    const std::size_t foot = section.feet[i] + i * below;
    const Index tip = level.tips[2 * i];
    for (std::size_t k = foot; k <= foot + below; ++k) add(tip, wall[k], wall[k + 1]);
    add(tip, wall[foot + below + 1], level.tips[2 * i + 1]);
  }
  up ? builder.strip(outer, wall, true) : builder.strip(wall, outer, true);
}

// The end wall inside the contour. Between two lifters it is a fan about the middle of the arc, from which
// the axis and both lifters' sides are visible; towards each lifter it is a triangle from the axis.
void add_inner_end(MeshBuilder& builder, const Section& section, const Level& level, Real z, bool up) {
  const Index axis = builder.vertex({0, 0, z});
  const auto add = [&](Index a, Index b, Index c) {
    up ? builder.triangle(a, b, c) : builder.triangle(a, c, b);
  };
  const std::size_t points = level.inner.size(), lifters = section.feet.size();
  if (lifters == 0)
    for (std::size_t k = 0; k < points; ++k) add(axis, level.inner[k], level.inner[(k + 1) % points]);
  for (std::size_t i = 0; i < lifters; ++i) {
    const std::size_t first = section.feet[i] + 1, arc = points / lifters - 1;
    Ring around{axis, level.tips[2 * i + 1]};
    for (std::size_t k = 0; k <= arc; ++k) around.push_back(level.inner[(first + k) % points]);
    around.push_back(level.tips[2 * ((i + 1) % lifters)]);
    const std::size_t middle = 2 + arc / 2, size = around.size();
    for (std::size_t k = 1; k + 1 < size; ++k)
      add(around[middle], around[(middle + k) % size], around[(middle + k + 1) % size]);
    add(axis, level.tips[2 * i], level.tips[2 * i + 1]);
  }
}

}  // namespace

TriangleMesh drum_mesh(const DrumShape& shape) {
  const Section section = drum_section(shape);
  MeshBuilder builder;
  const Real inside = shape.length / 2, outside = inside + shape.end_wall;
  const auto level_at = [&](Real z) {
    return Level{builder.ring(section.inner, z), builder.ring(section.tips, z)};
  };
  const Level low = level_at(-inside), high = level_at(inside);
  const Ring outer_low = builder.ring(section.outer, -outside),
             outer_high = builder.ring(section.outer, outside);
  builder.strip(outer_low, outer_high, true);
  builder.strip(contour(section, high), contour(section, low), true);
  if (shape.end_wall > 0) {
    builder.fan(builder.vertex({0, 0, -outside}), reversed(outer_low));
    builder.fan(builder.vertex({0, 0, outside}), outer_high);
    add_inner_end(builder, section, low, -inside, true);
    add_inner_end(builder, section, high, inside, false);
  } else {
    add_cut(builder, section, low, outer_low, -inside, false);
    add_cut(builder, section, high, outer_high, inside, true);
  }
  return builder.take();
}

}  // namespace scree
