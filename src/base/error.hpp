// The two kinds of wrong (and a failing disk): each is an exception with its own exit code.
#pragma once

#include <stdexcept>
#include <string>

#include "base/printable.hpp"

namespace scree {

// Exit codes of the program; listed in --help and in jobs/using.md.
enum class ExitCode : int {
  done = 0,
  bad_input = 2,
  simulation_failed = 3,
  io_failed = 4,
  stopped_by_signal = 5
};

// The user's: bad usage or deck, or a deck that is too large for the machine. The message names file, line,
// key, value and what is allowed.
struct InputError : std::runtime_error {
  // The message may quote anything.
  explicit InputError(const std::string& message) : std::runtime_error(printable(message)) {}
};

// Ours, or a simulation that cannot go on. The message names stage, rank and global id or joint.
struct SimulationError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The GPU or its memory fails: no shorter step helps.
struct DeviceError : SimulationError {
  using SimulationError::SimulationError;
};

// A file that cannot be read or written. The message names the file and the system's reason.
struct IoError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace scree
