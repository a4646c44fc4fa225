// The loop over items. The CUDA room has a function of the same name that launches a kernel.
#pragma once

#include "base/types.hpp"

namespace scree {

struct Serial {};

// Calls item(i) for i = 0 ... n-1. An item reads views and writes only what belongs to i.
template <class Item>
void for_each(Serial, Index n, const Item& item) {
  for (Index i = 0; i < n; ++i) item(i);
}

}  // namespace scree
