// Layout of the bodies' coordinates in the vectors of all bodies.
#pragma once

#include <algorithm>
#include <vector>

#include "model/data/bodies.hpp"

namespace scree {

// Bodies in the model's order. Columns are those of the velocities, the forces and the matrix.
//   planar: 3 positions (x, y, angle), 3 columns
//   spatial: 7 positions (x, y, z, quaternion), 6 columns (force; torque, in the body's frame)
class BodyLayout {
 public:
  explicit BodyLayout(const std::vector<Body>& bodies) {
    for (const Body& body : bodies) {
      offsets_.push_back({positions_, columns_});
      const bool spatial = body.kind == BodyKind::spatial;
      positions_ += spatial ? 7 : 3, columns_ += spatial ? 6 : 3;
    }
  }

  int bodies() const { return static_cast<int>(offsets_.size()); }
  int positions() const { return positions_; }
  int columns() const { return columns_; }
  // Index of the body's first coordinate.
  int position(int body) const { return offsets_[static_cast<std::size_t>(body)].position; }
  int column(int body) const { return offsets_[static_cast<std::size_t>(body)].column; }
  int body_of_column(int column) const {
    const auto after = std::upper_bound(offsets_.begin(), offsets_.end(), column,
                                        [](int c, const Offsets& at) { return c < at.column; });
    return static_cast<int>(after - offsets_.begin()) - 1;
  }

 private:
  struct Offsets {
    int position, column;
  };
  std::vector<Offsets> offsets_;
  int positions_ = 0, columns_ = 0;
};

}  // namespace scree
