// How fast things may meet.
#pragma once

#include <vector>

#include "model/checks/limits.hpp"
#include "model/data/model.hpp"

namespace scree {

// How far something can fall within the space [m].
Real fall_height(const Model& model);
// Mass of the relative motion of the lightest pair [kg].
Real lightest_mass(const PairLimit& limit);

// Impact speeds of one model. The constructor reads all its meshes once.
class ImpactSpeeds {
 public:
  explicit ImpactSpeeds(const Model& model);

  // Speed at which the two of a pair may meet [m/s]: with the speeds at t = 0, and after a fall through the
  // space where there is something to fall on; and with the speed of the surfaces that the deck moves, at
  // which particles are thrown, too.
  Real of(const PairLimit& limit) const;
  // Fastest of the surfaces that the deck moves, along their normals [m/s].
  Real fastest_surface() const { return fastest_; }

 private:
  const Model& model_;
  std::vector<MaterialUse> uses_;
  std::vector<Real> surfaces_;  // of each material
  Real fastest_ = 0;            // of all
  bool floor_ = false;          // whether there is a surface to fall on
};

// The time in which a particle as fast as at t = 0 that then fell through the space, or a surface that the
// deck moves, goes half of the smallest radius [s]: in longer steps they might pass through others unnoticed,
// and no error estimate says so. Infinite where nothing moves by itself.
Real unnoticed_step(const Model& model);

}  // namespace scree
