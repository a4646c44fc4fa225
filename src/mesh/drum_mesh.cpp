#include <cmath>
#include <numbers>

#include "mesh/mesh_builder.hpp"
#include "mesh/primitives.hpp"

namespace scree {

namespace {

constexpr Real kPi = std::numbers::pi_v<Real>;

// The drum's section. `inner` and `outer` run counterclockwise at the same angles; a lifter stands on the
// chord from inner[foot] to the next one, with its two tips; the arc from there to the next foot has an even
// number of segments.
struct Section {
  std::vector<Vec3> inner, outer, tips;
  std::vector<std::size_t> feet;
};

Section drum_section(const DrumShape& shape) {
  Section section;
  const Real outwards = 1 + shape.wall / shape.radius;
  const auto add = [&](Vec3 p) {
    section.inner.push_back(p);
    section.outer.push_back(outwards * p);
  };
  if (shape.lifters == 0)
    for (Index k = 0; k < shape.segments; ++k) add(shape.radius * circle_point(k, shape.segments));
  const Real half = shape.lifter_width / 2, foot_angle = std::asin(half / shape.radius);
  const Real foot = std::sqrt(shape.radius * shape.radius - half * half);
  const Index arc = 2 * ((shape.segments + 2 * shape.lifters - 1) / std::max<Index>(1, 2 * shape.lifters));
  for (Index i = 0; i < shape.lifters; ++i) {
    const Vec3 out = circle_point(i, shape.lifters), along{-out.y, out.x, 0};
    section.feet.push_back(section.inner.size());
    for (const Real side : {-half, half}) {
      add(foot * out + side * along);
      section.tips.push_back((shape.radius - shape.lifter_height) * out + side * along);
    }
    const Real gap = 2 * kPi / shape.lifters - 2 * foot_angle;
    for (Index k = 1; k < arc; ++k) {
      const Real angle = foot_angle + gap * k / arc;
      add(shape.radius * (std::cos(angle) * out + std::sin(angle) * along));
    }
  }
  return section;
}

// The section's vertices at one height.
struct Level {
  Ring inner, tips;
};

// Around the free space: the inner ring with the ways over the lifters.
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

// The cut through wall and lifters, seen from +z (up) or -z.
void add_cut(MeshBuilder& builder, const Section& section, const Level& level, const Ring& outer, bool up) {
  if (up) {
    builder.strip(outer, level.inner, true);
  } else {
    builder.strip(level.inner, outer, true);
  }
  for (std::size_t i = 0; i < section.feet.size(); ++i) {
    const Index before = level.inner[section.feet[i]], after = level.inner[section.feet[i] + 1];
    const Index tip_before = level.tips[2 * i], tip_after = level.tips[2 * i + 1];
    if (up) {
      builder.quad(before, after, tip_after, tip_before);
    } else {
      builder.quad(before, tip_before, tip_after, after);
    }
  }
}

// The end wall inside the contour: between two lifters a fan about the middle of the arc, which sees the axis
// and both lifters' sides; towards each lifter a triangle from the axis.
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
    add_cut(builder, section, low, outer_low, false);
    add_cut(builder, section, high, outer_high, true);
  }
  return builder.take();
}

}  // namespace scree
