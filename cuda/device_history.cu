#include <cub/device/device_scan.cuh>

#include "base/countable.hpp"
#include "dem/device.hpp"
#include "dem/particle_fields.hpp"
#include "device_history.cuh"
#include "for_each.cuh"
#include "named_rows.cuh"

namespace scree {
namespace {

struct KeptViews {
  const Index* offsets;
  std::int64_t* keys;
  Real* values;
};

// Of the rows from the first on.
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
      kept.keys[at] = key;
      Real* const to = kept.values + std::int64_t{at} * names.numbers;
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
  // Contacts with meshes may stand out of order: by distance, not by feature.
  __device__ void order(Index first, Index end) const {
    for (Index k = first + 1; k < end; ++k)
      for (Index at = k; at > first && kept.keys[at - 1] > kept.keys[at]; --at) {
        exchange(kept.keys[at - 1], kept.keys[at]);
        for (int v = 0; v < names.numbers; ++v)
          exchange(kept.values[std::int64_t{at - 1} * names.numbers + v],
                   kept.values[std::int64_t{at} * names.numbers + v]);
      }
  }
  template <class T>
  __device__ static void exchange(T& a, T& b) {
    const T was = a;
    a = b, b = was;
  }
};

// Both the row and what was kept are ordered by key: one pass over both. Meshes come after.
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
      while (at < end && kept.keys[at] < wanted) ++at;
      if (at < end && kept.keys[at] == wanted) put(record, at);
    });
    names.visit_meshes(i, [&](Index entry) {
      if (entry == names.surfaces.offsets[i] || !names.alike(entry - 1, entry)) take_mesh(i, entry);
    });
  }

 private:
  __device__ void put(Vec4* record, Index contact) const {
    const Real* const from = kept.values + std::int64_t{contact} * names.numbers;
    for (int k = 0; k < names.numbers; ++k) number_of(record, k) = from[k];
    if (names.records > 0) record->w = names.history.step;
  }
  // What the particle remembers of a mesh goes to the entries of their group, the first of which is given.
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
      const std::int64_t key = kept.keys[k];
      if (!is_surface(key) || without_feature(key) != wanted) continue;
      names.feature(slot) = beside.remembered(key);
      put(names.record_of(slot++), k);
    }
  }
};

struct NoFeatureItem {
  Index *now, *ahead;
  SCREE_HD void operator()(Index entry) const { now[entry] = ahead[entry] = kNoFeature; }
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
  int numbers;
  KeptViews to;
  SCREE_HD void operator()(Index k) const {
    const Index row = row_of[particles[k]], count = from.offsets[row + 1] - from.offsets[row];
    const std::int64_t old = from.offsets[row], at = to.offsets[k];
    for (Index c = 0; c < count; ++c) to.keys[at + c] = from.keys[old + c];
    for (std::int64_t v = 0; v < std::int64_t{count} * numbers; ++v)
      to.values[at * numbers + v] = from.values[old * numbers + v];
  }
};

struct RowOfItem {
  const Index *row_of, *order;
  Index* out;
  SCREE_HD void operator()(Index i) const { out[i] = row_of[order[i]]; }
};

struct CountUpItem {
  Index* out;
  Index first;
  SCREE_HD void operator()(Index i) const { out[i] = first + i; }
};

// Room over what was needed where an array had to grow: one in so many.
constexpr std::size_t kKeptSpare = 32, kEntriesSpare = 32;

template <class Rows>
KeptViews kept_views(Rows& rows) {
  return {rows.offsets.data(), rows.keys.data(), rows.values.data()};
}

NamedRows names_of(const DeviceHistory::Listed& at, const PeriodicBox& box, const HistoryViews& history,
                   int numbers) {
  return {at.position, at.row_key, at.list.rows(), at.surfaces.list(),
          box,         history,    numbers,        records_of(numbers)};
}

}  // namespace

DeviceHistory::DeviceHistory(int numbers, const PeriodicBox& box, cudaStream_t stream, DeviceRoom& room)
    : numbers_(numbers), box_(box), stream_(stream), room_(room) {
  if (width() > 0) first_step_.resize(1), h_first_step_.resize(1);
}

HistoryViews DeviceHistory::views(bool ahead) {
  if (!exists()) return {};
  HistoryViews views{neighbors_.data(), ground_.data(),         bodies_.data(), ahead_.data(),
                     features_.data(),  features_ahead_.data(), step_};
  if (is_alone()) views.neighbors = views.ground = views.bodies = views.ahead = nullptr;
  if (ahead) std::swap(views.bodies, views.ahead), std::swap(views.features, views.features_ahead);
  return views;
}

HistoryViews DeviceHistory::views_before(bool ahead) {
  HistoryViews views = this->views(!ahead);
  views.neighbors = views.ground = nullptr, views.step = step_ - 1;
  return views;
}

HistoryViews DeviceHistory::surface_views_in_run(bool ahead) {
  HistoryViews views = this->views(ahead);
  views.neighbors = views.ground = nullptr, views.step = 0;
  return views;
}

// The number itself is the device's, and contacts with bodies are not this kernel's, so that the launches of
// one run are those of the next.
HistoryViews DeviceHistory::views_in_run() {
  HistoryViews views = this->views();
  views.bodies = views.ahead = nullptr, views.step = 0;
  return views;
}

void DeviceHistory::begin_run() {
  if (width() == 0) return;
  run_start_ = h_first_step_[0] = step_;
  copy_async(first_step_.data(), h_first_step_.data(), 1, stream_);
}

std::size_t DeviceHistory::add_up(Rows& rows, Index count) {
  // The length past the end is read, though no sum depends on it.
  require_cuda(cudaMemsetAsync(rows.offsets.data() + count, 0, sizeof(Index), stream_), "cudaMemsetAsync");
  with_space(space_, [&](void* at, std::size_t& bytes) {
    require_cuda(cub::DeviceScan::ExclusiveSum(at, bytes, rows.offsets.data(), count + 1, stream_), "scan");
  });
  copy_async(h_count_.data(), rows.offsets.data() + count, 1, stream_);
  wait_for(stream_);
  return static_cast<std::size_t>(h_count_[0]);
}

void DeviceHistory::make_room(Rows& rows, std::size_t contacts) const {
  rows.keys.resize_with_spare(contacts);
  rows.values.resize_with_spare(contacts * static_cast<std::size_t>(width()));
}

std::size_t DeviceHistory::count_rows(Rows& rows, const Listed& at, Index first, Index count) {
  countable(static_cast<std::size_t>(at.list.entries()), "stage migrate: more contacts");
  rows.offsets.resize(static_cast<std::size_t>(count) + 1);
  for_each({stream_}, count,
           CountClosedItem{names_of(at, box_, views(), width()), first, rows.offsets.data()});
  return add_up(rows, count);
}

void DeviceHistory::fill_rows(Rows& rows, const Listed& at, Index first, Index count) {
  for_each({stream_}, count, KeepItem{names_of(at, box_, views(), width()), first, kept_views(rows)});
}

void DeviceHistory::leave_slots(const Listed& at) {
  if (!at_slots_) return;
  row_of_.resize(static_cast<std::size_t>(at.owned));
  const std::size_t contacts = count_rows(kept_, at, 0, at.owned),
                    numbers = static_cast<std::size_t>(width()),
                    room = contacts + contacts / kKeptSpare;  // for those that come with particles
  room_.lay_out(RoomFor{kept_.keys, room}, RoomFor{kept_.values, room * numbers});
  kept_.keys.resize(contacts), kept_.values.resize(contacts * numbers);
  fill_rows(kept_, at, 0, at.owned);
  for_each({stream_}, at.owned, CountUpItem{row_of_.data(), 0});
  at_slots_ = false;
}

void DeviceHistory::take_slots(const Listed& at) {
  if (!exists()) return;
  const auto records = static_cast<std::size_t>(records_of(width()));
  if (const auto needed = static_cast<std::size_t>(at.list.entries()) * records; needed > neighbors_.size())
    neighbors_.resize(needed + needed / kEntriesSpare);
  for (DeviceArray<Vec4>* of_surfaces : {&ground_, &bodies_, &ahead_})
    of_surfaces->resize_with_spare(static_cast<std::size_t>(at.surfaces.entries()) * records);
  for (DeviceArray<Index>* of_meshes : {&features_, &features_ahead_})
    of_meshes->resize_with_spare(static_cast<std::size_t>(at.surfaces.entries()));
  ahead_.zero(stream_);
  for_each({stream_}, at.surfaces.entries(), NoFeatureItem{features_.data(), features_ahead_.data()});
  for_each({stream_}, at.owned,
           TakeItem{names_of(at, box_, views(), width()), kept_views(kept_), row_of_.data()});
  kept_.keys.release(), kept_.values.release();
  at_slots_ = true;
}

void DeviceHistory::load(const KeptContacts& contacts, Index owned) {
  if (!exists()) return;
  at_slots_ = false;
  kept_.offsets.resize(1), kept_.offsets.zero(stream_), kept_.keys.resize(0), kept_.values.resize(0);
  row_of_.resize(0);
  const auto at_once = static_cast<std::size_t>(std::min(owned, kRowsAtOnce));
  packed_.offsets.resize(at_once + 1), make_room(packed_, at_once * kRoomInRows);
  append(contacts.numbers == numbers_ ? contacts : no_contacts(numbers_, owned), 0);
}

void DeviceHistory::reorder(const Index* order, Index n, Index* numbers) {
  if (!exists()) return;
  for_each({stream_}, n, RowOfItem{row_of_.data(), order, numbers});
  row_of_.resize(static_cast<std::size_t>(n));
  copy_async(row_of_.data(), numbers, row_of_.size(), stream_);
}

void DeviceHistory::append(const KeptContacts& arriving, Index owned) {
  const std::size_t rows = kept_.offsets.size() - 1, contacts = kept_.keys.size(),
                    values = kept_.values.size(), more = static_cast<std::size_t>(arriving.particles());
  const Index last = countable(contacts + arriving.keys.size(), "stage migrate: more contacts");
  std::vector<Index> offsets;
  for (const std::int64_t offset : arriving.offsets)
    offsets.push_back(static_cast<Index>(static_cast<std::int64_t>(contacts) + offset));
  offsets.back() = last;
  kept_.offsets.grow(rows + 1 + more, rows, stream_);
  kept_.keys.grow(static_cast<std::size_t>(last), contacts, stream_);
  kept_.values.grow(values + arriving.values.size(), values, stream_);
  row_of_.grow(static_cast<std::size_t>(owned) + more, static_cast<std::size_t>(owned), stream_);
  copy_async(kept_.offsets.data() + rows, offsets.data(), offsets.size(), stream_);
  copy_async(kept_.keys.data() + contacts, arriving.keys.data(), arriving.keys.size(), stream_);
  copy_async(kept_.values.data() + values, arriving.values.data(), arriving.values.size(), stream_);
  for_each({stream_}, static_cast<Index>(more),
           CountUpItem{row_of_.data() + owned, static_cast<Index>(rows)});
  wait_for(stream_);  // before the vectors above go
}

KeptContacts DeviceHistory::download(const Rows& rows) const {
  KeptContacts out;
  out.numbers = numbers_;
  const std::vector<Index> offsets = rows.offsets.download(stream_);
  out.offsets.assign(offsets.begin(), offsets.end());
  out.keys = rows.keys.download(stream_), out.values = rows.values.download(stream_);
  return out;
}

KeptContacts DeviceHistory::rows(const Index* particles, Index n) {
  if (!exists()) return {};
  if (n == 0) return no_contacts(numbers_, 0);
  packed_.offsets.resize(static_cast<std::size_t>(n) + 1);
  for_each({stream_}, n,
           RowLengthItem{kept_.offsets.data(), row_of_.data(), particles, packed_.offsets.data()});
  make_room(packed_, add_up(packed_, n));
  for_each({stream_}, n,
           CopyRowItem{kept_views(kept_), row_of_.data(), particles, width(), kept_views(packed_)});
  return download(packed_);
}

KeptContacts DeviceHistory::contacts(const Listed& at) {
  if (!exists()) return {};
  if (!at_slots_) return download(kept_).rows(row_of_.download(stream_));
  // Some rows after the other: steps need the room of what is kept.
  KeptContacts out = no_contacts(numbers_, 0);
  for (Index first = 0; first < at.owned; first += kRowsAtOnce) {
    const Index count = std::min(kRowsAtOnce, at.owned - first);
    make_room(packed_, count_rows(packed_, at, first, count));
    fill_rows(packed_, at, first, count);
    out.append(download(packed_));
  }
  return out;
}

}  // namespace scree
