#include "partition/mpi_session.hpp"

#include <fmt/format.h>
#include <mpi.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "base/log.hpp"

namespace scree {
namespace {

bool starting = false;

std::string environment(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

bool runs() {
  int started = 0, ended = 0;
  MPI_Initialized(&started), MPI_Finalized(&ended);
  return started != 0 && ended == 0;
}

// The system's reason why no file can be created in the folder for temporary files; empty if one can.
std::string temporary_folder_error(const std::string& folder) {
  std::string path = folder + "/scree_XXXXXX";
  if (mkdtemp(path.data()) == nullptr) return std::strerror(errno);
  rmdir(path.c_str());
  return "";
}

// Prints a remedy before the library ends the process because it cannot start.
void print_remedy() {
  if (!std::exchange(starting, false)) return;
  const std::string named = environment("TMPDIR"), folder = named.empty() ? "/tmp" : named,
                    trouble = temporary_folder_error(folder);
  const std::string advice = !trouble.empty()
                                 ? fmt::format(
                                       "MPI needs a folder for temporary files, but cannot write into {}{}: "
                                       "{}; name another folder with TMPDIR=",
                                       folder, named.empty() ? "" : ", which TMPDIR names", trouble)
                                 : "under srun, --mpi= must name the interface this library was built with "
                                   "(srun --mpi=list); if the library asks for ssh or rsh and there is none, "
                                   "as in a container, set OMPI_MCA_plm_rsh_agent= (empty)";
  const std::string line =
      message_line("error", "MPI cannot start, for the reason given above. Remedy: " + advice);
  std::fputs(line.c_str(), stderr);
  std::fflush(nullptr);
  syscall(SYS_exit_group, static_cast<int>(ExitCode::simulation_failed));
}

}  // namespace
}  // namespace scree

// When MPI_Init() fails, Open MPI ends the process through this function of the C library, which calls no
// handlers of exit(). There is no other way to print a last message.
extern "C" void _exit(int code) {
  scree::print_remedy();
  for (;;) syscall(SYS_exit_group, code);
}

namespace scree {

bool launched_with_others() {
  // The variables of Open MPI; of PMI, used by MPICH, Intel MPI and Cray's launchers; of MVAPICH; of a step
  // of Slurm; of Flux; and of IBM's launcher. A batch script itself has no Slurm step.
  for (const char* const ranks :
       {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MPI_LOCALNRANKS", "MV2_COMM_WORLD_SIZE", "SLURM_STEP_NUM_TASKS",
        "FLUX_JOB_SIZE", "JSM_NAMESPACE_SIZE"})
    if (std::atoi(environment(ranks).c_str()) > 1) return true;
  // Launchers that use PMIx may set the rank alone.
  const bool sized =
      !environment("OMPI_COMM_WORLD_SIZE").empty() || !environment("SLURM_STEP_NUM_TASKS").empty();
  return !sized && !environment("PMIX_RANK").empty();
}

void start_mpi() {
  if (runs()) return;
  // To a process started without a launcher Open MPI adds a daemon, which could start other processes, and
  // which requires ssh. Without the daemon all such processes of a user share one session directory, which
  // each of them creates and removes: when several start at a time, some fail. A single process needs none.
  if (!launched_with_others()) {
    setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
    setenv("OMPI_MCA_orte_create_session_dirs", "0", 0);
  }
  static const int registered = std::atexit(print_remedy);
  starting = registered == 0;
  MPI_Init(nullptr, nullptr);
  starting = false;
}

void end_mpi() {
  if (runs()) MPI_Finalize();
}

}  // namespace scree
