// The contact history between two lists on the device: packing it from the records at the slots of the old
// list, and unpacking it to those of the new.
#pragma once

#include "keyed_rows.cuh"
#include "packed_history_views.cuh"

namespace scree {

// Contacts per row, for the rows from `first` on.
struct CountClosedItem {
  KeyedRows keyed;
  Index first;
  Index* counts;
  __device__ void operator()(Index k) const {
    Index count = 0;
    keyed.visit(first + k,
                [&](const Vec4* record, const auto&) { count += record->w == keyed.history.step; });
    keyed.visit_meshes(first + k, [&](Index entry) { count += keyed.is_closed(entry); });
    counts[k] = count;
  }
};

struct PackHistoryItem {
  KeyedRows keyed;
  Index first;
  PackedHistoryViews packed;
  __device__ void operator()(Index k) const {
    const Index i = first + k;
    Index at = packed.offsets[k];
    const auto add = [&](const Vec4* record, std::int64_t key) {
      packed.key(at) = key;
      Real* const to = packed.values(at);
      for (int n = 0; n < keyed.numbers; ++n) to[n] = number_of(record, n);
      ++at;
    };
    keyed.visit(i, [&](const Vec4* record, const auto& key) {
      if (record->w == keyed.history.step) add(record, key());
    });
    const Vec3 p = xyz(keyed.position[i]);
    keyed.visit_meshes(i, [&](Index entry) {
      if (!keyed.is_closed(entry)) return;
      const GlobalId contact_id =
          keyed.in_mesh_frame(entry, p).name(keyed.surfaces.surfaces[entry], keyed.feature(entry));
      add(keyed.record_of(entry), keyed.mesh_key(entry, p, contact_id));
    });
    order(packed.offsets[k], at);
  }

 private:
  // Contacts with meshes may be unsorted: the list sorts them by distance, not by feature.
  __device__ void order(Index first, Index end) const {
    for (Index k = first + 1; k < end; ++k)
      for (Index at = k; at > first && packed.key(at - 1) > packed.key(at); --at) {
        exchange(packed.key(at - 1), packed.key(at));
        for (int v = 0; v < keyed.numbers; ++v) exchange(packed.values(at - 1)[v], packed.values(at)[v]);
      }
  }
  template <class T>
  __device__ static void exchange(T& a, T& b) {
    const T was = a;
    a = b, b = was;
  }
};

// Both the row and the packed history are sorted by key: one merge pass over both, then the meshes.
struct UnpackHistoryItem {
  KeyedRows keyed;
  PackedHistoryViews packed;
  const Index* row_of;
  __device__ void operator()(Index i) const {
    Index at = packed.offsets[row_of[i]];
    const Index end = packed.offsets[row_of[i] + 1];
    keyed.visit(i, [&](Vec4* record, const auto& key) {
      for (int r = 0; r < keyed.records; ++r) record[r] = {};
      if (at == end) return;
      const std::int64_t sought = key();
      while (at < end && packed.key(at) < sought) ++at;
      if (at < end && packed.key(at) == sought) put(record, at);
    });
    keyed.visit_meshes(i, [&](Index entry) {
      if (entry == keyed.surfaces.offsets[i] || !keyed.alike(entry - 1, entry)) unpack_mesh(i, entry);
    });
  }

 private:
  __device__ void put(Vec4* record, Index contact) const {
    const Real* const from = packed.values(contact);
    for (int k = 0; k < keyed.numbers; ++k) number_of(record, k) = from[k];
    if (keyed.records > 0) record->w = keyed.history.step;
  }
  // Copies the packed contacts of the particle with a mesh to the entries of their group, of which `entry` is
  // the first.
  __device__ void unpack_mesh(Index i, Index entry) const {
    const Vec3 p = xyz(keyed.position[i]);
    const InMeshFrame in_mesh = keyed.in_mesh_frame(entry, p);
    const std::int64_t sought = keyed.mesh_key(entry, p, surface_id(keyed.surfaces.surfaces[entry]));
    Index slot = entry;
    for (; slot < keyed.surfaces.offsets[i + 1] && keyed.alike(entry, slot); ++slot)
      for (int r = 0; r < keyed.records; ++r) keyed.record_of(slot)[r] = {};
    const Index last = slot;
    slot = entry;
    for (Index k = packed.offsets[row_of[i]]; k < packed.offsets[row_of[i] + 1] && slot < last; ++k) {
      const std::int64_t key = packed.key(k);
      if (!is_surface(key) || without_feature(key) != sought) continue;
      keyed.feature(slot) = in_mesh.stored_feature(key);
      put(keyed.record_of(slot++), k);
    }
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
