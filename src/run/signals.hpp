// SIGTERM, SIGINT and SIGUSR1 ask for a checkpoint and a clean end; SLURM sends them before the time limit.
#pragma once

#include "partition/ranks.hpp"

namespace scree {

// May be called again: libraries that are started later may put handlers of their own in the place of ours, as
// some releases of NCCL and of what MPI is built on do.
void catch_signals();
// The signal that has arrived on some rank, or 0. Collective.
int signal_received(const Ranks& ranks);

}  // namespace scree
