// Where a body's coordinates stand in the vectors of all bodies.
#pragma once

#include <vector>

#include "model/bodies.hpp"

namespace scree {

// Of bodies in the model's order. A planar body has 3 positions (x, y, angle) and as many columns: those of
// the velocities, the forces and the matrix.
class BodyLayout {
 public:
  explicit BodyLayout(const std::vector<Body>& bodies) : bodies_(static_cast<int>(bodies.size())) {}

  int bodies() const { return bodies_; }
  int positions() const { return 3 * bodies_; }
  int columns() const { return 3 * bodies_; }
  // The first one of a body.
  int position(int body) const { return 3 * body; }
  int column(int body) const { return 3 * body; }
  int body_of_column(int column) const { return column / 3; }

 private:
  int bodies_;
};

}  // namespace scree
