// Exceptions by kind of error, each with its exit code: of the user, of the simulation, of files.
#pragma once

#include <stdexcept>
#include <string>

#include "base/printable.hpp"

namespace scree {

// Exit codes of the program, listed in --help and in jobs/using.md.
enum class ExitCode : int {
  done = 0,
  bad_input = 2,
  simulation_failed = 3,
  io_failed = 4,
  stopped_by_signal = 5
};

// Error of the user: in the usage or the deck, or a deck that is too large for the machine. The message names
// file, line, key, value and the allowed values.
struct InputError : std::runtime_error {
  // The message may contain any text, also unprintable.
  explicit InputError(const std::string& message) : std::runtime_error(printable(message)) {}
};

// Error of the program, or a simulation that cannot continue. The message names stage, rank and global id or
// joint.
struct SimulationError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Failure of the GPU or its memory, which no shorter step can avoid.
struct DeviceError : SimulationError {
  using SimulationError::SimulationError;
};

// A file that cannot be read or written. The message names the file and the system's reason.
struct IoError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace scree
