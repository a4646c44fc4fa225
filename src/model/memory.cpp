#include "model/memory.hpp"

#include <fmt/format.h>

namespace scree {

std::string memory_trouble(std::int64_t particles, int ranks) {
  const Real all = kBytesPerParticle * static_cast<Real>(particles) / 1e9;
  const std::string where =
      ranks == 1 ? "on one rank" : fmt::format("on {} ranks, {:.3g} GB on each", ranks, all / ranks);
  return fmt::format(
      "not enough memory: a run of {} particles takes about {:.3g} GB {}; start more ranks on more machines "
      "(mpirun "
      "-n), or take fewer particles",
      particles, all, where);
}

}  // namespace scree
