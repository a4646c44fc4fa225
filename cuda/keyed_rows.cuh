// Contact history at the slots of a list on the device, with the keys of its contacts.
#pragma once

#include "dem/history/history_slots.hpp"
#include "dem/history/sheet_keys.hpp"
#include "dem/particles/particle_fields.hpp"
#include "device_list.cuh"
#include "device_surfaces.cuh"

namespace scree {

// A list with its history records, and the keys of its contacts.
struct KeyedRows {
  const Vec4* position;
  const std::int64_t* row_keys;
  SlicedRows rows;
  SurfaceList surfaces;
  PeriodicBox box;
  HistoryViews history;
  int numbers, records;  // per contact; records = 0: `kSidesOnly`

  // Calls visit(record, key) for the contacts of row i except those with meshes, in ascending order of key(),
  // the contact key.
  template <class Visit>
  __device__ void visit(Index i, const Visit& visit) const {
    if (records == 0) return;
    const Vec3 p = xyz(position[i]);
    Vec4* record = history.neighbors + std::int64_t{rows.first_entry[i]} * records;
    std::int64_t slot = rows.first(i);
    for (Index left = rows.counts[i]; left > 0; --left, slot += kSlice, record += records)
      visit(record, [&] {
        const Index j = rows.neighbors[slot];
        return row_key(id_of(row_keys[j]), box.image_relative_to(p, xyz(position[j])));
      });
    for (Index entry = surfaces.offsets[i]; entry < surfaces.offsets[i + 1]; ++entry)
      if (!is_mesh(entry)) visit(record_of(entry), [&] { return surface_key(entry, p); });
  }
  // Calls visit(entry) for the entries with meshes.
  template <class Visit>
  __device__ void visit_meshes(Index i, const Visit& visit) const {
    for (Index entry = surfaces.offsets[i]; entry < surfaces.offsets[i + 1]; ++entry)
      if (is_mesh(entry)) visit(entry);
  }

  __device__ Vec4* record_of(Index entry) const {
    const bool is_static = surfaces.numbers.is_static(surfaces.surfaces[entry]);
    return (is_static ? history.ground : history.bodies) + std::int64_t{entry} * records;
  }
  // entry: with a mesh.
  __device__ bool is_closed(Index entry) const {
    return records > 0 ? record_of(entry)->w == history.step : feature(entry) != kNoFeature;
  }
  __device__ bool is_mesh(Index entry) const {
    return !surfaces.numbers.is_static(surfaces.surfaces[entry]) && placed(entry).kind == SurfaceKind::mesh;
  }
  __device__ const SurfacePose& placed(Index entry) const {
    return surfaces.placed[surfaces.numbers.placed(surfaces.surfaces[entry])];
  }
  __device__ Index& feature(Index entry) const { return history.features[entry]; }
  __device__ std::int64_t surface_key(Index entry, Vec3 p) const {
    const Index s = surfaces.surfaces[entry];
    if (surfaces.numbers.is_static(s)) return row_key(surface_id(s));
    if (placed(entry).kind == SurfaceKind::plane) return row_key(surface_id(s));  // a plane has no images
    return row_key(surface_id(s), box.image_relative_to(p, placed(entry).point, surfaces.images[entry]));
  }
  __device__ std::int64_t mesh_key(Index entry, Vec3 p, GlobalId contact_id) const {
    const SurfacePose& surface = placed(entry);
    const SurfaceFrame& frame = surfaces.frames[surface.frame];
    const PeriodicBox of = box.without(frame.spanned);
    return row_key(contact_id,
                   of.image_relative_to(p, surface.point + frame.to_middle, surfaces.images[entry]));
  }
  __device__ InMeshFrame in_mesh_frame(Index entry, Vec3 p) const {
    const SurfaceFrame& frame = surfaces.frames[placed(entry).frame];
    return {surfaces.meshes[frame.mesh], placed(entry), frame, p,
            image_shift(surfaces.images[entry], box.period)};
  }
  // Whether two entries of a row belong to the same mesh and image.
  __device__ bool alike(Index a, Index b) const {
    return surfaces.surfaces[a] == surfaces.surfaces[b] && surfaces.images[a] == surfaces.images[b];
  }
};

}  // namespace scree
