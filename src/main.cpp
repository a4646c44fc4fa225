// The program: signals, MPI, and the exit code of the command.
#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <iostream>
#include <new>
#include <span>
#include <string_view>

#include "base/error.hpp"
#include "base/log.hpp"
#include "commands/command_line.hpp"
#include "commands/commands.hpp"
#include "partition/mpi_session.hpp"
#include "partition/ranks.hpp"
#include "run/report/signals.hpp"

namespace scree {
namespace {

ExitCode guarded(const std::function<ExitCode()>& body) {
  const auto report = [](const char* what, ExitCode code) {
    Ranks::world().error_barrier(what, static_cast<int>(code));
    if (Ranks::world().is_root()) std::cerr << message_line("error", what);
    return code;
  };
  try {
    return body();
  } catch (const InputError& error) {
    return report(error.what(), ExitCode::bad_input);
  } catch (const IoError& error) {
    return report(error.what(), ExitCode::io_failed);
  } catch (const std::filesystem::filesystem_error& error) {
    return report(error.what(), ExitCode::io_failed);
  } catch (const std::bad_alloc&) {
    return report("not enough memory: the deck is too large for this machine", ExitCode::bad_input);
  } catch (const std::exception& error) {
    return report(error.what(), ExitCode::simulation_failed);
  }
}

// Without a launcher, MPI passes the command line on in one environment variable, which the system limits to
// 128 KiB. Returns the error message for a longer command line, else an empty text.
std::string command_line_error(int count, char** values) {
  constexpr std::size_t kLongest = 110000, kShown = 80;  // [B]
  std::size_t length = 0;
  std::string_view longest;
  for (const std::string_view argument : std::span(values, static_cast<std::size_t>(count))) {
    length += argument.size() + 1;
    if (argument.size() > longest.size()) longest = argument;
  }
  if (length <= kLongest) return "";
  return fmt::format(
      "--set or another argument, {}: the command line has {} bytes, at most {} are allowed; the length of a "
      "deck is not limited",
      shortened(std::string(longest), kShown), length, kLongest);
}

}  // namespace
}  // namespace scree

int main(int count, char** values) {
  if (const std::string trouble = scree::command_line_error(count, values); !trouble.empty()) {
    std::cerr << scree::message_line("error", trouble);
    return static_cast<int>(scree::ExitCode::bad_input);
  }
  const bool is_run = count > 1 && std::string_view(values[1]) == "run";
  if (is_run) scree::catch_signals();  // already before MPI starts, which takes a while
  if (scree::launched_with_others()) scree::start_mpi();
  const scree::ExitCode code = scree::guarded(
      [&] { return scree::carry_out(scree::parse_command_line(count, values, scree::version_text)); });
  scree::end_mpi();
  return static_cast<int>(code);
}
