// The contact history between two lists on the device: packing it from the records at the slots of the old
// list, and unpacking it to those of the new.
#pragma once

#include "dem/history/keyed_rows.hpp"
#include "device_list.cuh"
#include "for_each.cuh"
#include "packed_history_views.cuh"

namespace scree {

using DeviceKeyedRows = KeyedRows<SlicedRows>;

// The lanes that take a row together, entry by entry: neighbouring lanes read and write neighbouring records.
struct RowLanes {
  static constexpr Index kCount = 8;  // rows have about ten entries

  __device__ static Index own() { return static_cast<Index>(threadIdx.x % kCount); }
  __device__ static bool is_first() { return own() == 0; }
  // Lanes for which it holds, as bits from 0 on.
  __device__ static unsigned where(bool holds) { return __ballot_sync(all(), holds) >> shift(); }
  template <class T>
  __device__ static T of(Index lane, T value) {
    return __shfl_sync(all(), value, lane, kCount);
  }
  __device__ static Index sum(Index value) {
    for (int across = kCount / 2; across > 0; across /= 2)
      value += __shfl_xor_sync(all(), value, across, kCount);
    return value;
  }
  // What the other lanes have written is visible afterwards.
  __device__ static void sync() { __syncwarp(all()); }

 private:
  __device__ static unsigned shift() { return threadIdx.x % 32 / kCount * kCount; }
  __device__ static unsigned all() { return ((1u << kCount) - 1) << shift(); }
};

template <class Item>
__global__ void for_each_row_kernel(Index rows, const Item item) {
  const std::int64_t thread = std::int64_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (const auto row = static_cast<Index>(thread / RowLanes::kCount); row < rows) item(row);
}

// Calls item(row) in all lanes of a row, for row = 0 ... rows - 1.
template <class Item>
void for_each_row(Device device, Index rows, const Item& item) {
  if (rows <= 0) return;
  for_each_row_kernel<<<blocks_for(std::int64_t{rows} * RowLanes::kCount), launches().block, 0,
                        device.stream>>>(rows, item);
  require_cuda(cudaGetLastError(), "contact history");
}

// Contacts per row, for the rows from `first` on.
struct CountClosedItem {
  DeviceKeyedRows rows;
  Index first;
  Index* counts;
  __device__ void operator()(Index k) const {
    Index count = 0;
    if (rows.records > 0) {
      const Vec4* const records = rows.neighbor_records(first + k);
      const Index entries = rows.rows.count(first + k);
      for (Index entry = RowLanes::own(); entry < entries; entry += RowLanes::kCount)
        count += records[entry * rows.records].w == rows.history.step;
    }
    count = RowLanes::sum(count);
    if (!RowLanes::is_first()) return;
    rows.for_each_closed_surface(first + k, [&](const Vec4*, const auto&) { ++count; });
    counts[k] = count;
  }
};

struct PackHistoryItem {
  DeviceKeyedRows rows;
  Index first;
  PackedHistoryViews packed;

  __device__ void operator()(Index k) const {
    RowEnd end{packed.offsets[k]};
    if (rows.records > 0) pack_neighbors(first + k, end);
    if (RowLanes::is_first())
      rows.for_each_closed_surface(first + k, [&](const Vec4* record, const auto& key) {
        const std::int64_t of_surface = key();
        end.in_order = end.in_order && end.key < of_surface, end.key = of_surface;
        put(end.at++, of_surface, record);
      });
    // Contacts with meshes may be out of order.
    if (RowLanes::where(!end.in_order) == 0) return;
    RowLanes::sync();
    if (RowLanes::is_first())
      sort_by_key(
          packed.offsets[k], end.at, [&](Index contact) { return packed.key(contact); },
          [&](Index a, Index b) { exchange_contacts(a, b); });
  }

 private:
  // What has been packed of a row: its end, the last key, and whether the lane's keys were in order.
  struct RowEnd {
    Index at;
    std::int64_t key = -1;
    bool in_order = true;
  };
  __device__ void pack_neighbors(Index i, RowEnd& end) const {
    const Vec3 p = xyz(rows.position[i]);
    const Vec4* const records = rows.neighbor_records(i);
    const Index* const neighbors = rows.rows.neighbors + rows.rows.first(i);
    const Index entries = rows.rows.count(i);
    for (Index begin = 0; begin < entries; begin += RowLanes::kCount) {
      const Index entry = begin + RowLanes::own();
      const Vec4* const record = records + entry * rows.records;
      const bool closed = entry < entries && record->w == rows.history.step;
      const unsigned all = RowLanes::where(closed), before = all & ((1u << RowLanes::own()) - 1);
      if (all == 0) continue;
      const std::int64_t key = closed ? rows.neighbor_key(neighbors[entry * kSlice], p) : 0;
      const std::int64_t previous = RowLanes::of(before != 0 ? last_of(before) : 0, key);
      if (closed) {
        end.in_order = end.in_order && (before != 0 ? previous : end.key) < key;
        put(end.at + __popc(before), key, record);
      }
      end.at += __popc(all), end.key = RowLanes::of(last_of(all), key);
    }
  }
  __device__ static Index last_of(unsigned lanes) { return 31 - __clz(static_cast<int>(lanes)); }

  __device__ void put(Index contact, std::int64_t key, const Vec4* record) const {
    packed.key(contact) = key;
    Real* const to = packed.values(contact);
    for (int n = 0; n < rows.numbers; ++n) to[n] = number_of(record, n);
  }
  __device__ void exchange_contacts(Index a, Index b) const {
    exchange(packed.key(a), packed.key(b));
    for (int v = 0; v < rows.numbers; ++v) exchange(packed.values(a)[v], packed.values(b)[v]);
  }
  template <class T>
  __device__ static void exchange(T& a, T& b) {
    const T was = a;
    a = b, b = was;
  }
};

// Each lane seeks the contact of its entry among those stored, which are few.
struct UnpackHistoryItem {
  DeviceKeyedRows rows;
  PackedHistoryViews packed;
  const Index* row_of;

  __device__ void operator()(Index i) const {
    const Index row = row_of[i], first = packed.offsets[row], end = packed.offsets[row + 1];
    if (rows.records > 0) unpack_neighbors(i, first, end);
    if (RowLanes::is_first()) rows.unpack_surfaces(i, packed, first, end);
  }

 private:
  __device__ void unpack_neighbors(Index i, Index first, Index end) const {
    const Vec3 p = xyz(rows.position[i]);
    Vec4* const records = rows.neighbor_records(i);
    const Index* const neighbors = rows.rows.neighbors + rows.rows.first(i);
    const Index entries = rows.rows.count(i);
    for (Index entry = RowLanes::own(); entry < entries; entry += RowLanes::kCount) {
      Vec4 record[kMostRecords]{};
      if (first < end) find(rows.neighbor_key(neighbors[entry * kSlice], p), first, end, record);
      for (int r = 0; r < rows.records; ++r) records[entry * rows.records + r] = record[r];
    }
  }
  __device__ void find(std::int64_t key, Index first, Index end, Vec4* record) const {
    Index at = first;
    while (at < end && packed.key(at) < key) ++at;
    if (at == end || packed.key(at) != key) return;
    const Real* const from = packed.values(at);
#pragma unroll
    for (int n = 0; n < kMostNumbers; ++n)
      if (n < rows.numbers) number_of(record, n) = from[n];
    record->w = rows.history.step;
  }
};

// Copies contact k from one place to another.
struct CopyContactItem {
  PackedHistoryViews from, to;
  __device__ void operator()(Index k) const {
    to.key(k) = from.key(k);
    for (int v = 0; v < from.numbers; ++v) to.values(k)[v] = from.values(k)[v];
  }
};

struct RowLengthItem {
  const Index *offsets, *row_of, *particles;
  Index* counts;
  SCREE_HD void operator()(Index k) const {
    const Index row = row_of[particles[k]];
    counts[k] = offsets[row + 1] - offsets[row];
  }
};

struct CopyRowItem {
  PackedHistoryViews from;
  const Index *row_of, *particles;
  PackedHistoryViews to;
  __device__ void operator()(Index k) const {
    const Index row = row_of[particles[k]], end = from.offsets[row + 1];
    Index at = to.offsets[k];
    for (Index contact = from.offsets[row]; contact < end; ++contact, ++at) {
      to.key(at) = from.key(contact);
      for (int v = 0; v < from.numbers; ++v) to.values(at)[v] = from.values(contact)[v];
    }
  }
};

}  // namespace scree
