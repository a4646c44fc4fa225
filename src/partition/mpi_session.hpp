// Start and end of MPI. A single process needs no MPI for commands that login nodes and containers run:
// version, keys, status of a run, check of a deck.
#pragma once

namespace scree {

// Whether a launcher (mpirun, srun, ...) has started this process as one of several ranks, according to its
// environment: MPI itself tells only after its start.
bool launched_with_others();

// Starts MPI if it is not running. If the library cannot start, it prints its own messages and ends the
// process; a line with a remedy follows, and the exit code is that of a failed simulation.
void start_mpi();
// Ends MPI if it is running.
void end_mpi();

}  // namespace scree
