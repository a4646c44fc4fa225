// Positions of the shapes of one entry of a body's shapes: a single shape, a row, or an array or some of its
// sides.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "deck/deck.hpp"
#include "model/data/model.hpp"

namespace scree {

// Positions in the body's frame from its origin [m], along x first, then y, then z.
class ShapePositions {
 public:
  // Throws InputError for inconsistent keys.
  ShapePositions(const DeckTable& shape, int dimension);
  // Number of positions.
  std::int64_t count() const;
  // Calls visit(position) for each.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::int64_t k = 0; k < size_[2]; ++k)
      for (std::int64_t j = 0; j < size_[1]; ++j)
        for (std::int64_t i = 0; i < size_[0]; ++i)
          if (is_kept({i, j, k})) visit(place({i, j, k}));
  }
  // The outermost positions, whose bounding box contains all others.
  std::vector<Vec3> corners() const;

 private:
  using Number = std::array<std::int64_t, 3>;
  void read_row(const DeckTable& shape);
  void read_array(const DeckTable& shape, int dimension);
  void read_sides(const DeckTable& shape, int dimension);
  bool is_kept(const Number& number) const;
  Vec3 place(const Number& number) const;

  Number size_{1, 1, 1};
  Vec3 first_;
  std::array<Vec3, 3> step_{};  // from each shape to the next along an axis of the array [m]
  bool all_ = true;             // all positions of the array, otherwise only those on these sides
  std::array<bool, kSides> sides_{};
};

}  // namespace scree
