#include "mesh/facets.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/shape_parts.hpp"

namespace scree {

namespace {

constexpr Real kPi = std::numbers::pi_v<Real>;

// Largest distance of a chord that spans this angle from its arc of radius 1, without subtraction of numbers
// near 1.
Real sag_of(Real angle) {
  const Real s = std::sin(angle / 4);
  return 2 * s * s;
}

Real around(Real radius, Index segments) { return radius * sag_of(2 * kPi / segments); }

// Sag of the side of a cone [m]: the sag of a chord of its circle times the cosine of the side's slope.
Real of_cone(Real radius, Real top_radius, Real length, Index segments) {
  const Real slant = std::hypot(length, radius - top_radius);
  return around(std::max(radius, top_radius), segments) * length / slant;
}

// Distance of the origin of the plane from the segment from p to q.
Real distance_to_segment(Real px, Real py, Real qx, Real qy) {
  const Real ex = qx - px, ey = qy - py;
  const Real t = std::clamp(-(px * ex + py * ey) / (ex * ex + ey * ey), Real(0), Real(1));
  return std::hypot(px + t * ex, py + t * ey);
}

}  // namespace

Real facet_deviation(const BoxShape&) { return 0; }
Real facet_deviation(const HopperShape&) { return 0; }

Real facet_deviation(const CylinderShape& shape) { return around(shape.radius, shape.segments); }

Real facet_deviation(const ConeShape& shape) {
  return of_cone(shape.radius, shape.top_radius, shape.length, shape.segments);
}

Real facet_deviation(const PlateShape& shape) { return around(shape.hole_radius, shape.segments); }

Real facet_deviation(const PipeShape& shape) { return around(shape.outer_radius, shape.segments); }

Real facet_deviation(const FunnelShape& shape) {
  const Real cone = of_cone(shape.radius, shape.top_radius, shape.length, shape.segments);
  return shape.outlet_length > 0 ? std::max(cone, around(shape.radius, shape.segments)) : cone;
}

// The largest facet is in the middle of a face of the icosahedron. The tangent of the angle between its
// corners and the face's axis is halved with each level, as the middles of the facet's edges are half as far
// from the axis and as far along it as its corners.
Real facet_deviation(const SphereShape& shape) {
  const Real g = std::numbers::phi_v<Real>, cosine = g * g / std::sqrt(3 * (1 + g * g));
  const Real tangent = std::sqrt(1 - cosine * cosine) / cosine / std::ldexp(Real(1), shape.levels);
  return shape.radius * sag_of(2 * std::atan(tangent));
}

// A half sphere's facets between two latitudes are plane and symmetric about a meridian: the point nearest
// to the centre is on the line between the middles of its two chords.
Real facet_deviation(const CapsuleShape& shape) {
  const Real chord = std::cos(kPi / shape.segments);
  Real nearest = 1;
  for (Index k = 0; k < shape.segments / 4; ++k) {
    const Vec3 low = circle_point(k, shape.segments), high = circle_point(k + 1, shape.segments);
    nearest = std::min(nearest, distance_to_segment(chord * low.x, low.y, chord * high.x, high.y));
  }
  return shape.radius * (1 - nearest);
}

// The outer wall has the angles of the arcs between the lifters and of the arcs under them.
Real facet_deviation(const DrumShape& shape) {
  const DrumArcs arcs = drum_arcs(shape);
  return (shape.radius + shape.wall) * sag_of(std::max(arcs.angle, arcs.angle_below));
}

namespace {

// Distance of a point from the helicoid z = -rise * angle of unlimited radius: the least distance from the
// line at an angle, over all angles, by Newton's method from the point's own angle.
Real distance_from_helicoid(Vec3 p, Real rise) {
  const Real radius = std::hypot(p.x, p.y), own = std::atan2(p.y, p.x);
  Real angle_from_start = 0;  // from that angle
  for (int step = 0; step < 20; ++step) {
    const Real height = p.z + rise * (own + angle_from_start);
    const Real slope = radius * radius * std::sin(2 * angle_from_start) / 2 + rise * height;
    const Real bend = radius * radius * std::cos(2 * angle_from_start) + rise * rise;
    if (!(bend > 0)) break;
    angle_from_start -= slope / bend;
  }
  return std::hypot(radius * std::sin(angle_from_start), p.z + rise * (own + angle_from_start));
}

// The largest distance of points of a triangle from the helicoid.
Real farthest_from_helicoid(Vec3 a, Vec3 b, Vec3 c, Real rise) {
  constexpr int kPoints = 24;
  Real farthest = 0;
  for (int i = 0; i <= kPoints; ++i)
    for (int j = 0; i + j <= kPoints; ++j) {
      const Vec3 p = a + (Real(i) / kPoints) * (b - a) + (Real(j) / kPoints) * (c - a);
      farthest = std::max(farthest, distance_from_helicoid(p, rise));
    }
  return farthest;
}

// Largest distance of a face of the flight between two sections that are rotated by `angle` against each
// other, each patch split from its inner corner in the one to its outer corner in the other; the other face
// is its image under a half revolution.
Real of_flight(const ScrewShape& shape, const ScrewParts& parts, Real angle) {
  const Real rise = std::abs(shape.pitch) / (2 * kPi), height = rise * angle;
  const auto at = [&](Real radius, bool high) {
    return high ? Vec3{radius * std::cos(angle), -radius * std::sin(angle), height} : Vec3{radius, 0, 0};
  };
  Real farthest = 0;
  for (Index k = 0; k < parts.radial_segments; ++k) {
    const Real step = (shape.flight_radius - shape.core_radius) / parts.radial_segments;
    const Real inner = shape.core_radius + k * step, outer = inner + step;
    farthest =
        std::max({farthest, farthest_from_helicoid(at(inner, false), at(outer, false), at(outer, true), rise),
                  farthest_from_helicoid(at(inner, false), at(outer, true), at(inner, true), rise)});
  }
  return farthest;
}

}  // namespace

Real facet_deviation(const ScrewShape& shape) {
  const ScrewParts parts = screw_parts(shape);
  const Real sector = 2 * kPi * shape.thickness / std::abs(shape.pitch);
  const Real angle_from_start = 2 * kPi * shape.length / std::abs(shape.pitch) / parts.layers;
  const Real on_rim = sector / parts.sector_segments, on_core = (2 * kPi - sector) / parts.core_segments;
  const Real at_ends = shape.core_length > shape.length ? on_rim : 0;
  return std::max({shape.flight_radius * sag_of(std::max(angle_from_start, on_rim)),
                   shape.core_radius * sag_of(std::max({angle_from_start, on_core, at_ends})),
                   of_flight(shape, parts, angle_from_start)});
}

Index fitting_segments(Real radius, Real particle_radius, Real feature_angle) {
  constexpr Index kLeast = 16, kMost = 360;
  const Real quarter = std::min<Real>(kMost, std::floor(kPi / 2 / feature_angle) + 1);
  const Index smooth = static_cast<Index>(quarter);  // segments in a quarter
  return std::clamp(segments_within(radius, kRelativeFacetError * particle_radius),
                    std::clamp(4 * smooth, kLeast, kMost), kMost);
}

int fitting_levels(Real radius, Real particle_radius) {
  constexpr int kLeast = 2, kMost = 6;
  int levels = kLeast;
  while (levels < kMost &&
         facet_deviation(SphereShape{radius, levels}) > kRelativeFacetError * particle_radius)
    ++levels;
  return levels;
}

}  // namespace scree
