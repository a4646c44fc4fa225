// Signals that ask for a checkpoint and a clean end: SIGTERM, SIGINT, SIGUSR1, SIGUSR2, SIGXCPU, and SIGHUP
// unless whoever started the program had it ignored (nohup). SLURM sends one before the time limit. SIGPIPE
// and SIGXFSZ are ignored: nobody reads the log any longer, and the run goes on; a file may not grow any
// longer, and the write fails like any other.
#pragma once

namespace scree {

// Also where whoever started the program has blocked them. To be called again when MPI has started: what it
// is built on may put handlers of its own in the place of ours.
void catch_signals();
// The signal that has arrived on this rank, or 0.
int signal_received();

}  // namespace scree
