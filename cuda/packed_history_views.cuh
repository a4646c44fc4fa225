// Views of the packed contact history on the device.
#pragma once

#include <cstdint>
#include <limits>

#include "dem/history/contact_key.hpp"

namespace scree {

// Rows of contacts, in one part of memory or in several.
struct PackedHistoryViews {
  static constexpr int kParts = 4;
  struct Part {
    std::int64_t* keys = nullptr;
    Real* values = nullptr;
    // Range of the contacts in it; empty, past all, for an unused part.
    Index first = std::numeric_limits<Index>::max(), end = std::numeric_limits<Index>::max();

    std::size_t size() const { return static_cast<std::size_t>(end - first); }
  };
  const Index* offsets;  // [rows + 1]
  int numbers;           // values per contact
  Part part[kParts];     // in ascending order of contacts

  SCREE_HD std::int64_t& key(Index contact) const {
    const Part at = part_of(contact);
    return at.keys[contact - at.first];
  }
  SCREE_HD Real* values(Index contact) const {
    const Part at = part_of(contact);
    return at.values + std::int64_t{contact - at.first} * numbers;
  }

 private:
  SCREE_HD Part part_of(Index contact) const {
    Part at = part[0];
#ifdef __CUDA_ARCH__
#pragma unroll
#endif
    for (int k = 1; k < kParts; ++k)
      if (contact >= part[k].first) at = part[k];
    return at;
  }
};

// The packed row of a particle is row_of[particle]; null where contacts have no history.
struct StoredRows {
  PackedHistoryViews packed{};
  const Index* row_of = nullptr;

  // Number of contacts of the particle with a surface of that number.
  __device__ Index contacts_with(Index particle, Index surface) const {
    if (row_of == nullptr) return 0;
    const Index row = row_of[particle];
    Index count = 0;
    for (Index k = packed.offsets[row]; k < packed.offsets[row + 1]; ++k)
      count += is_with_surface(packed.key(k), surface);
    return count;
  }
};

}  // namespace scree
