#include "dem/host/cpu_history.hpp"

#include <array>

namespace scree {
namespace {

// Access to a packed history for `KeyedRows::unpack`.
struct StoredContacts {
  const std::int64_t* keys;
  const Real* all_values;
  int numbers;

  std::int64_t key(std::int64_t contact) const { return keys[contact]; }
  const Real* values(std::int64_t contact) const { return all_values + contact * numbers; }
};

}  // namespace

KeyedRows<PackedRows> CpuHistory::keyed_rows(const Listed& at) {
  const SurfaceRows& surfaces = at.list.surfaces;
  return {at.store.position.data(),
          at.store.row_key.data(),
          {at.list.offsets.data(), at.list.neighbors.data()},
          {surfaces.offsets.data(), surfaces.surfaces.data(), surfaces.images.data(), at.poses.placed.data(),
           at.poses.frames.data(), at.poses.meshes.data(), at.numbers},
          box_,
          views(),
          content_.values,
          records()};
}

HistoryViews CpuHistory::sides_only(std::vector<Index>& of, std::vector<Index>& ahead) {
  HistoryViews views;
  views.features = of.data(), views.next_features = ahead.data();
  return views;
}

HistoryViews CpuHistory::views() {
  if (!exists()) return {};
  if (content_ == kSidesOnly) return sides_only(features_, next_features_);
  return {neighbors_.data(), ground_.data(),        bodies_.data(), ahead_.data(),
          features_.data(),  next_features_.data(), step_};
}

HistoryViews CpuHistory::views_before() {
  if (!exists()) return {};
  if (content_ == kSidesOnly) return sides_only(next_features_, features_);
  return {nullptr,          nullptr,  ahead_.data(), bodies_.data(), next_features_.data(),
          features_.data(), step_ - 1};
}

PackedHistory CpuHistory::contacts(const Listed& at) {
  if (!at_slots_) return packed_;
  PackedHistory out;
  out.content = content_;
  const KeyedRows<PackedRows> rows = keyed_rows(at);
  std::array<Real, kMostNumbers> values;
  const std::span<const Real> of_contact{values.data(), static_cast<std::size_t>(content_.values)};
  const auto add = [&](const Vec4* record, const auto& key) {
    for (int k = 0; k < content_.values; ++k) values[static_cast<std::size_t>(k)] = number_of(record, k);
    out.add(key(), of_contact);
  };
  for (Index i = 0; i < at.store.owned; ++i) {
    const std::size_t first = out.keys.size();
    rows.for_each_closed(i, add);
    if (!at.list.surfaces.groups.empty()) out.order_from(first);
    out.end_row();
  }
  return out;
}

void CpuHistory::pack_history(const Listed& at) {
  if (!at_slots_) return;
  packed_ = contacts(at);
  at_slots_ = false;
}

void CpuHistory::unpack_history(const Listed& at) {
  if (!exists()) return;
  const auto records = static_cast<std::size_t>(this->records());
  neighbors_.resize(at.list.neighbors.size() * records);  // all slots are filled or cleared
  for (std::vector<Vec4>* of_surfaces : {&ground_, &bodies_, &ahead_})
    of_surfaces->assign(at.list.surfaces.surfaces.size() * records, {});
  for (std::vector<Index>* of_meshes : {&features_, &next_features_})
    of_meshes->assign(at.list.surfaces.groups.empty() ? 0 : at.list.surfaces.surfaces.size(), kNoFeature);
  const KeyedRows<PackedRows> rows = keyed_rows(at);
  const StoredContacts stored{packed_.keys.data(), packed_.values.data(), content_.values};
  for (Index i = 0; i < at.store.owned; ++i)
    rows.unpack(i, stored, packed_.offsets[static_cast<std::size_t>(i)],
                packed_.offsets[static_cast<std::size_t>(i) + 1]);
  packed_ = no_contacts(content_, 0);
  at_slots_ = true;
}

StoredContactCount CpuHistory::stored_contacts() const {
  if (!exists()) return {};
  return [this](Index i, Index surface) { return packed_.contacts_with(i, surface); };
}

void CpuHistory::load(const PackedHistory& contacts, Index owned) {
  if (!exists()) return;
  packed_ = contacts.content == content_ ? contacts : no_contacts(content_, owned);
  at_slots_ = false;
}

void CpuHistory::reorder(const std::vector<Index>& from) {
  if (exists()) packed_ = packed_.rows(from);
}

void CpuHistory::append_empty(std::int64_t particles) {
  if (exists()) packed_.append(no_contacts(content_, particles));
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
