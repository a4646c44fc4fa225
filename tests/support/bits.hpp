// States compared bit for bit.
#pragma once

#include <cstring>
#include <string>

#include "run/state.hpp"
#include "support/checkpoint_arrays.hpp"
#include "support/simulation_run.hpp"

namespace scree {

inline bool same_bits(const std::vector<Real>& a, const std::vector<Real>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Real)) == 0);
}

// Names of the arrays that differ in a bit, or that only one of the two has; "" if there is none.
inline std::string differing_arrays(const Checkpoint& one, const Checkpoint& other) {
  const Checkpoint a = with_rows_as_arrays(one), b = with_rows_as_arrays(other);
  std::string names;
  for (const auto& [name, values] : a.reals)
    if (!b.reals.count(name) || !same_bits(values, b.reals.at(name))) names += name + " ";
  for (const auto& [name, values] : a.integers)
    if (!b.integers.count(name) || values != b.integers.at(name)) names += name + " ";
  if (a.reals.size() != b.reals.size() || a.integers.size() != b.integers.size()) names += "(other arrays)";
  return names;
}

// One history sample of a run in memory: time, counts, ledger, momentum.
inline std::vector<Real> history_row(SimulationRun& run) {
  const StepCounts& n = run.counts();
  std::vector<Real> row{run.time(), run.balance_error(), run.exchanged()};
  for (const std::int64_t count :
       {n.steps, n.newton_iterations, n.linear_iterations, n.rejected_error, n.rejected_newton})
    row.push_back(static_cast<Real>(count));
  for (const Real entry : run.ledger().entries()) row.push_back(entry);
  const ParticleLedger particles = run.particle_ledger();
  for (const Vec3& v : {particles.momentum, particles.angular_momentum})
    row.insert(row.end(), {v.x, v.y, v.z});
  return row;
}

}  // namespace scree
