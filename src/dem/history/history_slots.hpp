// Contact history at the slots of a list. A slot is the number of a list entry; its record is read by every
// walk and written by the items that accept a step. Shared by the CPU and CUDA backends.
#pragma once

#include <cstdint>

#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "partition/halo_plan.hpp"
#include "partition/subdomain.hpp"

namespace scree {

// The history of a contact is one to three Vec4, whole memory sectors, so that sparse contacts cost no more
// than their own traffic. w of the first one is the number of the step that wrote it: a record that the last
// step did not write belongs to a contact that has ended, and nothing needs to be cleared.
inline constexpr int kMostNumbers = 8;  // of history per contact
SCREE_HD constexpr int records_of(int numbers) {
  return numbers <= 0 ? 0 : numbers <= 3 ? 1 : numbers <= 7 ? 2 : 3;
}
inline constexpr int kMostRecords = records_of(kMostNumbers);

// The k-th number of a history record.
template <class Record>
SCREE_HD auto& number_of(Record* records, int k) {
  return k == 0   ? records[0].x
         : k == 1 ? records[0].y
         : k == 2 ? records[0].z
         : k == 3 ? records[1].x
         : k == 4 ? records[1].y
         : k == 5 ? records[1].z
         : k == 6 ? records[1].w
                  : records[2].x;
}

// Prefetches a record.
SCREE_HD void prefetch_record(const Vec4* record) {
#ifdef __CUDA_ARCH__
  asm volatile("prefetch.global.L2 [%0];" ::"l"(record));
#else
  __builtin_prefetch(record, 1);
#endif
}

// Views of the history; pointers are null without one.
struct HistoryViews {
  Vec4* neighbors = nullptr;  // [slots][records]
  Vec4* ground = nullptr;     // [entries of the surfaces][records], of static planes
  // Records of placed surfaces, whose contacts are evaluated before the particles' walk: after the last step,
  // and after the evaluated step if it is accepted. The latter is null for evaluations that do not store it.
  Vec4 *bodies = nullptr, *ahead = nullptr;
  // Features of the contacts with meshes, per entry; on open surfaces with the side
  // (mesh/open_surface_sides.hpp). Without records kNoFeature marks entries without contact.
  Index *features = nullptr, *next_features = nullptr;
  Real step = 0;  // number of the last accepted step, above 0

  // Views for an evaluation that stores nothing.
  HistoryViews only_read() const {
    HistoryViews views = *this;
    views.ahead = nullptr;
    return views;
  }

  // History of the contact at the slot: that of zeros if it was not closed at the last step.
  template <class Law>
  SCREE_HD auto read(const Vec4* records, std::int64_t slot) const {
    constexpr int kRecords = records_of(Law::kHistory);
    if constexpr (kRecords == 0) {
      return typename Law::History{};
    } else {
      Vec4 at[kMostRecords];
      // Further records are read whether the contact was closed or not, beside the first one and not after
      // it.
      for (int r = 0; r < kRecords; ++r) at[r] = records[slot * kRecords + r];
      const bool closed = at[0].w == step;
      return Law::read_history([&](int k) { return closed ? number_of(at, k) : Real(0); });
    }
  }
  // History of a contact that continues the one at the slot; -1: a new contact.
  template <class Law>
  SCREE_HD auto read_from(const Vec4* records, std::int64_t slot) const {
    if (slot >= 0) return read<Law>(records, slot);
    return Law::read_history([](int) { return Real(0); });
  }
  template <class Law, class History>
  SCREE_HD void write(Vec4* records, std::int64_t slot, const History& history) const {
    constexpr int kRecords = records_of(Law::kHistory);
    Vec4 at[kMostRecords];
    Law::write_history(history, [&](int k, Real value) { number_of(at, k) = value; });
    at[0].w = step + 1;
    for (int r = 0; r < kRecords; ++r) records[slot * kRecords + r] = at[r];
  }
  // Writes the history as the other partner has it, for the same step.
  template <class Law>
  static void mirror(const Vec4* records, Vec4* of_other) {
    const auto history = Law::read_history([&](int k) { return number_of(records, k); });
    Law::write_history(history.mirrored(), [&](int k, Real value) { number_of(of_other, k) = value; });
    of_other[0].w = records[0].w;
  }
  // Marks the contact at the slot as open.
  template <class Law>
  SCREE_HD void write_none(Vec4* records, std::int64_t slot) const {
    records[slot * records_of(Law::kHistory)].w = 0;
  }
};

// Periodic box.
struct PeriodicBox {
  Vec3 min, period;  // [m]

  // Whether p needs no wrapping.
  SCREE_HD bool holds(Vec3 p) const {
    const auto along = [](Real x, Real start, Real length) {
      return length == 0 || (x >= start && x < start + length);
    };
    return along(p.x, min.x, period.x) && along(p.y, min.y, period.y) && along(p.z, min.z, period.z);
  }
  SCREE_HD ImageCount periods_at(Vec3 p) const {
    ImageCount count;
    wrap(min, period, p, count);
    return count;
  }
  // Shift of a position that has left the box since the list was built.
  SCREE_HD Vec3 beyond(Vec3 p) const {
    const auto axis = [](Real x, Real start, Real length) {
      return x < start ? -length : x >= start + length ? length : 0;
    };
    return {axis(p.x, min.x, period.x), axis(p.y, min.y, period.y), axis(p.z, min.z, period.z)};
  }
  // The box with periodicity along the other axes only.
  SCREE_HD PeriodicBox without(Vec3 spanned) const { return {min, period - spanned}; }
  // Number of the image, relative to p, of the item at q that is shifted by `image`.
  SCREE_HD std::int8_t image_relative_to(Vec3 p, Vec3 q, std::int8_t image = kZeroShift) const {
    if (holds(p) && holds(q)) return image;  // the common case
    const ImageCount a = periods_at(p), b = periods_at(q);
    return static_cast<std::int8_t>(image + (b.x - a.x) + 3 * (b.y - a.y) + 9 * (b.z - a.z));
  }
};

}  // namespace scree
