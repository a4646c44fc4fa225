#include "commands/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <sstream>

#include "base/error.hpp"
#include "deck/choices.hpp"
#include "deck/suggestion.hpp"

namespace scree {
namespace {

constexpr const char* kExitCodes =
    "Exit codes: 0 done, 2 bad usage or deck, or too little memory for it, 3 the simulation failed,\n"
    "4 a file could not be read or written,\n"
    "5 stopped by a signal (SIGTERM, SIGINT, SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU) after writing a\n"
    "checkpoint, or without one where the model was still being built, or its picture drawn.\n"
    "Words behind -- go to PETSc, with the prefix mbs_ for the multibody solve, e.g. -- -mbs_ksp_view";

// The program's words; those for PETSc go into the order.
std::vector<std::string> split(int count, char** values, Order& order) {
  std::vector<std::string> words;
  bool petsc = false;
  for (int i = 0; i < count; ++i) {
    const std::string word = values[i];
    order.text += (i > 0 ? " " : "") + word;
    if (i == 0) continue;
    if (!petsc && word == "--")
      petsc = true;
    else
      (petsc ? order.petsc_words : words).push_back(word);
  }
  return words;
}

constexpr const char* kEmpty = "is empty; is a variable of a script not set?";

bool is_blank(const std::string& word) { return word.find_first_not_of(" \t") == word.npos; }

// Of every option that takes a name or a path.
CLI::Validator named() {
  return {[](const std::string& word) { return is_blank(word) ? std::string(kEmpty) : std::string(); }, "",
          "named"};
}

// An option that ends in "=" would take the next word.
void refuse_empty_values(const std::vector<std::string>& words) {
  for (const std::string& word : words)
    if (word.starts_with("--") && word.find('=') == word.size() - 1)
      throw InputError(fmt::format("{}: {}", word.substr(0, word.size() - 1), kEmpty));
}

void declare_deck(CLI::App& command, Order& order) {
  command.add_option("deck", order.deck, "input deck (TOML)")->required()->check(named());
  command
      .add_option("--set", order.overrides,
                  "replace a value of the deck, once for each: --set time.step=1e-4")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->take_all()
      ->check(named());
}

void declare_run(CLI::App& app, Order& order) {
  CLI::App* command = app.add_subcommand(
      "run", "run a deck; results go to HDF5 files, and `scree status` tells how far it is");
  declare_deck(*command, order);
  command
      ->add_option("--output", order.output,
                   "folder for the results, from the current one (default: the deck's output.directory, or "
                   "results/DECK's name)")
      ->type_name("DIR")
      ->check(named());
  order.backend = word_of(BackendChoice::automatic);
  command
      ->add_option(
          "--backend", order.backend,
          "cpu; cuda: the GPU; auto: the GPU if there is one and the particles are enough to gain by it "
          "(default: auto)")
      ->check(CLI::IsMember(words_of<BackendChoice>()));
  CLI::Option* restart =
      command
          ->add_option("--restart", order.restart,
                       "continue from this checkpoint. Where it lies in the output folder, the history and "
                       "snapshots there go on, what was written after it is cut off, and other checkpoints "
                       "become NAME.earlier; with another folder they begin anew there, at its time")
          ->type_name("FILE")
          ->check(named());
  command
      ->add_flag("--allow-changes", order.allow_changes,
                 "with --restart: also where the deck is another one than the checkpoint's; the run is then "
                 "not bit for bit")
      ->needs(restart);
  command->add_flag("--overwrite", order.overwrite,
                    "remove the results of an earlier run from the output folder (default: refuse)");
  command->footer(kExitCodes);
  command->callback([&order] { order.command = Command::run; });
}

void declare_check(CLI::App& app, Order& order) {
  CLI::App* command = app.add_subcommand("check", "build and check a deck's model; run nothing");
  declare_deck(*command, order);
  command
      ->add_option("--picture", order.picture,
                   "draw the start, too, with scree-post: a .png, .jpg, .pdf or .svg")
      ->type_name("FILE")
      ->check(named());
  command->callback([&order] { order.command = Command::check; });
}

void declare_keys(CLI::App& app, Order& order) {
  CLI::App* command = app.add_subcommand("keys", "print every deck key: the manual");
  CLI::Option* markdown =
      command->add_flag("--markdown", order.as_markdown, "as a page in Markdown: input/keys.md");
  command
      ->add_flag("--schema", order.as_schema, "as a JSON schema, with which editors complete and check decks")
      ->excludes(markdown);
  command->add_option("word", order.about, "print the keys that this word is about, in place of all")
      ->check(named())
      ->type_name("WORD")
      ->excludes(markdown);
  command->callback([&order] { order.command = Command::keys; });
}

void declare_new(CLI::App& app, Order& order) {
  CLI::App* command = app.add_subcommand("new", "write an example deck to begin from, or list them all");
  command->add_option("example", order.example, "name of an example; none: list them")
      ->type_name("EXAMPLE")
      ->check(named());
  command->add_option("file", order.file, "where to write it (default: EXAMPLE.toml, here)")
      ->type_name("FILE")
      ->check(named());
  command->callback([&order] { order.command = Command::new_deck; });
}

void declare_status(CLI::App& app, Order& order) {
  CLI::App* command = app.add_subcommand("status", "tell how far runs are, and how they ended");
  command->add_option("folder", order.folders, "folders of results; several: a line for each")
      ->type_name("DIR")
      ->required()
      ->check(named());
  command->callback([&order] { order.command = Command::status; });
}

// A deck in the place of a command is what people try first.
std::string usage_message(const CLI::App& app, const std::string& first, const std::string& problem) {
  if (first.ends_with(".toml") || std::filesystem::is_regular_file(first))
    return fmt::format("{0}: not a command; did you mean \"scree run {0}\"?", first);
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands({})) commands.push_back(command->get_name());
  const bool is_word = !first.empty() && !first.starts_with('-');
  const bool known = std::ranges::find(commands, first) != commands.end();
  return (is_word && !known ? first + ": not a command" + suggestion(first, commands) : problem) +
         "; scree --help and scree run --help list commands and options";
}

}  // namespace

Order read_words(int count, char** values, const std::function<std::string()>& version) {
  Order order;
  const std::vector<std::string> words = split(count, values, order);
  refuse_empty_values(words);
  CLI::App app("Scree: collisions between a constrained multibody system and very many particles", "scree");
  app.footer(kExitCodes);
  app.set_version_flag("--version", version);
  app.require_subcommand(1);
  for (const auto declare : {declare_run, declare_check, declare_keys, declare_new, declare_status})
    declare(app, order);
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0)
      throw InputError(usage_message(app, words.empty() ? "" : words.front(), error.what()));
    std::ostringstream text;
    app.exit(error, text, text);
    order.command = Command::help, order.help = text.str();
  }
  return order;
}

}  // namespace scree
