// The neighbour list of one rank, who owns which particles, and the bodies' shapes that move on the list.
#pragma once

#include <cstdint>
#include <span>

#include "base/timer.hpp"
#include "base/types.hpp"
#include "model/data/body_exchange.hpp"
#include "partition/decomposition.hpp"

namespace scree {

// What stands before and after the id of a particle that wrap_if_sound() refuses.
inline constexpr const char* kUnsoundPosition[] = {
    "stage sort_cells: the position of particle ",
    " is not finite, or it crossed the whole periodic space since the last list"};

// What countable() says of a rank's own particles, and of those with its ghosts.
inline constexpr const char* kTooManyParticles = "stage migrate: more particles";
inline constexpr const char* kTooManyItems = "stage exchange_halo: more particles and ghosts";

// displacement() and build() are collective (see Backend). Both may be called while a run of explicit steps
// is open; a list is not built while an implicit step is.
class RankList {
 public:
  virtual ~RankList() = default;

  virtual void place_bodies(std::span<const BodyMotion> motion) = 0;
  // Of any item since the list was built, over half the skin that the list covers; past 1 the list has
  // expired. Returns when all that was asked of the machine is done.
  virtual Real displacement() = 0;
  // skin: reach past touching [m].
  virtual void build(Real skin, StageTimers& timers) = 0;

  virtual std::int64_t entries() const = 0;  // of this rank
  virtual std::int64_t builds() const = 0;   // since the backend was made
  virtual LoadBalance balance() const = 0;
};

}  // namespace scree
