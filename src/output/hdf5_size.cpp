#include "output/hdf5_size.hpp"

#include <cmath>

namespace scree {
namespace {

// Size of an object header: 272 B, or more if the texts of its attributes do not fit; measured [B].
constexpr Real kHeader = 272, kLabelledHeader = 310;

Real rounded_up(Real count) { return std::ceil(count * (1 - 1e-12)); }

}  // namespace

void Hdf5Size::add_rows(const RowStorage& storage, std::int64_t value_bytes, std::int64_t rows) {
  const auto row_bytes = static_cast<Real>(storage.width * value_bytes);
  bytes_ += kLabelledHeader;
  if (storage.fixed_rows >= 0) {
    bytes_ += static_cast<Real>(rows) * row_bytes;
    return;
  }
  const std::int64_t chunks = (rows + storage.chunk_rows - 1) / storage.chunk_rows;
  if (chunks == 0) return;
  bytes_ += static_cast<Real>(chunks) * static_cast<Real>(storage.chunk_rows) * row_bytes;
  // Nodes of the index, each with up to 2 K chunks or child nodes, 90 % full.
  const auto width = static_cast<Real>(2 * chunk_index_width(likely_chunks_));
  const Real key = storage.width == 1 ? 24 : 32, node = 24 + (width + 1) * key + width * 8;
  Real on_level = static_cast<Real>(chunks);
  do {
    on_level = on_level <= width ? 1 : rounded_up(on_level / (0.9 * width));
    bytes_ += on_level * node;
  } while (on_level > 1);
}

void Hdf5Size::add_array(std::int64_t bytes) {
  bytes_ += kHeader + 8 * rounded_up(static_cast<Real>(bytes) / 8);
}

// A header, a heap of names, and leaves of up to eight names below B-tree nodes of up to 32 leaves.
void Hdf5Size::add_group(std::int64_t names) {
  constexpr Real kGroup = 40 + 120, kLeaf = 328, kNode = 544, kName = 16, kNamesOfLeaf = 5.5,
                 kLeavesOfNode = 22;
  const Real leaves = rounded_up(static_cast<Real>(names) / (names <= 8 ? 8 : kNamesOfLeaf));
  bytes_ += kGroup + kName * static_cast<Real>(names) + kLeaf * leaves +
            kNode * rounded_up(leaves <= 32 ? 1 : leaves / kLeavesOfNode * 1.05);
}

}  // namespace scree
