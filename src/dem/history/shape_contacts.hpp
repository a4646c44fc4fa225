// Packed history of the contacts of bodies' shapes, for the next list or a file; on rank 0.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "dem/history/history_content.hpp"

namespace scree {

// The contacts that were closed at the last step, ordered by shape and key.
struct ShapeContacts {
  HistoryContent content = kNoHistory;
  std::vector<std::int64_t> shapes;  // number of the placed surface (SurfaceSet)
  std::vector<std::int64_t> keys;    // contact key: the partner is a shape or another surface, see
                                     // PackedHistory
  std::vector<Real> values;          // [contacts][width()]

  int width() const { return content.values; }
  // Number of contacts of a shape with the surface of this number.
  Index contacts_with(std::int64_t shape, Index surface) const;
  std::span<const Real> values_of(std::size_t contact) const {
    const auto n = static_cast<std::size_t>(width());
    return {values.data() + contact * n, n};
  }
  friend bool operator==(const ShapeContacts&, const ShapeContacts&) = default;
};

}  // namespace scree
