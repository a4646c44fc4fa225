// Particles that are born during a run, on several ranks. Shared by the CPU and CUDA backends.
#pragma once

#include <cstdint>
#include <vector>

#include "dem/particles/particle_fields.hpp"
#include "partition/decomposition.hpp"
#include "partition/ranks.hpp"

namespace scree {

// The particles whose positions belong to this rank. decomposition: none on a single rank.
inline std::vector<Particle> owned_by(const Ranks& ranks, const Decomposition& decomposition,
                                      const std::vector<Particle>& particles) {
  if (ranks.alone()) return particles;
  std::vector<Particle> own;
  for (const Particle& p : particles)
    if (decomposition.owner(p.position) == ranks.rank()) own.push_back(p);
  return own;
}

// 1 for the entries that are not 0 on any rank. Collective.
inline std::vector<std::uint8_t> on_any_rank(const Ranks& ranks, std::vector<std::uint8_t> flags) {
  if (ranks.alone()) return flags;
  std::vector<std::int64_t> sums(flags.begin(), flags.end());
  ranks.sum(std::span<std::int64_t>(sums));
  for (std::size_t k = 0; k < flags.size(); ++k) flags[k] = sums[k] != 0;
  return flags;
}

}  // namespace scree
