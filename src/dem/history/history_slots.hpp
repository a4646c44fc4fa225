// Where contacts remember: records at the slots of a list, which are its entries' numbers, read by every walk
// and written by the items that accept a step. One text for the CPU and CUDA.
#pragma once

#include <cstdint>

#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "mesh/surface_numbers.hpp"
#include "partition/halo_plan.hpp"
#include "partition/subdomain.hpp"

namespace scree {

// What a contact remembers is one or two Vec4s, whole sectors of memory, so that contacts here and there in
// the rows cost no more than their own. In w of the first: the number of the step that wrote them. What the
// last step did not write is of a contact that has ended: nothing need be cleared.
inline constexpr int kMostNumbers = 7;  // that a law may remember of a contact
SCREE_HD constexpr int records_of(int numbers) { return numbers <= 0 ? 0 : numbers <= 3 ? 1 : 2; }

// The k-th of the numbers.
template <class Record>
SCREE_HD auto& number_of(Record* records, int k) {
  return k == 0   ? records[0].x
         : k == 1 ? records[0].y
         : k == 2 ? records[0].z
         : k == 3 ? records[1].x
         : k == 4 ? records[1].y
         : k == 5 ? records[1].z
                  : records[1].w;
}

// Asks the memory for a record that will be read soon.
SCREE_HD void fetch_ahead(const Vec4* record) {
#ifdef __CUDA_ARCH__
  asm volatile("prefetch.global.L2 [%0];" ::"l"(record));
#else
  __builtin_prefetch(record, 1);
#endif
}

// Pointers are null where nobody remembers.
struct HistoryViews {
  Vec4* neighbors = nullptr;  // [slots][records]
  Vec4* ground = nullptr;     // [entries of the surfaces][records], of planes at rest
  // Likewise of placed surfaces, whose contacts are evaluated before the particles' walk: after the last
  // step, and after the step that is evaluated, if it is accepted. The latter is null where they are only
  // looked at.
  Vec4 *bodies = nullptr, *ahead = nullptr;
  // Of these the features of meshes, per entry, on sheets with the side (mesh/sheet_sides.hpp); where there
  // are no records kNoFeature is of none.
  Index *features = nullptr, *features_ahead = nullptr;
  Real step = 0;  // number of the last accepted step, above 0

  // For a look that leaves no trace.
  HistoryViews only_read() const {
    HistoryViews views = *this;
    views.ahead = nullptr;
    return views;
  }

  // What the contact at the slot remembers: what the law's read_history() makes of nothing but zeros where it
  // was not closed at the last step.
  template <class Law>
  SCREE_HD auto read(const Vec4* records, std::int64_t slot) const {
    constexpr int kRecords = records_of(Law::kHistory);
    Vec4 at[2];
    at[0] = records[slot * kRecords];
    const bool closed = at[0].w == step;
    if (kRecords > 1 && closed) at[1] = records[slot * kRecords + 1];
    return Law::read_history([&](int k) { return closed ? number_of(at, k) : Real(0); });
  }
  // The same of a contact that goes on from the one at the slot; -1: that has begun.
  template <class Law>
  SCREE_HD auto read_from(const Vec4* records, std::int64_t slot) const {
    if (slot >= 0) return read<Law>(records, slot);
    return Law::read_history([](int) { return Real(0); });
  }
  template <class Law, class History>
  SCREE_HD void write(Vec4* records, std::int64_t slot, const History& history) const {
    constexpr int kRecords = records_of(Law::kHistory);
    Vec4 at[2];
    Law::write_history(history, [&](int k, Real value) { number_of(at, k) = value; });
    at[0].w = step + 1;
    for (int r = 0; r < kRecords; ++r) records[slot * kRecords + r] = at[r];
  }
  // What the other side remembers of the contact, of the same step.
  template <class Law>
  static void mirror(const Vec4* records, Vec4* of_other) {
    const auto history = Law::read_history([&](int k) { return number_of(records, k); });
    Law::write_history(history.mirrored(), [&](int k, Real value) { number_of(of_other, k) = value; });
    of_other[0].w = records[0].w;
  }
  // The contact at the slot is open.
  template <class Law>
  SCREE_HD void write_none(Vec4* records, std::int64_t slot) const {
    records[slot * records_of(Law::kHistory)].w = 0;
  }
};

// What a contact of a particle is called while there is no list: like a row_key, surfaces counted past all
// particles, and of a mesh by the feature that it touches, too. The image is the one that the partner has
// beside the particle where both are in the periodic box, so that no name depends on when that was last seen
// to. One with a sheet that the particle's centre is past counts on from there.
inline constexpr GlobalId kFirstSurfaceId = GlobalId{1} << 48, kFirstPastId = 2 * kFirstSurfaceId,
                          kPartnersEnd = 3 * kFirstSurfaceId;
SCREE_HD GlobalId surface_id(Index surface, Index feature = 0, bool past = false) {
  return (past ? kFirstPastId : kFirstSurfaceId) + surface + (GlobalId{feature} << kSurfaceBits);
}
SCREE_HD bool is_surface(std::int64_t contact_key) { return contact_key >= 27 * kFirstSurfaceId; }
SCREE_HD bool is_past(std::int64_t contact_key) { return contact_key >= 27 * kFirstPastId; }
// Of a contact with a mesh.
SCREE_HD Index feature_of(std::int64_t contact_key) {
  return static_cast<Index>((contact_key / 27 % kFirstSurfaceId) >> kSurfaceBits);
}
// The number of the surface.
SCREE_HD Index surface_of(std::int64_t contact_key) {
  return static_cast<Index>(contact_key / 27 % kFirstSurfaceId & ((GlobalId{1} << kSurfaceBits) - 1));
}
// And on this side of it.
SCREE_HD std::int64_t without_feature(std::int64_t contact_key) {
  const GlobalId of_feature = GlobalId{feature_of(contact_key)} << kSurfaceBits;
  return contact_key - 27 * (is_past(contact_key) ? of_feature + kFirstSurfaceId : of_feature);
}

// Sides of the periodic box.
struct PeriodicBox {
  Vec3 min, period;  // [m]

  // Whether no period is to be taken off.
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
  // By how much a place is beyond the box that was in it when the list was built.
  SCREE_HD Vec3 beyond(Vec3 p) const {
    const auto axis = [](Real x, Real start, Real length) {
      return x < start ? -length : x >= start + length ? length : 0;
    };
    return {axis(p.x, min.x, period.x), axis(p.y, min.y, period.y), axis(p.z, min.z, period.z)};
  }
  // The same with images along the other axes alone.
  SCREE_HD PeriodicBox without(Vec3 spanned) const { return {min, period - spanned}; }
  // Number of the image of what lies at q and `image` periods on, beside p.
  SCREE_HD std::int8_t image_beside(Vec3 p, Vec3 q, std::int8_t image = kNoShift) const {
    if (holds(p) && holds(q)) return image;  // as nearly all are
    const ImageCount a = periods_at(p), b = periods_at(q);
    return static_cast<std::int8_t>(image + (b.x - a.x) + 3 * (b.y - a.y) + 9 * (b.z - a.z));
  }
};

}  // namespace scree
