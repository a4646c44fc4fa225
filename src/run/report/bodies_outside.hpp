// Bodies that have left the space. Nothing stops or removes them: they are counted.
#pragma once

#include <cstdint>
#include <string>

#include "mbs/multibody.hpp"
#include "model/data/model.hpp"

namespace scree {

// How many bodies have their centre beyond a side of the space that is not periodic, wall or open, and the
// first of them in the deck's order.
struct BodiesOutside {
  std::int64_t count = 0;
  std::size_t first = 0;
};
// state: of rank 0; no bodies are outside on others.
BodiesOutside bodies_outside(const Model& model, const MultibodyState& state);
// Of a state at time t [s]; empty where none is outside.
std::string bodies_outside_warning(const Model& model, const MultibodyState& state, Real t);

}  // namespace scree
