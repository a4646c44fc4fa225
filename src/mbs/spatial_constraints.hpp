// Rows of Phi between spatial bodies.
#pragma once

#include <memory>

#include "mbs/constraints.hpp"
#include "mbs/primitive_function.hpp"

namespace scree {

// The points coincide: C = d. Three rows, along the global axes.
std::unique_ptr<Constraint> coincidence_constraint(const SpatialPair& pair);
// C = c - f(t). One row.
std::unique_ptr<Constraint> primitive_constraint(std::unique_ptr<PrimitiveFunction> c, ScalarFunction f);

}  // namespace scree
