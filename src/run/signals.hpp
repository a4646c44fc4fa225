// SIGTERM, SIGINT and SIGUSR1 ask for a checkpoint and a clean end; SLURM sends them before the time limit.
#pragma once

#include "partition/ranks.hpp"

namespace scree {

// Also where whoever started the program has blocked them. To be called again when MPI has started: what it
// is built on may put handlers of its own in the place of ours.
void catch_signals();
// The signal that has arrived on some rank, or 0. Collective.
int signal_received(const Ranks& ranks);

}  // namespace scree
