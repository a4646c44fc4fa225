// SIGTERM, SIGINT and SIGUSR1 ask for a checkpoint and a clean end; SLURM sends them before the time limit.
#pragma once

namespace scree {

void catch_signals();
// The signal that arrived, or 0.
int signal_received();

}  // namespace scree
