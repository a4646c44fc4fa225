// Points sorted into cells, to find those near a place. Points can be added at any time.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"

namespace scree {

class PointBins {
 public:
  // min, max: box of the points [m]; those outside count to the nearest cell. reach: for_near() finds every
  // point at most this far away [m]. expected: about how many points there will be; bounds the number of
  // cells.
  PointBins(Vec3 min, Vec3 max, Real reach, std::size_t expected) : min_(min) {
    const Vec3 extent = max - min;
    const Real most = 4 * static_cast<Real>(expected) + 64;
    size_ = reach;
    while (cells_along(extent.x) * cells_along(extent.y) * cells_along(extent.z) > most) size_ *= 1.25;
    cells_ = {static_cast<int>(cells_along(extent.x)), static_cast<int>(cells_along(extent.y)),
              static_cast<int>(cells_along(extent.z))};
    head_.assign(static_cast<std::size_t>(cells_[0]) * cells_[1] * cells_[2], -1);
  }

  // The point gets the next number, counted from 0.
  void insert(Vec3 point) {
    const std::array<int, 3> c = cell_of(point);
    int& head = head_[slot(c[0], c[1], c[2])];
    next_.push_back(head);
    head = static_cast<int>(next_.size()) - 1;
  }

  // Calls visit(number) for the points in the cells around; stops where it returns false, and then returns
  // false.
  template <class Visit>
  bool for_near(Vec3 point, const Visit& visit) const {
    const std::array<int, 3> c = cell_of(point);
    std::array<int, 3> low, high;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::max(c[axis] - 1, 0);
      high[axis] = std::min(c[axis] + 1, cells_[axis] - 1);
    }
    for (int z = low[2]; z <= high[2]; ++z) {
      for (int y = low[1]; y <= high[1]; ++y) {
        for (int x = low[0]; x <= high[0]; ++x) {
          for (int i = head_[slot(x, y, z)]; i >= 0; i = next_[static_cast<std::size_t>(i)]) {
            if (!visit(i)) return false;
          }
        }
      }
    }
    return true;
  }

 private:
  Real cells_along(Real length) const { return std::max(Real(1), std::floor(length / size_)); }
  // Clamping never moves two points further apart, so neighbours stay in neighbouring cells.
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
  std::vector<int> head_,
      next_;  // per cell its newest point, per point the one before it in the cell; -1: none
};

}  // namespace scree
