#include "dem/host/cpu_history.hpp"

#include <array>

namespace scree {

std::int64_t CpuHistory::neighbor_key(const Listed& at, Vec3 p, Index slot) const {
  const Index j = at.list.neighbors[slot];
  return row_key(id_of(at.store.row_key[j]), box_.image_relative_to(p, xyz(at.store.position[j])));
}

std::int64_t CpuHistory::surface_key(const Listed& at, Vec3 p, Index entry) const {
  const SurfaceRows& rows = at.list.surfaces;
  const Index s = rows.surfaces[entry];
  if (at.numbers.is_static(s)) return row_key(surface_id(s));
  const SurfacePose& surface = at.poses.placed[static_cast<std::size_t>(at.numbers.placed(s))];
  if (surface.kind == SurfaceKind::plane) return row_key(surface_id(s));  // planes have no images
  return row_key(surface_id(s), box_.image_relative_to(p, surface.point, rows.images[entry]));
}

std::int64_t CpuHistory::mesh_key(const Listed& at, Vec3 p, Index entry, GlobalId name) const {
  const SurfaceRows& rows = at.list.surfaces;
  const SurfacePose& surface =
      at.poses.placed[static_cast<std::size_t>(at.numbers.placed(rows.surfaces[entry]))];
  const SurfaceFrame& frame = at.poses.frames[static_cast<std::size_t>(surface.frame)];
  const PeriodicBox box = box_.without(frame.spanned);
  return row_key(name, box.image_relative_to(p, surface.point + frame.to_middle, rows.images[entry]));
}

InMeshFrame CpuHistory::in_mesh_frame(const Listed& at, Vec3 p, Index entry) const {
  const SurfaceRows& rows = at.list.surfaces;
  const SurfacePose& surface =
      at.poses.placed[static_cast<std::size_t>(at.numbers.placed(rows.surfaces[entry]))];
  const SurfaceFrame& frame = at.poses.frames[static_cast<std::size_t>(surface.frame)];
  return {at.poses.meshes[static_cast<std::size_t>(frame.mesh)], surface, frame, p,
          image_shift(rows.images[entry], box_.period)};
}

bool CpuHistory::is_mesh(const Listed& at, Index entry) const {
  const Index s = at.list.surfaces.surfaces[entry];
  return !at.numbers.is_static(s) &&
         at.poses.placed[static_cast<std::size_t>(at.numbers.placed(s))].kind == SurfaceKind::mesh;
}

HistoryViews CpuHistory::sides_only(std::vector<Index>& of, std::vector<Index>& ahead) {
  HistoryViews views;
  views.features = of.data(), views.next_features = ahead.data();
  return views;
}

HistoryViews CpuHistory::views() {
  if (!exists()) return {};
  if (sides_only()) return sides_only(features_, next_features_);
  return {neighbors_.data(), ground_.data(),        bodies_.data(), ahead_.data(),
          features_.data(),  next_features_.data(), step_};
}

HistoryViews CpuHistory::views_before() {
  if (!exists()) return {};
  if (sides_only()) return sides_only(next_features_, features_);
  return {nullptr,          nullptr,  ahead_.data(), bodies_.data(), next_features_.data(),
          features_.data(), step_ - 1};
}

PackedHistory CpuHistory::contacts(const Listed& at) const {
  if (!at_slots_) return packed_;
  PackedHistory out;
  out.numbers = numbers_;
  const auto add_if_closed = [&](const std::vector<Vec4>& records, Index slot, const auto& key) {
    if (!is_closed(records, slot)) return;
    const Vec4* const record = records.data() + first_record(slot);
    std::array<Real, kMostNumbers> values;
    for (int k = 0; k < numbers_; ++k) values[static_cast<std::size_t>(k)] = number_of(record, k);
    out.add(key(), {values.data(), static_cast<std::size_t>(out.width())});
  };
  const SurfaceRows& surfaces = at.list.surfaces;
  for (Index i = 0; i < at.store.owned; ++i) {
    const Vec3 p = xyz(at.store.position[i]);
    for (Index k = at.list.offsets[i]; k < at.list.offsets[i + 1] && !sides_only(); ++k)
      add_if_closed(neighbors_, k, [&] { return neighbor_key(at, p, k); });
    const auto first = static_cast<std::size_t>(std::ssize(out.keys));
    for (Index entry = surfaces.offsets[i]; entry < surfaces.offsets[i + 1]; ++entry)
      if (is_mesh(at, entry)) {
        add_if_closed(bodies_, entry, [&] {
          const GlobalId name = in_mesh_frame(at, p, entry).name(surfaces.surfaces[entry], features_[entry]);
          return mesh_key(at, p, entry, name);
        });
      } else if (!sides_only()) {
        add_if_closed(at.numbers.is_static(surfaces.surfaces[entry]) ? ground_ : bodies_, entry,
                      [&] { return surface_key(at, p, entry); });
      }
    if (!surfaces.groups.empty()) out.order_from(first);
    out.end_row();
  }
  return out;
}

void CpuHistory::pack_history(const Listed& at) {
  if (!at_slots_) return;
  packed_ = contacts(at);
  at_slots_ = false;
}

void CpuHistory::put(std::vector<Vec4>& records, Index slot, std::int64_t contact) const {
  Vec4* const to = records.data() + first_record(slot);
  const std::span<const Real> values = packed_.values_of(contact);
  for (int k = 0; k < numbers_; ++k) number_of(to, k) = values[static_cast<std::size_t>(k)];
  to->w = step_;
}

// The row and the packed history are both ordered by key: one pass over both.
void CpuHistory::unpack_row(const Listed& at, Index i) {
  std::int64_t k = packed_.offsets[static_cast<std::size_t>(i)];
  const std::int64_t end = packed_.offsets[static_cast<std::size_t>(i) + 1];
  const auto take = [&](std::vector<Vec4>& records, Index slot, const auto& key) {
    if (k == end) return;
    const std::int64_t sought = key();
    while (k < end && packed_.keys[static_cast<std::size_t>(k)] < sought) ++k;
    if (k < end && packed_.keys[static_cast<std::size_t>(k)] == sought) put(records, slot, k);
  };
  const SurfaceRows& surfaces = at.list.surfaces;
  const Vec3 p = xyz(at.store.position[i]);
  for (Index slot = at.list.offsets[i]; slot < at.list.offsets[i + 1] && !sides_only(); ++slot)
    take(neighbors_, slot, [&] { return neighbor_key(at, p, slot); });
  for (Index entry = surfaces.offsets[i]; entry < surfaces.offsets[i + 1]; ++entry)
    if (is_mesh(at, entry)) {
      if (entry == surfaces.offsets[i] || !surfaces.alike(entry - 1, entry)) unpack_mesh(at, i, entry);
    } else if (!sides_only()) {
      take(at.numbers.is_static(surfaces.surfaces[entry]) ? ground_ : bodies_, entry,
           [&] { return surface_key(at, p, entry); });
    }
}

// Unpacks the history of contacts of a particle with a mesh to the entries of their group. entry: the first
// of the group.
void CpuHistory::unpack_mesh(const Listed& at, Index i, Index entry) {
  const SurfaceRows& surfaces = at.list.surfaces;
  const Vec3 p = xyz(at.store.position[i]);
  const std::int64_t sought = mesh_key(at, p, entry, surface_id(surfaces.surfaces[entry]));
  Index slot = entry;
  for (std::int64_t k = packed_.offsets[static_cast<std::size_t>(i)];
       k < packed_.offsets[static_cast<std::size_t>(i) + 1]; ++k) {
    const std::int64_t key = packed_.keys[static_cast<std::size_t>(k)];
    if (!is_surface(key) || without_feature(key) != sought) continue;
    if (slot == surfaces.offsets[i + 1] || !surfaces.alike(entry, slot)) return;
    features_[slot] = in_mesh_frame(at, p, slot).stored_feature(key);
    if (!sides_only()) put(bodies_, slot, k);
    ++slot;
  }
}

void CpuHistory::unpack_history(const Listed& at) {
  if (!exists()) return;
  if (!sides_only()) neighbors_.assign(first_record(std::ssize(at.list.neighbors)), {});
  for (std::vector<Vec4>* of_surfaces : {&ground_, &bodies_, &ahead_})
    of_surfaces->assign(first_record(std::ssize(at.list.surfaces.surfaces)), {});
  for (std::vector<Index>* of_meshes : {&features_, &next_features_})
    of_meshes->assign(at.list.surfaces.groups.empty() ? 0 : at.list.surfaces.surfaces.size(), kNoFeature);
  for (Index i = 0; i < at.store.owned; ++i) unpack_row(at, i);
  packed_ = no_contacts(numbers_, 0);
  at_slots_ = true;
}

StoredContactCount CpuHistory::stored_contacts() const {
  if (!exists()) return {};
  return [this](Index i, Index surface) { return packed_.contacts_with(i, surface); };
}

void CpuHistory::load(const PackedHistory& contacts, Index owned) {
  if (!exists()) return;
  packed_ = contacts.numbers == numbers_ ? contacts : no_contacts(numbers_, owned);
  at_slots_ = false;
}

void CpuHistory::reorder(const std::vector<Index>& from) {
  if (exists()) packed_ = packed_.rows(from);
}

void CpuHistory::migrate(const Ranks& ranks, const std::vector<std::vector<Index>>& departing,
                         const std::vector<Index>& remaining) {
  if (!exists()) return;
  std::vector<PackedHistory> to;
  for (const std::vector<Index>& particles : departing) to.push_back(packed_.rows(particles));
  const PackedHistory arriving = all_to_all(ranks, to);
  reorder(remaining);
  for (std::int64_t i = 0; i < arriving.particles(); ++i) packed_.add_row(arriving, i);
}

}  // namespace scree
