// Row keys: the id of a partner and the number of its periodic image in one integer.
#pragma once

#include <cstdint>

#include "base/hd.hpp"
#include "base/types.hpp"
#include "partition/halo_plan.hpp"

namespace scree {

inline constexpr int kImages = 27;  // shifts by at most one period per axis; `kZeroShift` is the middle one

// Key that orders the entries of a neighbour list's row, by global id and then by image, independent of local
// indices. Surfaces have ids as partners as well (dem/history/contact_key.hpp).
SCREE_HD std::int64_t row_key(GlobalId id, std::int8_t image = kZeroShift) { return id * kImages + image; }
SCREE_HD GlobalId id_of(std::int64_t row_key) { return row_key / kImages; }
SCREE_HD std::int8_t image_of(std::int64_t row_key) { return static_cast<std::int8_t>(row_key % kImages); }

}  // namespace scree
