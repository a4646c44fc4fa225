// What a model takes, and the message where there is not so much.
#pragma once

#include <cstdint>
#include <new>
#include <string>

#include "base/error.hpp"
#include "base/types.hpp"

namespace scree {

// Estimate of what one particle of a run keeps in memory [B]: state, scratch and a list of some ten
// neighbours.
constexpr Real kBytesPerParticle = 600;

// How many particles there are, about what they take and what to do. particles: of all ranks.
std::string memory_trouble(std::int64_t particles, int ranks);

// Runs an action on behalf of a run of so many particles, whose number may become known on the way. Throws
// InputError where it runs out of memory.
template <class Action>
auto naming_memory(const std::int64_t& particles, int ranks, const Action& action) {
  try {
    return action();
  } catch (const std::bad_alloc&) {
    throw InputError(memory_trouble(particles, ranks));
  }
}

}  // namespace scree
