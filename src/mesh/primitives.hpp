// Surfaces made from a few numbers. All but open surfaces are closed, with corners counterclockwise seen
// from outside, and no two vertices coincide. Round ones have their vertices on the true shape, with
// `segments` around. They are centred at the origin with axis z unless stated otherwise. Sizes [m].
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "mesh/triangle_mesh.hpp"

namespace scree {

// Point k of n on the circle of radius 1, counterclockwise from +x; mirror images have mirrored bits, and
// points on the axes are exact.
Vec3 circle_point(std::int64_t k, std::int64_t n);
// The smallest number of segments, a multiple of 4, whose chords lie within `sag` of the arc.
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
// A pipe of inner `radius` and `wall`, with bars of `lifter_height` (towards the axis) by `lifter_width`
// along all its length inside, the first one at +x. end_wall: thickness of the discs that close it beyond
// `length`; 0: open. There is at least one segment between two lifters.
struct DrumShape {
  Real radius, wall, length, end_wall;
  Index lifters;
  Real lifter_height, lifter_width;
  Index segments;
};
// A core with a helical flight, cut off square at both ends: at each z the section is the disc of the core
// and a sector of the flight, which makes one revolution per `pitch` (negative: left-handed) and has
// `thickness` along z. The core extends to `core_length` (at least `length`); both are centred.
struct ScrewShape {
  Real core_radius, flight_radius, pitch, thickness, length, core_length;
  Index segments;
};
// An open surface: the side of a cone from `radius` at z = 0 to `top_radius` at z = length, continued below
// by a tube of `radius` and `outlet_length`; 0: none.
struct FunnelShape {
  Real radius, top_radius, length, outlet_length;
  Index segments;
};
// A funnel with rectangles in place of circles, their edges along x and y (their z is unused).
struct HopperShape {
  Vec3 size, top_size;
  Real length, outlet_length;
};

// The first violated condition on the numbers of a shape, all finite, or "".
std::string shape_defect(const BoxShape& shape);
std::string shape_defect(const CylinderShape& shape);
std::string shape_defect(const ConeShape& shape);
std::string shape_defect(const SphereShape& shape);
std::string shape_defect(const CapsuleShape& shape);
std::string shape_defect(const PlateShape& shape);
std::string shape_defect(const PipeShape& shape);
std::string shape_defect(const DrumShape& shape);
std::string shape_defect(const ScrewShape& shape);
std::string shape_defect(const FunnelShape& shape);
std::string shape_defect(const HopperShape& shape);

// Meshes of valid shapes, those for which shape_defect() is empty.
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

// An open surface: the rectangle of this size about the origin in the plane z = 0, facing +z.
TriangleMesh rectangle_mesh(Real width, Real depth);
// For planar models: segments between points (their z is unused) extruded along z, from -2^k to 2^k, the
// least power of two that is at least half_depth, so that the nearest point of any z = 0 point has z = 0
// exactly. Faces to the right of the path from point to point. Without ends, which no particle reaches.
TriangleMesh extruded_line_mesh(const std::vector<Vec3>& points, bool closed, Real half_depth);
// A closed line, counterclockwise around its inside, extruded with ends: a closed mesh. Throws InputError
// for a line that crosses itself.
TriangleMesh extruded_outline_mesh(const std::vector<Vec3>& points, Real half_depth);
// The extruded outline without its ends.
TriangleMesh without_ends(TriangleMesh outline);
// An extruded line, with or without ends, rescaled to z from -depth / 2 to depth / 2 [m].
TriangleMesh line_of_depth(TriangleMesh line, Real depth);

}  // namespace scree
