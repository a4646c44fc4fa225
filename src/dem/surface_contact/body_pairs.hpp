// What the Newton matrix has of two bodies that touch each other, over an implicit step.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "dem/surface_contact/body_items.hpp"
#include "model/data/body_exchange.hpp"

namespace scree {

// A body at a contact: `place` is where they touch, from its centre of mass [m].
struct TouchedBody {
  int body;
  Vec3 place;
};

// Sums over contacts, in the order in which they are added.
class BodyPairs {
 public:
  void clear() { blocks_.clear(); }
  // slopes: as `one` sees them.
  void add(const TouchedBody& one, const TouchedBody& other, const ContactSlopes& slopes);
  // By bodies, the first one of a pair before the second.
  std::vector<PairStiffness> blocks() const;

 private:
  std::map<std::pair<int, int>, PairStiffness> blocks_;
};

}  // namespace scree
