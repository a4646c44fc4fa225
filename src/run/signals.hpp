// SIGTERM, SIGINT and SIGUSR1 ask for a checkpoint and a clean end; SLURM sends them before the time limit.
#pragma once

#include "partition/ranks.hpp"

namespace scree {

void catch_signals();
// The signal that has arrived on some rank, or 0. Collective.
int signal_received(const Ranks& ranks);

}  // namespace scree
