// Poses and velocities of all bodies at one instant, in the form that joints and force elements read.
#pragma once

#include "mbs/planar_motion.hpp"
#include "mbs/spatial_motion.hpp"

namespace scree {

struct BodyPoses {
  explicit BodyPoses(const BodyLayout& layout) : planar(layout), spatial(layout) {}

  PlanarMotion planar;
  SpatialMotion spatial;
};

inline PairGeometry pair_geometry(const PointPair& pair, const BodyPoses& poses) {
  return pair_geometry(pair, poses.planar);
}

}  // namespace scree
