// Rules for contact and its range, shared by the search on either backend, the start checks and the step
// limits.
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

// Whether this shape or mesh of the body takes part in contact.
bool collides(const DeckTable& body, const DeckTable& surface);

// Shapes of two bodies may touch, but not those of one body or, unless the deck says so, those of two bodies
// that a joint or force element connects. Particles and walls may touch everything.
class TouchRule {
 public:
  explicit TouchRule(const Model& model);

  // body: an index into Model::bodies, or kGround for a particle or a wall.
  bool may_touch(int body_a, int body_b) const;
  // The bodies, besides itself, whose shapes this body's shapes must not touch; sorted, each once.
  const std::vector<int>& excluded_bodies(int body) const { return apart_[static_cast<std::size_t>(body)]; }
  // Whether there are two bodies whose shapes may touch.
  bool bodies_may_touch() const { return bodies_may_touch_; }

 private:
  std::vector<std::vector<int>> apart_;  // for each body
  bool bodies_may_touch_ = false;
};

}  // namespace scree
