#include <limits>
#include <string>

#include "base/countable.hpp"
#include "dem/backend/device.hpp"
#include "device_list.cuh"
#include "for_each.cuh"

namespace scree {

// Where the search writes its rows.
struct RowOutputs {
  std::int64_t* slice_start;
  Index *counts, *neighbors;
  Index* first_entry;           // null where entries need no numbers
  unsigned long long capacity;  // slots available
  DeviceList::Totals* totals;
};

namespace {

// The search keeps up to this many entries of a row in shared memory; longer rows use device memory, which is
// slower.
template <int kEntries>
struct RowBuffer {
  static constexpr int kThreads = kEntries <= 24 ? 128 : 64;
  std::int64_t key[kEntries][kThreads];
  Index neighbor[kEntries][kThreads];
};

// Calls visit(j) for every entry of row i, in the order of the cells.
template <class Visit>
__device__ void visit_row(const ListInput& in, Index i, const Visit& visit) {
  const Vec4 p = in.position[i];
  const CellGrid& cells = in.grid.cells.own;
  const CellIndex c = in.grid.cells.cell_index(xyz(p));
  if (c.x < 0) return;
  const auto in_range = [&](Index j) {
    const Vec4 q = in.position[j];
    const Vec3 d = xyz(p) - xyz(q);
    const Real range = p.w + q.w + in.skin;
    return dot(d, d) < range * range;
  };
  const Index x0 = max(c.x - 1, 0), x1 = min(c.x + 1, cells.cells[0] - 1);
  // Neighbouring cells in x of one cell block are contiguous: one range of items, or two where a cell block
  // ends.
  const Index split = min(x1 + 1, in.grid.next_block_start(x0));
  for (Index z = max(c.z - 1, 0); z <= min(c.z + 1, cells.cells[2] - 1); ++z)
    for (Index y = max(c.y - 1, 0); y <= min(c.y + 1, cells.cells[1] - 1); ++y) {
      const Index key = in.grid.key(x0, y, z), second = split <= x1 ? in.grid.key(split, y, z) : key;
      const auto visit_runs = [&](const Index* starts, const auto& item) {
        const Index begin = starts[key], length = starts[key + split - x0] - begin;
        const Index second_begin = starts[second],
                    all = length + starts[second + x1 + 1 - split] - second_begin;
        const auto at = [&](Index k) { return item(k < length ? begin + k : second_begin + k - length); };
        for (Index k = 0; k < all; k += 2) {  // two at once: independent loads hide latency
          const Index j[2] = {at(k), k + 1 < all ? at(k + 1) : at(k)};
          const bool second_in_range = in_range(j[1]),
                     hit[2] = {in_range(j[0]), second_in_range && k + 1 < all};
          if (hit[0] && j[0] != i) visit(j[0]);
          if (hit[1] && j[1] != i) visit(j[1]);
        }
      };
      visit_runs(in.particle_starts, [](Index k) { return k; });
      if (in.ghost_starts != nullptr) visit_runs(in.ghost_starts, [&](Index k) { return in.ghost_items[k]; });
    }
}

// The same for particles of many sizes, level by level, in the cells that the radius of i reaches.
template <class Visit>
__device__ void visit_row_by_level(const ListInput& in, Index i, const Visit& visit) {
  const Vec4 p = in.position[i];
  for (int k = 0; k < in.levels.count; ++k) {
    const LevelGrid& level = in.levels.levels[k];
    const CellGrid& grid = level.grid;
    const Index* starts = in.levels.starts + level.first_cell;
    if (starts[0] == starts[grid.cells[0] * grid.cells[1] * grid.cells[2]]) continue;  // no items
    const CellRange range = level.near(p, in.skin);
    for (Index z = range.lower.z; z <= range.upper.z; ++z)
      for (Index y = range.lower.y; y <= range.upper.y; ++y) {
        const Index end = starts[grid.index(range.upper.x, y, z) + 1];
        for (Index at = starts[grid.index(range.lower.x, y, z)]; at < end; ++at) {
          const Index j = in.levels.items[at];
          const Vec4 q = in.position[j];
          const Vec3 d = xyz(p) - xyz(q);
          const Real distance = p.w + q.w + in.skin;
          if (dot(d, d) < distance * distance && j != i) visit(j);
        }
      }
  }
}

template <bool kByLevel, class Visit>
__device__ void visit_entries(const ListInput& in, Index i, const Visit& visit) {
  if constexpr (kByLevel)
    visit_row_by_level(in, i, visit);
  else
    visit_row(in, i, visit);
}

// Heap sort by row_key of a row in device memory.
__device__ void sort_row(const std::int64_t* row_key, Index* row, Index n) {
  const auto at = [&](Index k) -> Index& { return row[static_cast<std::int64_t>(k) * kSlice]; };
  const auto sift = [&](Index root, Index end) {
    while (2 * root + 1 < end) {
      Index child = 2 * root + 1;
      if (child + 1 < end && row_key[at(child)] < row_key[at(child + 1)]) ++child;
      if (row_key[at(root)] >= row_key[at(child)]) return;
      const Index swapped = at(root);
      at(root) = at(child), at(child) = swapped;
      root = child;
    }
  };
  for (Index root = n / 2; root-- > 0;) sift(root, n);
  for (Index end = n; end-- > 1;) {
    const Index swapped = at(0);
    at(0) = at(end), at(end) = swapped;
    sift(0, end);
  }
}

// Finds row i, sorted in the thread's column of the buffer as far as it fits there; returns its length.
template <bool kByLevel, int kEntries>
__device__ Index find_row(const ListInput& in, Index i, RowBuffer<kEntries>& buffer) {
  const int column = static_cast<int>(threadIdx.x);
  Index found = 0;
  visit_entries<kByLevel>(in, i, [&](Index j) {
    if (found < kEntries) buffer.neighbor[found][column] = j;
    ++found;
  });
  // Sorted after the search, so that all threads of a warp sort together.
  const Index in_buffer = min(found, kEntries);
  for (Index k = 0; k < in_buffer; ++k) buffer.key[k][column] = in.row_key[buffer.neighbor[k][column]];
  for (Index k = 1; k < in_buffer; ++k) {
    const std::int64_t key = buffer.key[k][column];
    const Index neighbor = buffer.neighbor[k][column];
    Index to = k;
    for (; to > 0 && buffer.key[to - 1][column] > key; --to) {
      buffer.key[to][column] = buffer.key[to - 1][column];
      buffer.neighbor[to][column] = buffer.neighbor[to - 1][column];
    }
    buffer.key[to][column] = key, buffer.neighbor[to][column] = neighbor;
  }
  return found;
}

// Sum over the lower lanes of the warp.
__device__ Index sum_before(Index value) {
  const auto lane = static_cast<int>(threadIdx.x) % kSlice;
  Index sum = value;
  for (int step = 1; step < kSlice; step *= 2) {
    const Index other = __shfl_up_sync(~0u, sum, step);
    if (lane >= step) sum += other;
  }
  return sum - value;
}

template <bool kByLevel, int kEntries>
__global__ void __launch_bounds__(RowBuffer<kEntries>::kThreads)
    find_rows_kernel(const __grid_constant__ ListInput in, RowOutputs out) {
  __shared__ RowBuffer<kEntries> buffer;
  const Index i = thread_index(), lane = static_cast<Index>(threadIdx.x) % kSlice;
  const Index found = i < in.active ? find_row<kByLevel>(in, i, buffer) : 0;

  const auto width = static_cast<Index>(__reduce_max_sync(~0u, static_cast<unsigned>(found)));
  const auto sum = __reduce_add_sync(~0u, static_cast<unsigned>(found));
  unsigned long long start = 0, entries = 0;
  if (lane == 0) {
    start = atomicAdd(&out.totals->used, static_cast<unsigned long long>(width) * kSlice);
    entries = atomicAdd(&out.totals->entries, static_cast<unsigned long long>(sum));
    if (width > *static_cast<volatile Index*>(&out.totals->longest)) atomicMax(&out.totals->longest, width);
    if (i < in.owned) out.slice_start[i / kSlice] = static_cast<std::int64_t>(start);
  }
  start = __shfl_sync(~0u, start, 0);
  if (out.first_entry != nullptr) {
    const Index first = static_cast<Index>(__shfl_sync(~0u, entries, 0)) + sum_before(found);
    if (i < in.owned) out.first_entry[i] = first;
  }
  if (i >= in.owned) return;
  out.counts[i] = found;
  if (start + static_cast<unsigned long long>(width) * kSlice > out.capacity)
    return;  // too few slots: the host repeats the search
  Index* row = out.neighbors + start + lane;
  if (found <= kEntries) {
    for (Index k = 0; k < found; ++k)
      row[static_cast<std::int64_t>(k) * kSlice] = buffer.neighbor[k][threadIdx.x];
  } else {
    std::int64_t slot = 0;
    visit_entries<kByLevel>(in, i, [&](Index j) { row[slot] = j, slot += kSlice; });
    sort_row(in.row_key, row, found);
  }
}

// The longer the rows, the fewer of them a multiprocessor holds at once: 1,152, 768, 512, or 384.
constexpr int kRowLengths[] = {16, 24, 32, 48};

template <int kEntries>
void find_rows(Device device, const ListInput& in, const RowOutputs& out) {
  constexpr int kThreads = RowBuffer<kEntries>::kThreads;
  const auto kernel =
      in.levels.count > 0 ? find_rows_kernel<true, kEntries> : find_rows_kernel<false, kEntries>;
  kernel<<<blocks_for(in.owned, kThreads), kThreads, 0, device.stream>>>(in, out);
}

}  // namespace

DeviceList::DeviceList(bool has_history, double slots)
    : has_history_(has_history), slots_at_start_(slots), totals_(1), h_totals_(1) {
  h_totals_[0] = {};
}

Index* DeviceList::scratch_space(std::size_t n) {
  neighbors_.resize(std::max(neighbors_.size(), n));
  return neighbors_.data();
}

PrunedRows<0> DeviceList::pruned_rows() {
  pruned_counts_.resize(counts_.size());
  return {rows(), pruned_counts_.data(), pruned_.data(), RowUse::all, 0, entry_indices_.data()};
}

void DeviceList::queue(Device device, const ListInput& in) {
  const Index longest = h_totals_[0].longest;  // of the last list
  totals_.zero(device.stream);
  const RowOutputs out{slice_start_.data(), counts_.data(),    neighbors_.data(),
                       first_entry_.data(), neighbors_.size(), totals_.data()};
  if (longest <= kRowLengths[0])
    find_rows<kRowLengths[0]>(device, in, out);
  else if (longest <= kRowLengths[1])
    find_rows<kRowLengths[1]>(device, in, out);
  else if (longest <= kRowLengths[2])
    find_rows<kRowLengths[2]>(device, in, out);
  else
    find_rows<kRowLengths[3]>(device, in, out);
  require_cuda(cudaGetLastError(), "neighbour list");
  copy_async(h_totals_.data(), totals_.data(), 1, device.stream);
}

void DeviceList::search(Device device, const ListInput& in) {
  const auto owned = static_cast<std::size_t>(in.owned);
  const bool first = slice_start_.size() == 0;
  slice_start_.resize(owned / kSlice + 1), counts_.resize(owned),
      first_entry_.resize(has_history_ ? owned : 0);
  if (first) scratch_space(static_cast<std::size_t>(slots_at_start_ * static_cast<double>(owned)) + kSlice);
  h_totals_[0].entries = h_totals_[0].used = 0;
  if (in.owned > 0) queue(device, in);
}

void DeviceList::complete(Device device, const ListInput& in) {
  if (h_totals_[0].used > neighbors_.size()) {
    neighbors_.resize(static_cast<std::size_t>(kListSlack * static_cast<double>(h_totals_[0].used)));
    queue(device, in);
    wait_for(device.stream);
  }
  if (!has_history_) return;
  countable(h_totals_[0].entries, "stage neighbors: more neighbours");
  if (h_totals_[0].longest > std::numeric_limits<RowIndex>::max())
    throw SimulationError("stage neighbors: a particle with " + std::to_string(h_totals_[0].longest) +
                          " neighbours; with a contact history a particle can have at most " +
                          std::to_string(std::numeric_limits<RowIndex>::max()));
}

}  // namespace scree
