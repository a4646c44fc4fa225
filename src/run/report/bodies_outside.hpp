// Bodies outside the domain: they are counted, and neither stopped nor removed.
#pragma once

#include <cstdint>
#include <string>

#include "mbs/multibody.hpp"
#include "model/data/model.hpp"

namespace scree {

// Number of bodies whose centre of mass is beyond a non-periodic side of the domain, wall or open, and the
// index of the first one in the deck's order.
struct BodiesOutside {
  std::int64_t count = 0;
  std::size_t first = 0;
};
// state: of rank 0; other ranks find no bodies.
BodiesOutside bodies_outside(const Model& model, const MultibodyState& state);
// The warning for a state at time t [s]; empty if no body is outside.
std::string bodies_outside_warning(const Model& model, const MultibodyState& state, Real t);

}  // namespace scree
