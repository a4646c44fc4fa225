// Interface through which the step loop records results.
#pragma once

#include "base/types.hpp"
#include "run/state/state.hpp"

namespace scree {

// The step loop calls these functions when the state has reached an output time.
class Records {
 public:
  virtual ~Records() = default;

  // h: length of the last step [s]. Updates the energy balance in the state, and the number of rows there.
  virtual void history(State& state, Real h) = 0;
  // Updates the extremes of the energies in the state's balance: see next_energy_sample().
  virtual void sample_energies(State& state) = 0;
  // Takes a snapshot, which may be written later, and updates the number of snapshots in the state.
  virtual void snapshot(State& state) = 0;
  // Whether a stop condition of the deck is met at the last row of the history; the same on every rank.
  virtual bool should_end() const { return false; }
  // Writes a snapshot that was taken but not yet written.
  virtual void write_pending() = 0;
};

}  // namespace scree
