// Where what is kept of contacts from one list to the next stands on the device.
#pragma once

#include <cstdint>
#include <limits>

#include "dem/history/history_slots.hpp"

namespace scree {

// Rows of contacts: those of all rows in one piece of memory, or in parts here and there.
struct KeptViews {
  static constexpr int kParts = 4;
  struct Part {
    std::int64_t* keys = nullptr;
    Real* values = nullptr;
    // Contacts; none of one that is not there.
    Index first = std::numeric_limits<Index>::max(), end = std::numeric_limits<Index>::max();

    std::size_t size() const { return static_cast<std::size_t>(end - first); }
  };
  const Index* offsets;  // [rows + 1]
  int numbers;           // per contact
  Part part[kParts];     // one after the other

  __device__ std::int64_t& key(Index contact) const {
    const Part at = part_of(contact);
    return at.keys[contact - at.first];
  }
  __device__ Real* values(Index contact) const {
    const Part at = part_of(contact);
    return at.values + std::int64_t{contact - at.first} * numbers;
  }

 private:
  __device__ Part part_of(Index contact) const {
    Part at = part[0];
#pragma unroll
    for (int k = 1; k < kParts; ++k)
      if (contact >= part[k].first) at = part[k];
    return at;
  }
};

// The row of a particle in between is row_of[particle]; null where no contact remembers.
struct RememberedRows {
  KeptViews kept{};
  const Index* row_of = nullptr;

  // How many contacts it has with the surface of a number.
  __device__ Index contacts_with(Index particle, Index surface) const {
    if (row_of == nullptr) return 0;
    const Index row = row_of[particle];
    Index count = 0;
    for (Index k = kept.offsets[row]; k < kept.offsets[row + 1]; ++k)
      count += is_surface(kept.key(k)) && surface_of(kept.key(k)) == surface;
    return count;
  }
};

}  // namespace scree
