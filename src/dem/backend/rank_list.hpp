// Neighbour list of one rank, ownership of particles, and the motion of bodies relative to the list.
#pragma once

#include <cstdint>
#include <span>

#include "base/timer.hpp"
#include "base/types.hpp"
#include "model/data/body_exchange.hpp"
#include "partition/decomposition.hpp"

namespace scree {

// Error text before and after the id of a particle that wrap_if_sound() rejects.
inline constexpr const char* kUnsoundPosition[] = {
    "stage sort_cells: the position of particle ",
    " is not finite, or it crossed the whole periodic domain since the last list"};

// Error texts of countable() for a rank's own particles, and for these with ghosts.
inline constexpr const char* kTooManyParticles = "stage migrate: more particles";
inline constexpr const char* kTooManyItems = "stage exchange_halo: more particles and ghosts";

// displacement(), choose_skin() and build() are collective (see Backend). They may be called within a run of
// explicit steps; build() not within an implicit step.
class RankList {
 public:
  virtual ~RankList() = default;

  virtual void set_body_motion(std::span<const BodyMotion> motion) = 0;
  // Largest displacement of any item since the list was built, over half its skin; above 1 the list has
  // expired. Waits for all queued work.
  virtual Real displacement() = 0;
  // skin: search distance beyond touch [m].
  virtual void build(Real skin, StageTimers& timers) = 0;

  virtual std::int64_t entries() const = 0;  // of this rank
  virtual std::int64_t builds() const = 0;   // since the backend was made
  virtual LoadBalance balance() const = 0;

  // Skin for the next list [m]: that of the deck, or chosen from how fast the present list expires
  // (`SkinChoice`). Collective.
  virtual Real choose_skin() = 0;
  virtual Real skin() const = 0;  // of the present list [m]
};

}  // namespace scree
