// The contact history between two lists on the device: packing it from the records at the slots of the old
// list, and unpacking it to those of the new.
#pragma once

#include "dem/history/keyed_rows.hpp"
#include "device_list.cuh"
#include "packed_history_views.cuh"

namespace scree {

using DeviceKeyedRows = KeyedRows<SlicedRows>;

// Contacts per row, for the rows from `first` on.
struct CountClosedItem {
  DeviceKeyedRows rows;
  Index first;
  Index* counts;
  __device__ void operator()(Index k) const {
    Index count = 0;
    rows.for_each_closed(first + k, [&](const Vec4*, const auto&) { ++count; });
    counts[k] = count;
  }
};

struct PackHistoryItem {
  DeviceKeyedRows rows;
  Index first;
  PackedHistoryViews packed;
  __device__ void operator()(Index k) const {
    Index at = packed.offsets[k];
    rows.for_each_closed(first + k, [&](const Vec4* record, const auto& key) {
      packed.key(at) = key();
      Real* const to = packed.values(at);
      for (int n = 0; n < rows.numbers; ++n) to[n] = number_of(record, n);
      ++at;
    });
    sort_by_key(
        packed.offsets[k], at, [&](Index contact) { return packed.key(contact); },
        [&](Index a, Index b) { exchange_contacts(a, b); });
  }

 private:
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

struct UnpackHistoryItem {
  DeviceKeyedRows rows;
  PackedHistoryViews packed;
  const Index* row_of;
  __device__ void operator()(Index i) const {
    rows.unpack(i, packed, packed.offsets[row_of[i]], packed.offsets[row_of[i] + 1]);
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
