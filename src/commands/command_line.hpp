// The words of the command line.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace scree {

enum class Command { help, run, check, keys, new_deck, status };

// What the words ask for. Paths and names are not empty where they are given.
struct Order {
  Command command = Command::help;
  std::string help;  // the text that was asked for, version included
  std::string deck, output, backend, restart, picture;
  std::vector<std::string> overrides;  // KEY=VALUE
  bool overwrite = false, allow_changes = false;
  bool as_markdown = false, as_schema = false;
  std::optional<std::string> about;  // a word, in place of all keys
  std::string example, file;         // of a new deck
  std::vector<std::string> folders;
  std::vector<std::string> petsc_words;  // those behind --
  std::string text;                      // all words with blanks between them
};

// Throws InputError on words that the program does not know or that lack something. version(): the text that
// --version asks for.
Order read_words(int count, char** values, const std::function<std::string()>& version);

}  // namespace scree
