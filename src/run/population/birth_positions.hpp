// Random positions in the region of an inserter.
#pragma once

#include <optional>
#include <span>

#include "base/counter_random.hpp"
#include "model/data/body_exchange.hpp"
#include "model/data/model.hpp"
#include "run/population/carrier_motion.hpp"

namespace scree {

// Position and velocity of a particle at birth.
struct Birth {
  Vec3 position, velocity;  // [m], [m/s]
};

// The region of an inserter at one instant.
class BirthPositions {
 public:
  // motion: of the bodies, then of the walls with a pose. Must not outlive model and inserter.
  BirthPositions(const Model& model, const Inserter& inserter, std::span<const BodyMotion> motion);

  // A random position at which a particle of this radius is inside the region; none where the random point is
  // outside. elapsed: time since the particle passed a face [s].
  std::optional<Birth> draw(CounterRandom random, Real radius, Real elapsed) const;

 private:
  std::optional<Vec3> point(CounterRandom& random, Real radius) const;
  std::optional<Vec3> point_on_face(CounterRandom& random, Real radius) const;

  const Model& model_;
  const Inserter& inserter_;
  CarrierMotion carrier_;
};

}  // namespace scree
