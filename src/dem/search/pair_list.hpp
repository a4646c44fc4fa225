// The pairs of a neighbour list, each once.
#pragma once

#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "dem/particles/particle_store.hpp"
#include "dem/search/neighbor_list.hpp"

namespace scree {

// An item in the row of an owned particle; with another owned one in the row of that which comes first.
struct ListedPair {
  Index j;
  Index slot;    // in the particle's row
  Index mirror;  // in the row of j; a ghost has none

  static constexpr Index kNone = -1;
  bool has_mirror() const { return mirror != kNone; }
};

struct PairList {
  bool is_current = false;     // whether it is of the list as it is
  std::vector<Index> offsets;  // [owned + 1], into the pairs
  std::vector<ListedPair> pairs;
  std::size_t slots = 0;  // of the list
  // What the contacts remember, per pair, while it is kept here and not at the slots (HistoryViews): of the
  // side of the row. The other side's is its mirror image, but for what stands at the mirror slot of the last
  // step.
  std::vector<Vec4> records;
  bool keeps_records = false;

  Index rows() const { return static_cast<Index>(offsets.size()) - 1; }
  void match(const NeighborList& list, const ParticleStore& store);
  // From the slots; count: of the records of a contact.
  void take_records(const Vec4* at_slots, Index count);
};

}  // namespace scree
