// Surfaces made from a few numbers. All but sheets are closed, corners counterclockwise seen from outside,
// and have one vertex per place. Round ones have their vertices on the true shape; `segments` go once around.
// Their middle is at the origin and their axis z unless said otherwise. Sizes [m].
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

// Point k of n on the circle of radius 1, counterclockwise from +x; mirror images have mirrored bits, and
// those on the axes are exact.
Vec3 circle_point(std::int64_t k, std::int64_t n);
// The least number of segments, of at least 3 and a multiple of 4, whose chords lie within `sag` of the arc.
Index segments_within(Real radius, Real sag);

struct BoxShape {
  Vec3 size;
};
struct CylinderShape {
  Real radius, length;
  Index segments;
};
// From `radius` at z = 0 to `top_radius` at z = length; 0: a tip.
struct ConeShape {
  Real radius, top_radius, length;
  Index segments;
};
// An icosahedron whose triangles are split into four `levels` times.
struct SphereShape {
  Real radius;
  int levels;
};
// A cylinder of this length with a half sphere on either end, along z; segments: a multiple of 4.
struct CapsuleShape {
  Real radius, length;
  Index segments;
};
// A box with a round hole along z in its middle; segments: a multiple of 4.
struct PlateShape {
  Vec3 size;
  Real hole_radius;
  Index segments;
};
struct PipeShape {
  Real inner_radius, outer_radius, length;
  Index segments;
};
// A pipe of inner `radius` and `wall`, inside which bars of `lifter_height` (towards the axis) by
// `lifter_width` run along all its length, the first in +x. end_wall: thickness of the discs that close it
// beyond `length`; 0: open. At least one segment lies between two lifters.
struct DrumShape {
  Real radius, wall, length, end_wall;
  Index lifters;
  Real lifter_height, lifter_width;
  Index segments;
};
// A core with a helical flight, cut off square at both ends: at each z the disc of the core and a sector of
// the flight, which turns once per `pitch` (below 0: left-handed) and is `thickness` thick along z. The core
// goes on to `core_length` (at least `length`), both in the middle.
struct ScrewShape {
  Real core_radius, flight_radius, pitch, thickness, length, core_length;
  Index segments;
};
// A sheet: the side of a cone from `radius` at z = 0 to `top_radius` at z = length, below which a tube of
// `radius` goes on by `outlet_length`; 0: none.
struct FunnelShape {
  Real radius, top_radius, length, outlet_length;
  Index segments;
};
// The same with rectangles in place of circles, their edges along x and y (z is left out).
struct HopperShape {
  Vec3 size, top_size;
  Real length, outlet_length;
};

// What the numbers of a shape, all finite, must not be, or "".
std::string shape_trouble(const BoxShape& shape);
std::string shape_trouble(const CylinderShape& shape);
std::string shape_trouble(const ConeShape& shape);
std::string shape_trouble(const SphereShape& shape);
std::string shape_trouble(const CapsuleShape& shape);
std::string shape_trouble(const PlateShape& shape);
std::string shape_trouble(const PipeShape& shape);
std::string shape_trouble(const DrumShape& shape);
std::string shape_trouble(const ScrewShape& shape);
std::string shape_trouble(const FunnelShape& shape);
std::string shape_trouble(const HopperShape& shape);

// Of shapes without trouble.
TriangleMesh box_mesh(const BoxShape& shape);
TriangleMesh cylinder_mesh(const CylinderShape& shape);
TriangleMesh cone_mesh(const ConeShape& shape);
TriangleMesh sphere_mesh(const SphereShape& shape);
TriangleMesh capsule_mesh(const CapsuleShape& shape);
TriangleMesh plate_mesh(const PlateShape& shape);
TriangleMesh pipe_mesh(const PipeShape& shape);
TriangleMesh drum_mesh(const DrumShape& shape);
TriangleMesh screw_mesh(const ScrewShape& shape);
TriangleMesh funnel_mesh(const FunnelShape& shape);
TriangleMesh hopper_mesh(const HopperShape& shape);

// A sheet: the rectangle of this size about the origin in the plane z = 0, seen from +z.
TriangleMesh rectangle_mesh(Real width, Real depth);
// For planar models: segments between points (their z is left out) drawn along z, from -2^k to 2^k, the least
// power of two that is at least half_depth, so that what is nearest to a point at z = 0 is at z = 0 exactly.
// Seen from the right of the way from point to point. Without ends, which no particle is near.
TriangleMesh extruded_line_mesh(const std::vector<Vec3>& points, bool closed, Real half_depth);
// A closed line, counterclockwise around its inside, with its ends: a closed mesh. Throws InputError for one
// that crosses itself.
TriangleMesh extruded_outline_mesh(const std::vector<Vec3>& points, Real half_depth);
// Such a mesh without its ends.
TriangleMesh without_ends(TriangleMesh outline);
// A line, with ends or without, from -depth / 2 to depth / 2 [m].
TriangleMesh line_of_depth(TriangleMesh line, Real depth);

}  // namespace scree
