// Particles born and removed so far, as part of the state of a run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/fixed_sum.hpp"
#include "base/types.hpp"

namespace scree {

// Numbers per particle in PopulationState::waiting.
inline constexpr std::size_t kWaitingNumbers = 3;

// All arrays are empty in a model without inserters. Particle n of an inserter, n from 0, is the same
// whenever it is born.
struct PopulationState {
  std::vector<std::int64_t> due;       // particles that were due so far, per inserter
  std::vector<std::int64_t> dropped;   // of these, left out because no position was free
  std::vector<std::int64_t> tried;     // positions tried so far, per inserter
  std::vector<std::int64_t> instants;  // instants of births reached, per inserter
  std::vector<std::int64_t> classes;   // particles due of each class of the mixtures, inserter after inserter
  std::vector<Real> amounts;           // of the due particles, per inserter, in the unit of its schedule
  // Particles that wait for a free position: inserter, n and class of each, in the order of n per inserter.
  std::vector<std::int64_t> waiting;
  std::vector<std::int64_t> mass;  // FixedSum of the masses of all particles born: its words
  std::vector<Real> energy;        // kinetic and gravitational energy of these at birth [J]: one number

  std::int64_t waiting_of(int inserter) const {
    std::int64_t count = 0;
    for (std::size_t k = 0; k < waiting.size(); k += kWaitingNumbers) count += waiting[k] == inserter;
    return count;
  }
  std::int64_t born_of(int inserter) const {
    const auto i = static_cast<std::size_t>(inserter);
    return due[i] - dropped[i] - waiting_of(inserter);
  }
  std::int64_t born() const {
    std::int64_t sum = 0;
    for (int i = 0; i < std::ssize(due); ++i) sum += born_of(i);
    return sum;
  }
  Real born_mass() const {  // [kg]
    FixedSum sum;
    for (std::size_t k = 0; k < mass.size(); ++k) sum.word[k] = mass[k];
    return sum.value();
  }
  Real born_energy() const { return energy.empty() ? 0 : energy.front(); }  // [J]
};

}  // namespace scree
