// Counts on one rank that must fit into an Index.
#pragma once

#include <cstddef>
#include <limits>
#include <string>

#include "base/error.hpp"
#include "base/types.hpp"

namespace scree {

// The count as an Index. Throws SimulationError if it is too large. what: start of the message, "stage
// neighbors: more neighbours".
inline Index countable(std::size_t count, const char* what) {
  if (count > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
    throw SimulationError(std::string(what) + " than one rank can count; more ranks have fewer each");
  return static_cast<Index>(count);
}

}  // namespace scree
