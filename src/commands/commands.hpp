// What the commands do.
#pragma once

#include <string>

#include "base/error.hpp"
#include "commands/command_line.hpp"

namespace scree {

// Of the program, its compiler and its libraries; needs neither MPI nor PETSc to run.
std::string version_text();

// Starts MPI where the command needs it. Throws what the command's parts throw: InputError, IoError,
// SimulationError. Collective where a launcher has started several ranks.
ExitCode carry_out(const Order& order);

}  // namespace scree
