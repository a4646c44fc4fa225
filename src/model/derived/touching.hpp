// What may touch what, and how far it reaches: one rule for the search on either backend, the start checks
// and the limits of steps.
#pragma once

#include <vector>

#include "deck/deck.hpp"
#include "model/data/model.hpp"

namespace scree {

// Smallest and largest radius of particles and bodies' shapes [m]; 0 where there are none.
struct RadiusRange {
  Real smallest = 0, largest = 0;
};
RadiusRange radius_range(const Model& model);

// Whether this shape or mesh of the body touches anything.
bool collides(const DeckTable& body, const DeckTable& surface);

// Shapes of two bodies may touch, but not those of one body, nor of two that a joint or a force element
// connects, unless the deck says so. Particles and walls may touch all.
class TouchRule {
 public:
  explicit TouchRule(const Model& model);

  // body: an index into Model::bodies, or kGround for a particle or a wall.
  bool may_touch(int body_a, int body_b) const;
  // The bodies whose shapes those of this one must not touch, besides its own; sorted, each once.
  const std::vector<int>& kept_apart(int body) const { return apart_[static_cast<std::size_t>(body)]; }
  // Whether there are two bodies whose shapes may touch.
  bool bodies_may_touch() const { return bodies_may_touch_; }

 private:
  std::vector<std::vector<int>> apart_;  // per body
  bool bodies_may_touch_ = false;
};

}  // namespace scree
