// Points sorted into cells, for neighbour searches.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "model/data/share.hpp"

namespace scree {

// A box divided into cells. Points outside belong to the nearest cell.
class PointCells {
 public:
  // min, max: box of the points [m]. reach: two points at most this far apart are in the same cell or in
  // neighbouring cells [m]. expected: approximate number of points, which bounds the number of cells.
  PointCells(Vec3 min, Vec3 max, Real reach, std::size_t expected) : min_(min) {
    const Vec3 extent = max - min;
    const Real most = 4 * static_cast<Real>(expected) + 64;
    size_ = reach;
    while (cells_along(extent.x) * cells_along(extent.y) * cells_along(extent.z) > most) size_ *= 1.25;
    cells_ = {static_cast<int>(cells_along(extent.x)), static_cast<int>(cells_along(extent.y)),
              static_cast<int>(cells_along(extent.z))};
  }

  std::size_t count() const { return static_cast<std::size_t>(cells_[0]) * cells_[1] * cells_[2]; }
  std::size_t slot_of(Vec3 p) const {
    const std::array<int, 3> c = cell_of(p);
    return slot(c[0], c[1], c[2]);
  }

  // Calls visit(first, last) for the rows of cells around a point, as ranges [first, last) of cells, the
  // point's own row first. Stops and returns false where visit does.
  template <class Visit>
  bool for_rows(Vec3 p, const Visit& visit) const {
    const std::array<int, 3> c = cell_of(p);
    const int first = std::max(c[0] - 1, 0), last = std::min(c[0] + 2, cells_[0]);
    for (const int z : {c[2], c[2] - 1, c[2] + 1}) {
      if (z < 0 || z >= cells_[2]) continue;
      for (const int y : {c[1], c[1] - 1, c[1] + 1}) {
        if (y < 0 || y >= cells_[1]) continue;
        if (!visit(slot(first, y, z), slot(last, y, z))) return false;
      }
    }
    return true;
  }

 private:
  Real cells_along(Real length) const { return std::max(Real(1), std::floor(length / size_)); }
  // Clamping never increases the distance of two points, so neighbours stay in neighbouring cells.
  int clamped(Real offset, int cells) const {
    return static_cast<int>(std::clamp(std::floor(offset / size_), Real(0), static_cast<Real>(cells - 1)));
  }
  std::array<int, 3> cell_of(Vec3 p) const {
    const Vec3 d = p - min_;
    return {clamped(d.x, cells_[0]), clamped(d.y, cells_[1]), clamped(d.z, cells_[2])};
  }
  std::size_t slot(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * cells_[1] + y) * cells_[0] + x;
  }

  Vec3 min_;
  Real size_ = 1;
  std::array<int, 3> cells_{1, 1, 1};
};

// Points in cells, to which more can be added at any time.
class GrowingBins {
 public:
  GrowingBins(const PointCells& cells, std::size_t expected) : cells_(cells), head_(cells.count(), -1) {
    entries_.reserve(expected);
  }

  void insert(Vec3 point, Real radius) {
    int& head = head_[cells_.slot_of(point)];
    entries_.push_back({point, radius, head});
    head = static_cast<int>(entries_.size()) - 1;
  }

  // Whether a sphere at `point` has a distance of at least `gap` to the surfaces of all.
  bool is_clear(Vec3 point, Real radius, Real gap) const {
    return cells_.for_rows(point, [&](std::size_t first, std::size_t last) {
      for (std::size_t slot = first; slot < last; ++slot) {
        for (int i = head_[slot]; i >= 0;) {
          const Entry& entry = entries_[static_cast<std::size_t>(i)];
          if (!(norm(point - entry.position) >= radius + entry.radius + gap)) return false;
          i = entry.next;
        }
      }
      return true;
    });
  }

 private:
  struct Entry {
    Vec3 position;  // [m]
    Real radius;    // [m]
    int next;       // the previous entry of the same cell; -1: none
  };

  PointCells cells_;
  std::vector<int> head_;  // per cell its newest entry
  std::vector<Entry> entries_;
};

// Points in cells, all known from the start; those of a row of cells are contiguous.
class SortedBins {
 public:
  SortedBins(const PointCells& cells, const std::vector<StartItem>& items)
      : cells_(cells), first_(cells.count() + 1), items_(items.size()) {
    for (const StartItem& item : items) ++first_[cells_.slot_of(item.position) + 1];
    for (std::size_t slot = 1; slot < first_.size(); ++slot) first_[slot] += first_[slot - 1];
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (const StartItem& item : items) items_[next[cells_.slot_of(item.position)]++] = item;
  }

  // Sorted by cell.
  const std::vector<StartItem>& items() const { return items_; }

  template <class Visit>
  void for_near(Vec3 point, const Visit& visit) const {
    cells_.for_rows(point, [&](std::size_t first, std::size_t last) {
      for (std::uint32_t i = first_[first]; i < first_[last]; ++i) visit(items_[i]);
      return true;
    });
  }

 private:
  PointCells cells_;
  std::vector<std::uint32_t> first_;  // per cell its first item
  std::vector<StartItem> items_;
};

}  // namespace scree
