// Sizes of records that the host and the kernels share, as each of them counts.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace scree {

struct Layout {
  std::string name;    // of the type
  std::size_t host;    // sizeof [bytes]
  std::size_t device;  // distance of two elements of an array in code that nvcc has generated [bytes]
};

std::vector<Layout> layouts_on_device();

}  // namespace scree
