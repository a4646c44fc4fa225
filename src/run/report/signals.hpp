// Signals that request a checkpoint and a clean end: SIGTERM, SIGINT, SIGUSR1, SIGUSR2, SIGXCPU, and SIGHUP
// unless it is ignored at the start (nohup). SLURM sends one of them before the time limit. SIGPIPE and
// SIGXFSZ are ignored: a run whose log has no reader continues, and a write beyond the limit of the file size
// fails like any other.
#pragma once

namespace scree {

// Installs the handlers, also for signals that were blocked at the start. Must be called again after the
// start of MPI, which may install handlers of its own.
void catch_signals();
// Number of the signal that has arrived on this rank, or 0.
int signal_received();

}  // namespace scree
