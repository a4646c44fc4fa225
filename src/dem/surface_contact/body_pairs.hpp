// Off-diagonal blocks of the Newton matrix for two bodies in contact, over an implicit step.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "dem/surface_contact/body_items.hpp"
#include "model/data/body_exchange.hpp"

namespace scree {

// A body at a contact. arm: contact point relative to its centre of mass [m].
struct TouchedBody {
  int body;
  Vec3 arm;
};

// Blocks summed over contacts, in the order in which they are added.
class BodyPairs {
 public:
  void clear() { blocks_.clear(); }
  // slopes: from the side of `one`.
  void add(const TouchedBody& one, const TouchedBody& other, const ContactSlopes& slopes);
  // Blocks ordered by bodies, the lower number of a pair first.
  std::vector<PairStiffness> blocks() const;

 private:
  std::map<std::pair<int, int>, PairStiffness> blocks_;
};

}  // namespace scree
