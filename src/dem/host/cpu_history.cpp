#include "dem/host/cpu_history.hpp"

#include <array>

namespace scree {

std::int64_t CpuHistory::neighbor_key(const Listed& at, Vec3 p, Index slot) const {
  const Index j = at.list.neighbors[slot];
  return row_key(id_of(at.store.row_key[j]), box_.image_beside(p, xyz(at.store.position[j])));
}

std::int64_t CpuHistory::surface_key(const Listed& at, Vec3 p, Index entry) const {
  const SurfaceRows& rows = at.list.surfaces;
  const Index s = rows.surfaces[entry];
  if (at.numbers.at_rest(s)) return row_key(surface_id(s));
  const PlacedSurface& surface = at.places.placed[static_cast<std::size_t>(at.numbers.placed(s))];
  if (surface.kind == SurfaceKind::plane) return row_key(surface_id(s));  // planes have no images
  return row_key(surface_id(s), box_.image_beside(p, surface.point, rows.images[entry]));
}

std::int64_t CpuHistory::mesh_key(const Listed& at, Vec3 p, Index entry, GlobalId name) const {
  const SurfaceRows& rows = at.list.surfaces;
  const PlacedSurface& surface =
      at.places.placed[static_cast<std::size_t>(at.numbers.placed(rows.surfaces[entry]))];
  const SurfaceFrame& frame = at.places.frames[static_cast<std::size_t>(surface.frame)];
  const PeriodicBox box = box_.without(frame.spanned);
  return row_key(name, box.image_beside(p, surface.point + frame.to_middle, rows.images[entry]));
}

BesideMesh CpuHistory::beside_mesh(const Listed& at, Vec3 p, Index entry) const {
  const SurfaceRows& rows = at.list.surfaces;
  const PlacedSurface& surface =
      at.places.placed[static_cast<std::size_t>(at.numbers.placed(rows.surfaces[entry]))];
  const SurfaceFrame& frame = at.places.frames[static_cast<std::size_t>(surface.frame)];
  return {at.places.meshes[static_cast<std::size_t>(frame.mesh)], surface, frame, p,
          image_shift(rows.images[entry], box_.period)};
}

bool CpuHistory::is_mesh(const Listed& at, Index entry) const {
  const Index s = at.list.surfaces.surfaces[entry];
  return !at.numbers.at_rest(s) &&
         at.places.placed[static_cast<std::size_t>(at.numbers.placed(s))].kind == SurfaceKind::mesh;
}

HistoryViews CpuHistory::sides_alone(std::vector<Index>& of, std::vector<Index>& ahead) {
  HistoryViews views;
  views.features = of.data(), views.features_ahead = ahead.data();
  return views;
}

HistoryViews CpuHistory::views() {
  if (!exists()) return {};
  if (is_alone()) return sides_alone(features_, features_ahead_);
  return {neighbors_.data(), ground_.data(),         bodies_.data(), ahead_.data(),
          features_.data(),  features_ahead_.data(), step_};
}

HistoryViews CpuHistory::views_before() {
  if (!exists()) return {};
  if (is_alone()) return sides_alone(features_ahead_, features_);
  return {nullptr,          nullptr,  ahead_.data(), bodies_.data(), features_ahead_.data(),
          features_.data(), step_ - 1};
}

KeptContacts CpuHistory::contacts(const Listed& at) const {
  if (!at_slots_) return kept_;
  KeptContacts out;
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
    for (Index k = at.list.offsets[i]; k < at.list.offsets[i + 1] && !is_alone(); ++k)
      add_if_closed(neighbors_, k, [&] { return neighbor_key(at, p, k); });
    const auto first = static_cast<std::size_t>(std::ssize(out.keys));
    for (Index entry = surfaces.offsets[i]; entry < surfaces.offsets[i + 1]; ++entry)
      if (is_mesh(at, entry)) {
        add_if_closed(bodies_, entry, [&] {
          const GlobalId name = beside_mesh(at, p, entry).name(surfaces.surfaces[entry], features_[entry]);
          return mesh_key(at, p, entry, name);
        });
      } else if (!is_alone()) {
        add_if_closed(at.numbers.at_rest(surfaces.surfaces[entry]) ? ground_ : bodies_, entry,
                      [&] { return surface_key(at, p, entry); });
      }
    if (!surfaces.groups.empty()) out.order_from(first);
    out.end_row();
  }
  return out;
}

void CpuHistory::leave_slots(const Listed& at) {
  if (!at_slots_) return;
  kept_ = contacts(at);
  at_slots_ = false;
}

void CpuHistory::put(std::vector<Vec4>& records, Index slot, std::int64_t contact) const {
  Vec4* const to = records.data() + first_record(slot);
  const std::span<const Real> values = kept_.values_of(contact);
  for (int k = 0; k < numbers_; ++k) number_of(to, k) = values[static_cast<std::size_t>(k)];
  to->w = step_;
}

// The row and the packed history are both ordered by key: one pass over both.
void CpuHistory::take_row(const Listed& at, Index i) {
  std::int64_t k = kept_.offsets[static_cast<std::size_t>(i)];
  const std::int64_t end = kept_.offsets[static_cast<std::size_t>(i) + 1];
  const auto take = [&](std::vector<Vec4>& records, Index slot, const auto& key) {
    if (k == end) return;
    const std::int64_t sought = key();
    while (k < end && kept_.keys[static_cast<std::size_t>(k)] < sought) ++k;
    if (k < end && kept_.keys[static_cast<std::size_t>(k)] == sought) put(records, slot, k);
  };
  const SurfaceRows& surfaces = at.list.surfaces;
  const Vec3 p = xyz(at.store.position[i]);
  for (Index slot = at.list.offsets[i]; slot < at.list.offsets[i + 1] && !is_alone(); ++slot)
    take(neighbors_, slot, [&] { return neighbor_key(at, p, slot); });
  for (Index entry = surfaces.offsets[i]; entry < surfaces.offsets[i + 1]; ++entry)
    if (is_mesh(at, entry)) {
      if (entry == surfaces.offsets[i] || !surfaces.alike(entry - 1, entry)) take_mesh(at, i, entry);
    } else if (!is_alone()) {
      take(at.numbers.at_rest(surfaces.surfaces[entry]) ? ground_ : bodies_, entry,
           [&] { return surface_key(at, p, entry); });
    }
}

// Unpacks the history of contacts of a particle with a mesh to the entries of their group. entry: the first
// of the group.
void CpuHistory::take_mesh(const Listed& at, Index i, Index entry) {
  const SurfaceRows& surfaces = at.list.surfaces;
  const Vec3 p = xyz(at.store.position[i]);
  const std::int64_t sought = mesh_key(at, p, entry, surface_id(surfaces.surfaces[entry]));
  Index slot = entry;
  for (std::int64_t k = kept_.offsets[static_cast<std::size_t>(i)];
       k < kept_.offsets[static_cast<std::size_t>(i) + 1]; ++k) {
    const std::int64_t key = kept_.keys[static_cast<std::size_t>(k)];
    if (!is_surface(key) || without_feature(key) != sought) continue;
    if (slot == surfaces.offsets[i + 1] || !surfaces.alike(entry, slot)) return;
    features_[slot] = beside_mesh(at, p, slot).remembered(key);
    if (!is_alone()) put(bodies_, slot, k);
    ++slot;
  }
}

void CpuHistory::take_slots(const Listed& at) {
  if (!exists()) return;
  if (!is_alone()) neighbors_.assign(first_record(std::ssize(at.list.neighbors)), {});
  for (std::vector<Vec4>* of_surfaces : {&ground_, &bodies_, &ahead_})
    of_surfaces->assign(first_record(std::ssize(at.list.surfaces.surfaces)), {});
  for (std::vector<Index>* of_meshes : {&features_, &features_ahead_})
    of_meshes->assign(at.list.surfaces.groups.empty() ? 0 : at.list.surfaces.surfaces.size(), kNoFeature);
  for (Index i = 0; i < at.store.owned; ++i) take_row(at, i);
  kept_ = no_contacts(numbers_, 0);
  at_slots_ = true;
}

RememberedCount CpuHistory::remembered() const {
  if (!exists()) return {};
  return [this](Index i, Index surface) { return kept_.contacts_with(i, surface); };
}

void CpuHistory::load(const KeptContacts& contacts, Index owned) {
  if (!exists()) return;
  kept_ = contacts.numbers == numbers_ ? contacts : no_contacts(numbers_, owned);
  at_slots_ = false;
}

void CpuHistory::reorder(const std::vector<Index>& from) {
  if (exists()) kept_ = kept_.rows(from);
}

void CpuHistory::migrate(const Ranks& ranks, const std::vector<std::vector<Index>>& departing,
                         const std::vector<Index>& remaining) {
  if (!exists()) return;
  std::vector<KeptContacts> to;
  for (const std::vector<Index>& particles : departing) to.push_back(kept_.rows(particles));
  const KeptContacts arriving = deal_out(ranks, to);
  reorder(remaining);
  for (std::int64_t i = 0; i < arriving.particles(); ++i) kept_.add_row(arriving, i);
}

}  // namespace scree
