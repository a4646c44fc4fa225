// Rows of the neighbour list with contact history and contact keys: packing the history from the slots of a
// list, and unpacking it to the slots of the next list. Shared by the CPU and CUDA backends.
#pragma once

#include "dem/history/contact_key.hpp"
#include "dem/history/history_slots.hpp"
#include "dem/history/sheet_keys.hpp"
#include "dem/surfaces/surfaces.hpp"

namespace scree {

// Entries with surfaces in the rows of the particles.
struct SurfaceList {
  const Index *offsets, *surfaces;  // [particles + 1] first entry of each, [entries]
  const std::int8_t* images;        // [entries]
  const SurfacePose* placed;        // present poses
  const SurfaceFrame* frames;
  const MeshView* meshes;
  SurfaceNumbers numbers;
};

// A list with its history records, and the keys of its contacts. Rows: PackedRows or SlicedRows.
template <class Rows>
struct KeyedRows {
  const Vec4* position;
  const std::int64_t* row_keys;
  Rows rows;
  SurfaceList surfaces;
  PeriodicBox box;
  HistoryViews history;
  int numbers, records;  // per contact; records = 0: `kSidesOnly`

  // Calls visit(record, key) for the closed contacts of row i; key() is the packed contact key. Contacts with
  // meshes come last and may be unsorted: the list sorts them by distance, not by feature.
  SCREE_HD_CALLER
  template <class Visit>
  SCREE_HD void for_each_closed(Index i, const Visit& visit) const {
    const auto visit_closed = [&](Vec4* record, const auto& key) {
      if (record->w == history.step) visit(record, key);
    };
    for_each_neighbor_slot(i, visit_closed);
    for_each_closed_surface(i, visit);
  }
  // The same for the contacts with surfaces alone.
  SCREE_HD_CALLER
  template <class Visit>
  SCREE_HD void for_each_closed_surface(Index i, const Visit& visit) const {
    for_each_surface_slot(i, [&](Vec4* record, const auto& key) {
      if (record->w == history.step) visit(record, key);
    });
    const Vec3 p = xyz(position[i]);
    for_each_mesh_entry(i, [&](Index entry) {
      if (is_closed(entry)) visit(record_of(entry), [&] { return mesh_contact_key(entry, p); });
    });
  }

  // Copies the stored contacts from `first` to `end`, which belong to the particle of row i, to the slots of
  // the row. Both are sorted by key: one merge pass over both, then the meshes.
  SCREE_HD_CALLER
  template <class Stored, class Offset>
  SCREE_HD void unpack(Index i, const Stored& stored, Offset first, Offset end) const {
    Offset at = first;
    for_each_neighbor_slot(
        i, [&](Vec4* record, const auto& key) { at = unpack_slot(record, key, stored, at, end); });
    unpack_surfaces(i, stored, first, end);
  }
  // The same for the contacts with surfaces alone.
  SCREE_HD_CALLER
  template <class Stored, class Offset>
  SCREE_HD void unpack_surfaces(Index i, const Stored& stored, Offset first, Offset end) const {
    Offset at = first;
    for_each_surface_slot(
        i, [&](Vec4* record, const auto& key) { at = unpack_slot(record, key, stored, at, end); });
    for_each_mesh_entry(i, [&](Index entry) {
      if (entry == surfaces.offsets[i] || !alike(entry - 1, entry)) unpack_mesh(i, entry, stored, first, end);
    });
  }

  // Records of the entries of row i with particles, one after the other.
  SCREE_HD Vec4* neighbor_records(Index i) const {
    return history.neighbors + rows.first_number(i) * records;
  }
  // Packed contact key of a particle at p with item j.
  SCREE_HD std::int64_t neighbor_key(Index j, Vec3 p) const {
    return ContactKey::particle(id_of(row_keys[j]), box.image_relative_to(p, xyz(position[j]))).pack();
  }

 private:
  // Call visit(record, key) for the entries of row i with particles, and for those with surfaces except
  // meshes, in ascending order of key(), if there are records.
  SCREE_HD_CALLER
  template <class Visit>
  SCREE_HD void for_each_neighbor_slot(Index i, const Visit& visit) const {
    if (records == 0) return;
    const Vec3 p = xyz(position[i]);
    Vec4* record = neighbor_records(i);
    std::int64_t slot = rows.first(i);
    for (Index left = rows.count(i); left > 0; --left, slot += Rows::stride(), record += records)
      visit(record, [&] { return neighbor_key(rows.neighbors[slot], p); });
  }
  SCREE_HD_CALLER
  template <class Visit>
  SCREE_HD void for_each_surface_slot(Index i, const Visit& visit) const {
    if (records == 0) return;
    const Vec3 p = xyz(position[i]);
    for (Index entry = surfaces.offsets[i]; entry < surfaces.offsets[i + 1]; ++entry)
      if (!is_mesh(entry)) visit(record_of(entry), [&] { return surface_key(entry, p); });
  }
  // Calls visit(entry) for the entries of row i with meshes.
  SCREE_HD_CALLER
  template <class Visit>
  SCREE_HD void for_each_mesh_entry(Index i, const Visit& visit) const {
    for (Index entry = surfaces.offsets[i]; entry < surfaces.offsets[i + 1]; ++entry)
      if (is_mesh(entry)) visit(entry);
  }

  // Copies the contact with this key, if there is one from `at` on, to the record; returns where those with
  // larger keys begin.
  SCREE_HD_CALLER
  template <class Key, class Stored, class Offset>
  SCREE_HD Offset unpack_slot(Vec4* record, const Key& key, const Stored& stored, Offset at,
                              Offset end) const {
    clear(record);
    if (at == end) return at;
    const std::int64_t sought = key();
    while (at < end && stored.key(at) < sought) ++at;
    if (at < end && stored.key(at) == sought) put(stored, at, record);
    return at;
  }

  // Copies the stored contacts with a mesh to the entries of their group, of which `entry` is the first.
  template <class Stored, class Offset>
  SCREE_HD void unpack_mesh(Index i, Index entry, const Stored& stored, Offset first, Offset end) const {
    const Vec3 p = xyz(position[i]);
    const InMeshFrame in_mesh = in_mesh_frame(entry, p);
    const std::int64_t sought = mesh_key(entry, p).pack();
    Index slot = entry;
    for (; slot < surfaces.offsets[i + 1] && alike(entry, slot); ++slot) clear(record_of(slot));
    const Index last = slot;
    slot = entry;
    for (Offset k = first; k < end && slot < last; ++k) {
      const std::int64_t key = stored.key(k);
      if (!is_with_image(key, sought)) continue;
      history.features[slot] = in_mesh.stored_feature(key);
      put(stored, k, record_of(slot++));
    }
  }

  SCREE_HD void clear(Vec4* record) const {
    for (int r = 0; r < records; ++r) record[r] = {};
  }
  template <class Stored, class Offset>
  SCREE_HD void put(const Stored& stored, Offset contact, Vec4* record) const {
    const Real* const from = stored.values(contact);
    for (int k = 0; k < numbers; ++k) number_of(record, k) = from[k];
    if (records > 0) record->w = history.step;
  }

  SCREE_HD bool is_static(Index entry) const { return surfaces.numbers.is_static(surfaces.surfaces[entry]); }
  SCREE_HD bool is_mesh(Index entry) const {
    return !is_static(entry) && placed(entry).kind == SurfaceKind::mesh;
  }
  // entry: with a mesh.
  SCREE_HD bool is_closed(Index entry) const {
    return records > 0 ? record_of(entry)->w == history.step : history.features[entry] != kNoFeature;
  }
  // Whether two entries of a row belong to the same mesh and image.
  SCREE_HD bool alike(Index a, Index b) const {
    return surfaces.surfaces[a] == surfaces.surfaces[b] && surfaces.images[a] == surfaces.images[b];
  }
  SCREE_HD Vec4* record_of(Index entry) const {
    return (is_static(entry) ? history.ground : history.bodies) + std::int64_t{entry} * records;
  }
  SCREE_HD const SurfacePose& placed(Index entry) const {
    return surfaces.placed[surfaces.numbers.placed(surfaces.surfaces[entry])];
  }

  // Packed contact key of an entry with a surface in the row of a particle at p.
  SCREE_HD std::int64_t surface_key(Index entry, Vec3 p) const {
    const ContactKey key = ContactKey::surface(surfaces.surfaces[entry]);
    if (is_static(entry) || placed(entry).kind == SurfaceKind::plane) return key.pack();  // have no images
    return row_key(key.partner(), box.image_relative_to(p, placed(entry).point, surfaces.images[entry]));
  }
  // Contact key with feature 0 and not penetrated.
  SCREE_HD ContactKey mesh_key(Index entry, Vec3 p) const {
    const SurfacePose& surface = placed(entry);
    const SurfaceFrame& frame = surfaces.frames[surface.frame];
    const PeriodicBox of = box.without(frame.spanned);
    return ContactKey::surface(
        surfaces.surfaces[entry],
        of.image_relative_to(p, surface.point + frame.to_middle, surfaces.images[entry]));
  }
  SCREE_HD std::int64_t mesh_contact_key(Index entry, Vec3 p) const {
    return in_mesh_frame(entry, p).key_at(mesh_key(entry, p), history.features[entry]).pack();
  }
  SCREE_HD InMeshFrame in_mesh_frame(Index entry, Vec3 p) const {
    const SurfaceFrame& frame = surfaces.frames[placed(entry).frame];
    return {surfaces.meshes[frame.mesh], placed(entry), frame, p,
            image_shift(surfaces.images[entry], box.period)};
  }
};

}  // namespace scree
