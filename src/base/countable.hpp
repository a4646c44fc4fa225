// Counts on one rank, which an Index must hold.
#pragma once

#include <cstddef>
#include <limits>
#include <string>

#include "base/error.hpp"
#include "base/types.hpp"

namespace scree {

// The count as an Index. Throws SimulationError where it is too large; what: "stage neighbors: more
// neighbours".
inline Index countable(std::size_t count, const char* what) {
  if (count > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
    throw SimulationError(std::string(what) + " than one rank can count; more ranks have fewer each");
  return static_cast<Index>(count);
}

}  // namespace scree
