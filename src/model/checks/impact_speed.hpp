// Estimates of impact speeds.
#pragma once

#include <vector>

#include "model/checks/limits.hpp"
#include "model/data/model.hpp"

namespace scree {

// Largest height of a fall within the domain [m].
Real fall_height(const Model& model);
// Reduced mass of the lightest pair [kg].
Real lightest_mass(const PairLimit& limit);

// Impact speeds of one model. The constructor reads all its meshes once.
class ImpactSpeeds {
 public:
  explicit ImpactSpeeds(const Model& model);

  // Impact speed of a pair [m/s]: from the speeds at t = 0, a fall through the domain where there is a
  // surface below, and the speed of surfaces that the deck moves, which may also throw particles.
  Real of(const PairLimit& limit) const;
  // Largest normal speed of the surfaces that the deck moves [m/s].
  Real fastest_surface() const { return fastest_; }

 private:
  const Model& model_;
  std::vector<MaterialUse> uses_;
  std::vector<Real> surfaces_;  // for each material
  Real fastest_ = 0;            // of all materials
  bool floor_ = false;          // whether there is a surface to fall on
};

// The time in which a particle with its initial speed and the speed of a fall through the domain, or a
// surface that the deck moves, travels half of the smallest radius [s]. In longer steps particles may pass
// through others, and no error estimate detects it. Infinite where nothing moves by itself.
Real unnoticed_step(const Model& model);

}  // namespace scree
