// How far the facets of shapes made from a few numbers lie from the round surfaces that they stand for, and
// how many facets fit the size of particles.
#pragma once

#include "base/types.hpp"
#include "mesh/primitives.hpp"

namespace scree {

// The largest distance of a point on a facet from the surface that this facet stands for [m]: R (1 - cos(pi /
// n)) of n facets around a cylinder, and the like; 0 of flat shapes. Exact but for round-off; of the faces of
// a screw's flight, which are twisted, to 0.2 %.
Real facet_deviation(const BoxShape& shape);
Real facet_deviation(const CylinderShape& shape);
Real facet_deviation(const ConeShape& shape);
Real facet_deviation(const SphereShape& shape);
Real facet_deviation(const CapsuleShape& shape);
Real facet_deviation(const PlateShape& shape);
Real facet_deviation(const PipeShape& shape);
Real facet_deviation(const DrumShape& shape);
Real facet_deviation(const ScrewShape& shape);
Real facet_deviation(const FunnelShape& shape);
Real facet_deviation(const HopperShape& shape);

// Facets within this share of the smallest particle's radius fit the particles.
inline constexpr Real kFacetShare = 0.05;
// Segments and levels where there are no particles.
inline constexpr Index kUsualSegments = 48;
inline constexpr int kUsualLevels = 3;

// Segments around a circle of `radius` whose chords lie within kFacetShare of the smallest particle's radius
// `grain` from it [m]: a multiple of 4, from 16 to 360, and so many that two facets turn by less than
// feature_angle [rad]. By the first rule alone a segment is two fifths of a particle's diameter long at
// least.
Index fitting_segments(Real radius, Real grain, Real feature_angle);
// Levels of a sphere whose facets lie within kFacetShare of `grain` from it [m], from 2 to 6.
int fitting_levels(Real radius, Real grain);

}  // namespace scree
