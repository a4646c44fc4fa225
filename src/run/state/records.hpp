// What takes down what a run computes.
#pragma once

#include "base/types.hpp"
#include "run/state/state.hpp"

namespace scree {

// The step loop calls it when the state has reached an output's time.
class Records {
 public:
  virtual ~Records() = default;

  // h: length of the step just taken [s]. Books the energy balance in the state and counts the row there.
  virtual void history(State& state, Real h) = 0;
  // Takes the extremes of the energies at this instant into the state's balance: see next_energy_sample().
  virtual void sample_energies(State& state) = 0;
  // Counts it in the state; may write it later.
  virtual void snapshot(State& state) = 0;
  // Writes what was taken and not yet written.
  virtual void write_pending() = 0;
};

}  // namespace scree
