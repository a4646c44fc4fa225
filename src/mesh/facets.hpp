// Deviation of faceted shapes from the round surfaces that they approximate, and the number of facets that
// suits the size of particles.
#pragma once

#include "base/types.hpp"
#include "mesh/primitives.hpp"

namespace scree {

// The largest distance of a point on a facet from the surface that this facet approximates [m], e.g. R (1 -
// cos(pi / n)) for n facets around a cylinder; 0 for flat shapes. Exact but for round-off; for the faces of
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

// Facets suit the particles where they deviate by at most this fraction of the smallest particle's radius.
inline constexpr Real kRelativeFacetError = 0.05;
// Segments and levels of models without particles.
inline constexpr Index kUsualSegments = 48;
inline constexpr int kUsualLevels = 3;

// Segments around a circle of `radius` whose chords lie within kRelativeFacetError times the smallest
// particle's radius, particle_radius [m], from it: a multiple of 4, from 16 to 360, and so many that the
// angle between two facets is less than feature_angle [rad]. By the first condition alone a segment is at
// least two fifths of a particle's diameter long.
Index fitting_segments(Real radius, Real particle_radius, Real feature_angle);
// Levels of a sphere whose facets lie within kRelativeFacetError * particle_radius [m] from it, from 2 to 6.
int fitting_levels(Real radius, Real particle_radius);

}  // namespace scree
