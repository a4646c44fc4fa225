// Where the shapes are that one entry of a body's shapes makes: one, a row, or an array and its sides.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "deck/deck.hpp"
#include "model/data/model.hpp"

namespace scree {

// Places in the body's frame, from its origin [m]; along x first, then y, then z.
class ShapePlaces {
 public:
  // Throws InputError for keys that do not go together.
  ShapePlaces(const DeckTable& shape, int dimension);
  // How many there are.
  std::int64_t count() const;
  // Calls visit(place) for each.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::int64_t k = 0; k < size_[2]; ++k)
      for (std::int64_t j = 0; j < size_[1]; ++j)
        for (std::int64_t i = 0; i < size_[0]; ++i)
          if (is_kept({i, j, k})) visit(place({i, j, k}));
  }
  // The outermost ones, between which all others lie.
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
  std::array<Vec3, 3> step_{};  // from each to the next along an axis of the array [m]
  bool all_ = true;             // else those on these sides alone
  std::array<bool, kSides> sides_{};
};

}  // namespace scree
