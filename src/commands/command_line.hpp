// The arguments of the command line.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace scree {

enum class Command { help, run, check, keys, new_deck, status };

// The parsed command line. Paths and names that are given are not empty.
struct Order {
  Command command = Command::help;
  std::string help;  // text to print; also for --version
  std::string deck, output, backend, restart, picture;
  std::vector<std::string> overrides;  // KEY=VALUE
  std::string trace;                   // file of a timeline, and its steps
  std::int64_t trace_from = 0, trace_steps = 200;
  bool overwrite = false, allow_changes = false;
  bool as_markdown = false, as_schema = false;
  std::optional<std::string> about;  // print the keys on this word instead of all keys
  std::string example, file;         // name and file of a new deck
  std::vector<std::string> folders;
  std::vector<std::string> petsc_arguments;  // arguments after --
  std::string text;                          // all arguments, separated by blanks
};

// Parses the arguments. Throws InputError if one is unknown or incomplete. version: returns the text for
// --version.
Order parse_command_line(int count, char** values, const std::function<std::string()>& version);

}  // namespace scree
