// The commands of the program.
#pragma once

#include <string>

#include "base/error.hpp"
#include "commands/command_line.hpp"

namespace scree {

// Versions of the program, its compiler and its libraries; needs neither MPI nor PETSc running.
std::string version_text();

// Carries out the command; starts MPI if the command needs it. Throws InputError, IoError and
// SimulationError. Collective if a launcher has started several ranks.
ExitCode carry_out(const Order& order);

}  // namespace scree
