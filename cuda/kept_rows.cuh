// The contact history between two lists on the device: packing it from the records at the slots of the old
// list, and unpacking it to those of the new.
#pragma once

#include "kept_views.cuh"
#include "named_rows.cuh"

namespace scree {

// Contacts per row, for the rows from `first` on.
struct CountClosedItem {
  NamedRows names;
  Index first;
  Index* counts;
  __device__ void operator()(Index k) const {
    Index count = 0;
    names.visit(first + k,
                [&](const Vec4* record, const auto&) { count += record->w == names.history.step; });
    names.visit_meshes(first + k, [&](Index entry) { count += names.is_closed(entry); });
    counts[k] = count;
  }
};

struct KeepItem {
  NamedRows names;
  Index first;
  KeptViews kept;
  __device__ void operator()(Index k) const {
    const Index i = first + k;
    Index at = kept.offsets[k];
    const auto add = [&](const Vec4* record, std::int64_t key) {
      kept.key(at) = key;
      Real* const to = kept.values(at);
      for (int n = 0; n < names.numbers; ++n) to[n] = number_of(record, n);
      ++at;
    };
    names.visit(i, [&](const Vec4* record, const auto& key) {
      if (record->w == names.history.step) add(record, key());
    });
    const Vec3 p = xyz(names.position[i]);
    names.visit_meshes(i, [&](Index entry) {
      if (!names.is_closed(entry)) return;
      const GlobalId name =
          names.beside_mesh(entry, p).name(names.surfaces.surfaces[entry], names.feature(entry));
      add(names.record_of(entry), names.mesh_key(entry, p, name));
    });
    order(kept.offsets[k], at);
  }

 private:
  // Contacts with meshes may be unsorted: the list sorts them by distance, not by feature.
  __device__ void order(Index first, Index end) const {
    for (Index k = first + 1; k < end; ++k)
      for (Index at = k; at > first && kept.key(at - 1) > kept.key(at); --at) {
        exchange(kept.key(at - 1), kept.key(at));
        for (int v = 0; v < names.numbers; ++v) exchange(kept.values(at - 1)[v], kept.values(at)[v]);
      }
  }
  template <class T>
  __device__ static void exchange(T& a, T& b) {
    const T was = a;
    a = b, b = was;
  }
};

// Both the row and the packed history are sorted by key: one merge pass over both, then the meshes.
struct TakeItem {
  NamedRows names;
  KeptViews kept;
  const Index* row_of;
  __device__ void operator()(Index i) const {
    Index at = kept.offsets[row_of[i]];
    const Index end = kept.offsets[row_of[i] + 1];
    names.visit(i, [&](Vec4* record, const auto& key) {
      for (int r = 0; r < names.records; ++r) record[r] = {};
      if (at == end) return;
      const std::int64_t wanted = key();
      while (at < end && kept.key(at) < wanted) ++at;
      if (at < end && kept.key(at) == wanted) put(record, at);
    });
    names.visit_meshes(i, [&](Index entry) {
      if (entry == names.surfaces.offsets[i] || !names.alike(entry - 1, entry)) take_mesh(i, entry);
    });
  }

 private:
  __device__ void put(Vec4* record, Index contact) const {
    const Real* const from = kept.values(contact);
    for (int k = 0; k < names.numbers; ++k) number_of(record, k) = from[k];
    if (names.records > 0) record->w = names.history.step;
  }
  // Copies the packed contacts of the particle with a mesh to the entries of their group, of which `entry` is
  // the first.
  __device__ void take_mesh(Index i, Index entry) const {
    const Vec3 p = xyz(names.position[i]);
    const BesideMesh beside = names.beside_mesh(entry, p);
    const std::int64_t wanted = names.mesh_key(entry, p, surface_id(names.surfaces.surfaces[entry]));
    Index slot = entry;
    for (; slot < names.surfaces.offsets[i + 1] && names.alike(entry, slot); ++slot)
      for (int r = 0; r < names.records; ++r) names.record_of(slot)[r] = {};
    const Index last = slot;
    slot = entry;
    for (Index k = kept.offsets[row_of[i]]; k < kept.offsets[row_of[i] + 1] && slot < last; ++k) {
      const std::int64_t key = kept.key(k);
      if (!is_surface(key) || without_feature(key) != wanted) continue;
      names.feature(slot) = beside.remembered(key);
      put(names.record_of(slot++), k);
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
  KeptViews from;
  const Index *row_of, *particles;
  KeptViews to;
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
