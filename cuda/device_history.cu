#include <cub/device/device_scan.cuh>
#include <stdexcept>

#include "base/countable.hpp"
#include "dem/backend/device.hpp"
#include "dem/particles/particle_fields.hpp"
#include "device_history.cuh"
#include "for_each.cuh"
#include "packed_history_rows.cuh"

namespace scree {
namespace {

struct NoFeatureItem {
  Index *now, *ahead;
  SCREE_HD void operator()(Index entry) const { now[entry] = ahead[entry] = kNoFeature; }
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

// Reserve of an array that had to grow: 1 / kPackedReserve of what is needed.
constexpr std::size_t kPackedReserve = 32, kEntriesReserve = 32;
// Share of the list's slots, at first those of a settled bed, for whose entries there are records at least: a
// bed that settles enlarges them seldom. In a settled bed a larger share of the slots has entries.
constexpr double kFilledSlots = 0.75;

// All rows in one contiguous part.
template <class Rows>
PackedHistoryViews views_of_rows(Rows& rows, int numbers) {
  PackedHistoryViews views{rows.offsets.data(), numbers, {}};
  views.part[0] = {rows.keys.data(), rows.values.data(), 0, static_cast<Index>(rows.keys.size())};
  return views;
}

// Queues the copies of all contacts from their parts to contiguous memory of the host.
void join_parts(const PackedHistoryViews& parts, std::int64_t* keys, Real* values, cudaStream_t stream) {
  const auto numbers = static_cast<std::size_t>(parts.numbers);
  for (const PackedHistoryViews::Part& part : parts.part) {
    if (part.size() == 0) continue;
    copy_async(keys + part.first, part.keys, part.size(), stream);
    copy_async(values + static_cast<std::size_t>(part.first) * numbers, part.values, part.size() * numbers,
               stream);
  }
}

DeviceKeyedRows keyed_rows(const DeviceHistory::Listed& at, const PeriodicBox& box,
                           const HistoryViews& history, int numbers) {
  return {at.position, at.row_key, at.list.rows(), at.surfaces.list(),
          box,         history,    numbers,        records_of(numbers)};
}

}  // namespace

DeviceHistory::DeviceHistory(HistoryContent content, const PeriodicBox& box, cudaStream_t stream,
                             const ScratchArrays& scratch)
    : content_(content), box_(box), stream_(stream), scratch_arrays_(scratch) {
  if (width() > 0) first_step_.resize(1), h_first_step_.resize(1);
}

HistoryViews DeviceHistory::views(bool ahead) {
  if (!exists()) return {};
  HistoryViews views{neighbors_.data(), ground_.data(),        bodies_.data(), ahead_.data(),
                     features_.data(),  next_features_.data(), step_};
  if (content_ == kSidesOnly) views.neighbors = views.ground = views.bodies = views.ahead = nullptr;
  if (ahead) std::swap(views.bodies, views.ahead), std::swap(views.features, views.next_features);
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

// The step number is kept on the device, and contacts with bodies belong to another kernel. So the launches
// of one run equal those of the next, and captured graphs can be reused.
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
  // The scan also reads the length past the end, although no offset depends on it.
  require_cuda(cudaMemsetAsync(rows.offsets.data() + count, 0, sizeof(Index), stream_), "cudaMemsetAsync");
  with_space(space_, [&](void* at, std::size_t& bytes) {
    require_cuda(cub::DeviceScan::ExclusiveSum(at, bytes, rows.offsets.data(), count + 1, stream_), "scan");
  });
  copy_async(h_count_.data(), rows.offsets.data() + count, 1, stream_);
  wait_for(stream_);
  return static_cast<std::size_t>(h_count_[0]);
}

void DeviceHistory::reserve_entries(Rows& rows, std::size_t contacts) const {
  rows.keys.resize_with_spare(contacts);
  rows.values.resize_with_spare(contacts * static_cast<std::size_t>(width()));
}

std::size_t DeviceHistory::count_rows(Rows& rows, const Listed& at, Index first, Index count) {
  countable(static_cast<std::size_t>(at.list.entries()), "stage migrate: more contacts");
  rows.offsets.resize(static_cast<std::size_t>(count) + 1);
  for_each_row({stream_}, count,
               CountClosedItem{keyed_rows(at, box_, views(), width()), first, rows.offsets.data()});
  return add_up(rows, count);
}

void DeviceHistory::fill_rows(const PackedHistoryViews& rows, const Listed& at, Index first, Index count) {
  for_each_row({stream_}, count, PackHistoryItem{keyed_rows(at, box_, views(), width()), first, rows});
}

PackedHistoryViews DeviceHistory::packed_history_views() {
  return parts_ ? *parts_ : views_of_rows(stored_, width());
}

// Memory for that many contacts in parts, while the slots' records are in use: the second arrays, which are
// free before and after the sort, then the arrays of explicit steps.
PackedHistoryViews DeviceHistory::lay_out_parts(std::size_t contacts) {
  constexpr std::size_t kSizeMultiple = 4;  // multiple of the sizes of parts, which aligns the values to 32 B
                                            // sectors
  const auto numbers = static_cast<std::size_t>(width());
  PackedHistoryViews parts{stored_.offsets.data(), width(), {}};
  std::size_t first = 0, next = 0;
  const auto add = [&](std::int64_t* keys, Real* values, std::size_t size) {
    parts.part[next++] = {keys, values, static_cast<Index>(first), static_cast<Index>(first + size)};
    first += size;
  };
  for (DeviceArray<Vec4>* array : scratch_arrays_.second.motion()) {
    const std::size_t fit = array->size() * sizeof(Vec4) / (sizeof(std::int64_t) + numbers * sizeof(Real)) /
                            kSizeMultiple * kSizeMultiple;
    auto* const keys = reinterpret_cast<std::int64_t*>(array->data());
    add(keys, reinterpret_cast<Real*>(keys + fit), std::min(fit, contacts - first));
  }
  const std::size_t rest = contacts - first;
  scratch_arrays_.of_steps.lay_out(ArenaArray{rest_keys_, rest}, ArenaArray{rest_values_, rest * numbers});
  add(rest_keys_.data(), rest_values_.data(), rest);
  return parts;
}

// Memory for that many contacts in one part: the memory of the slots' records, which must not be needed any
// more. False where it does not suffice.
bool DeviceHistory::lay_out_in_records(std::size_t contacts) {
  const auto numbers = static_cast<std::size_t>(width());
  const ArenaArray keys{stored_.keys, contacts};
  const ArenaArray values{stored_.values, contacts * numbers};
  if (keys.bytes() + values.bytes() > neighbors_.size() * sizeof(Vec4)) return false;
  auto* const at = reinterpret_cast<std::byte*>(neighbors_.data());
  stored_.keys.alias_memory(reinterpret_cast<std::int64_t*>(at), keys.size);
  stored_.values.alias_memory(reinterpret_cast<Real*>(at + keys.bytes()), values.size);
  return true;
}

// While a list is built, the packed history of a packed bed fits into the memory of the slots' records: from
// when they are packed until they are unpacked. Before and after that it is in parts. With few neighbours and
// many surfaces it does not fit.
void DeviceHistory::pack_history(const Listed& at) {
  if (!at_slots_) return;
  row_of_.resize(static_cast<std::size_t>(at.owned));
  const std::size_t contacts = count_rows(stored_, at, 0, at.owned),
                    numbers = static_cast<std::size_t>(width()),
                    reserved = contacts + contacts / kPackedReserve;  // for arriving particles
  in_records_ = lay_out_in_records(reserved);
  if (!in_records_)
    scratch_arrays_.of_steps.lay_out(ArenaArray{stored_.keys, reserved},
                                     ArenaArray{stored_.values, reserved * numbers});
  stored_.keys.resize(contacts), stored_.values.resize(contacts * numbers);
  const PackedHistoryViews parts = in_records_ ? lay_out_parts(contacts) : packed_history_views();
  fill_rows(parts, at, 0, at.owned);
  if (in_records_)
    for_each({stream_}, static_cast<Index>(contacts),
             CopyContactItem{parts, views_of_rows(stored_, width())});
  for_each({stream_}, at.owned, CountUpItem{row_of_.data(), 0});
  at_slots_ = false;
}

// Moves the packed history out of the memory of the slots' records.
void DeviceHistory::clear_records() {
  if (!in_records_) return;
  const PackedHistoryViews parts = lay_out_parts(stored_.keys.size());
  for_each({stream_}, static_cast<Index>(stored_.keys.size()),
           CopyContactItem{views_of_rows(stored_, width()), parts});
  parts_ = parts, in_records_ = false;
  stored_.keys.release(), stored_.values.release();
}

void DeviceHistory::unpack_history(const Listed& at) {
  if (!exists()) return;
  clear_records();
  const auto records = static_cast<std::size_t>(records_of(width()));
  if (const auto needed = static_cast<std::size_t>(at.list.entries()) * records; needed > neighbors_.size()) {
    const auto settled = static_cast<std::size_t>(kFilledSlots * static_cast<double>(at.list.slots()));
    neighbors_.resize(std::max(needed + needed / kEntriesReserve, settled * records));
  }
  for (DeviceArray<Vec4>* of_surfaces : {&ground_, &bodies_, &ahead_})
    of_surfaces->resize_with_spare(static_cast<std::size_t>(at.surfaces.entries()) * records);
  for (DeviceArray<Index>* of_meshes : {&features_, &next_features_})
    of_meshes->resize_with_spare(static_cast<std::size_t>(at.surfaces.entries()));
  ahead_.zero(stream_);
  for_each({stream_}, at.surfaces.entries(), NoFeatureItem{features_.data(), next_features_.data()});
  for_each_row(
      {stream_}, at.owned,
      UnpackHistoryItem{keyed_rows(at, box_, views(), width()), packed_history_views(), row_of_.data()});
  parts_.reset(), stored_.keys.release(), stored_.values.release();
  at_slots_ = true;
}

StoredRows DeviceHistory::stored_contacts() {
  if (!exists()) return {};
  return {packed_history_views(), row_of_.data()};
}

void DeviceHistory::load(const PackedHistory& contacts, Index owned) {
  if (!exists()) return;
  at_slots_ = false;
  stored_.offsets.resize(1), stored_.offsets.zero(stream_);
  in_records_ = false, parts_.reset(), stored_.keys.release(), stored_.values.release();
  row_of_.resize(0);
  const auto at_once = static_cast<std::size_t>(std::min(owned, kRowsAtOnce));
  packed_.offsets.resize(at_once + 1), reserve_entries(packed_, at_once * kContactsPerRow);
  append(contacts.content == content_ ? contacts : no_contacts(content_, owned), 0);
}

void DeviceHistory::reorder(const Index* order, Index n, Index* numbers) {
  if (!exists()) return;
  if (parts_) throw std::logic_error("DeviceHistory: the sort would overwrite the packed history");
  for_each({stream_}, n, RowOfItem{row_of_.data(), order, numbers});
  row_of_.resize(static_cast<std::size_t>(n));
  copy_async(row_of_.data(), numbers, row_of_.size(), stream_);
}

void DeviceHistory::append(const PackedHistory& arriving, Index owned) {
  const std::size_t rows = stored_.offsets.size() - 1, contacts = stored_.keys.size(),
                    values = stored_.values.size(), more = static_cast<std::size_t>(arriving.particles());
  const Index last = countable(contacts + arriving.keys.size(), "stage migrate: more contacts");
  std::vector<Index> offsets;
  for (const std::int64_t offset : arriving.offsets)
    offsets.push_back(static_cast<Index>(static_cast<std::int64_t>(contacts) + offset));
  offsets.back() = last;
  stored_.offsets.grow(rows + 1 + more, rows, stream_);
  stored_.keys.grow(static_cast<std::size_t>(last), contacts, stream_);
  stored_.values.grow(values + arriving.values.size(), values, stream_);
  row_of_.grow(static_cast<std::size_t>(owned) + more, static_cast<std::size_t>(owned), stream_);
  copy_async(stored_.offsets.data() + rows, offsets.data(), offsets.size(), stream_);
  copy_async(stored_.keys.data() + contacts, arriving.keys.data(), arriving.keys.size(), stream_);
  copy_async(stored_.values.data() + values, arriving.values.data(), arriving.values.size(), stream_);
  for_each({stream_}, static_cast<Index>(more),
           CountUpItem{row_of_.data() + owned, static_cast<Index>(rows)});
  wait_for(stream_);  // the copies above read `offsets`
}

PackedHistory DeviceHistory::download(const Rows& rows, const PackedHistoryViews& parts) const {
  PackedHistory out;
  out.content = content_;
  const std::vector<Index> offsets = rows.offsets.download(stream_);
  out.offsets.assign(offsets.begin(), offsets.end());
  out.keys.resize(static_cast<std::size_t>(offsets.back()));
  out.values.resize(out.keys.size() * static_cast<std::size_t>(width()));
  join_parts(parts, out.keys.data(), out.values.data(), stream_);
  wait_for(stream_);
  return out;
}

PackedHistory DeviceHistory::rows(const Index* particles, Index n) {
  if (!exists()) return {};
  if (n == 0) return no_contacts(content_, 0);
  packed_.offsets.resize(static_cast<std::size_t>(n) + 1);
  for_each({stream_}, n,
           RowLengthItem{stored_.offsets.data(), row_of_.data(), particles, packed_.offsets.data()});
  reserve_entries(packed_, add_up(packed_, n));
  for_each({stream_}, n,
           CopyRowItem{packed_history_views(), row_of_.data(), particles, views_of_rows(packed_, width())});
  return download(packed_, views_of_rows(packed_, width()));
}

PackedHistory DeviceHistory::contacts(const Listed& at) {
  if (!exists()) return {};
  if (!at_slots_) return download(stored_, packed_history_views()).rows(row_of_.download(stream_));
  // In batches of rows: the scratch memory of the packed history is in use by steps.
  PackedHistory out = no_contacts(content_, 0);
  for (Index first = 0; first < at.owned; first += kRowsAtOnce) {
    const Index count = std::min(kRowsAtOnce, at.owned - first);
    reserve_entries(packed_, count_rows(packed_, at, first, count));
    fill_rows(views_of_rows(packed_, width()), at, first, count);
    out.append(download(packed_, views_of_rows(packed_, width())));
  }
  return out;
}

}  // namespace scree
