// The serial loop over items. The CUDA code has a function of the same name that launches a kernel.
#pragma once

#include <limits>

#include "base/types.hpp"

namespace scree {

struct Serial {};

// Calls item(i) for i = 0 ... n-1. An item reads views and writes only what belongs to i.
template <class Item>
void for_each(Serial, Index n, const Item& item) {
  for (Index i = 0; i < n; ++i) item(i);
}

// Largest of the values item(i) for i = 0 ... n-1, at least 0. A NaN makes the result a NaN.
template <class Item>
Real max_over(Serial, Index n, const Item& item) {
  Real largest = 0;
  bool finite = true;
  for (Index i = 0; i < n; ++i) {
    const Real value = item(i);
    largest = value > largest ? value : largest;
    finite = finite && value == value;
  }
  return finite ? largest : std::numeric_limits<Real>::quiet_NaN();
}

}  // namespace scree
