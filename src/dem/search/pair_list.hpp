// The pairs of a neighbour list, each once.
#pragma once

#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "dem/particles/particle_store.hpp"
#include "dem/search/list_rows.hpp"

namespace scree {

// An entry of an owned particle's row; a pair of owned particles belongs to the row that comes first.
struct ListedPair {
  Index j;
  Index slot;    // in the particle's row
  Index mirror;  // in the row of j; none for a ghost

  static constexpr Index kNone = -1;
  bool has_mirror() const { return mirror != kNone; }
};

struct PairList {
  bool is_current = false;     // whether it matches the current list
  std::vector<Index> offsets;  // [owned + 1], into the pairs
  std::vector<ListedPair> pairs;
  std::size_t slots = 0;  // of the list
  // History per pair, while it is stored here and not at the slots (`HistoryViews`), as the particle of the
  // row has it. The other particle's is its mirror image, unless the mirror slot has a record of the last
  // step.
  std::vector<Vec4> records;
  bool has_records = false;

  Index rows() const { return static_cast<Index>(offsets.size()) - 1; }
  void match(const NeighborList& list, const ParticleStore& store);
  // Copies the history from the slots; count: records per contact.
  void fetch_records(const Vec4* at_slots, Index count);
};

}  // namespace scree
