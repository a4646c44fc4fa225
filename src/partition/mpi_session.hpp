// Starting and ending MPI. A process that nobody else was started with needs none for what a login node or a
// container is asked for: the version, the keys, the status of a run, the check of a deck.
#pragma once

namespace scree {

// Whether mpirun, srun or another launcher has started this process as one of several ranks, as its
// environment says: MPI itself tells only once it runs.
bool launched_with_others();

// Starts MPI, where it does not run yet. Where the library cannot start, it ends the process after words of
// its own; then a line says what helps, and the exit code is that of a failed simulation.
void start_mpi();
// Ends MPI where it runs.
void end_mpi();

}  // namespace scree
