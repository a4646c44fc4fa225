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
    "Exit codes: 0 done, 2 bad usage or deck, or too little memory, 3 simulation failed,\n"
    "4 file could not be read or written,\n"
    "5 stopped by a signal (SIGTERM, SIGINT, SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU) after writing a\n"
    "checkpoint; without one if the model was still being built, or its picture drawn.\n"
    "Arguments after -- go to PETSc, with the prefix mbs_ for the multibody solve, e.g. -- -mbs_ksp_view";

// Splits the arguments into those of the program, which it returns, and those for PETSc, which go into the
// order.
std::vector<std::string> split(int count, char** values, Order& order) {
  std::vector<std::string> arguments;
  bool petsc = false;
  for (int i = 0; i < count; ++i) {
    const std::string argument = values[i];
    order.text += (i > 0 ? " " : "") + argument;
    if (i == 0) continue;
    if (!petsc && argument == "--")
      petsc = true;
    else
      (petsc ? order.petsc_arguments : arguments).push_back(argument);
  }
  return arguments;
}

constexpr const char* kEmpty = "is empty; is a variable of a script not set?";

bool is_blank(const std::string& argument) { return argument.find_first_not_of(" \t") == argument.npos; }

// Validator for options that take a name or a path.
CLI::Validator named() {
  return {
      [](const std::string& argument) { return is_blank(argument) ? std::string(kEmpty) : std::string(); },
      "", "named"};
}

// Without this check an option that ends in "=" would take the next argument as its value.
void refuse_empty_values(const std::vector<std::string>& arguments) {
  for (const std::string& argument : arguments)
    if (argument.starts_with("--") && argument.find('=') == argument.size() - 1)
      throw InputError(fmt::format("{}: {}", argument.substr(0, argument.size() - 1), kEmpty));
}

void declare_deck(CLI::App& command, Order& order) {
  command.add_option("deck", order.deck, "input deck (TOML)")->required()->check(named());
  command
      .add_option("--set", order.overrides, "replace a value of the deck (repeatable): --set time.step=1e-4")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->take_all()
      ->check(named());
}

void declare_trace(CLI::App& command, Order& order) {
  CLI::Option* trace = command
                           .add_option("--trace", order.trace,
                                       "write a timeline of the stages of some steps on every rank, which "
                                       "ui.perfetto.dev and chrome://tracing open")
                           ->type_name("FILE")
                           ->check(named());
  command.add_option("--trace-steps", order.trace_steps, "with --trace: number of steps (default: 200)")
      ->type_name("N")
      ->check(CLI::Range(1, 1000000))
      ->needs(trace);
  command
      .add_option("--trace-from", order.trace_from,
                  "with --trace: number of steps of this start before the first of them (default: 0)")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber)
      ->needs(trace);
}

void declare_run(CLI::App& app, Order& order) {
  CLI::App* command =
      app.add_subcommand("run", "run a deck; results go to HDF5 files, `scree status` shows the progress");
  declare_deck(*command, order);
  command
      ->add_option(
          "--output", order.output,
          "folder for the results, relative to the current one (default: the deck's output.directory, "
          "or results/ plus the deck's name)")
      ->type_name("DIR")
      ->check(named());
  order.backend = word_of(BackendChoice::automatic);
  command
      ->add_option(
          "--backend", order.backend,
          "cpu; cuda: the GPU; auto: the GPU if there is one and the number of particles makes it faster "
          "(default: auto)")
      ->check(CLI::IsMember(words_of<BackendChoice>()));
  CLI::Option* restart =
      command
          ->add_option("--restart", order.restart,
                       "continue from this checkpoint. In the checkpoint's own folder the history and the "
                       "snapshots are continued, what was written after the checkpoint is cut off, and other "
                       "checkpoints become NAME.earlier; in another folder new files begin at its time")
          ->type_name("FILE")
          ->check(named());
  command
      ->add_flag("--allow-changes", order.allow_changes,
                 "with --restart: continue although the deck differs from the checkpoint's; the results are "
                 "then not bit for bit those of either deck")
      ->needs(restart);
  command->add_flag("--overwrite", order.overwrite,
                    "remove the results of an earlier run from the output folder (default: refuse)");
  declare_trace(*command, order);
  command->footer(kExitCodes);
  command->callback([&order] { order.command = Command::run; });
}

void declare_check(CLI::App& app, Order& order) {
  CLI::App* command = app.add_subcommand("check", "build and check a deck's model without running it");
  declare_deck(*command, order);
  command
      ->add_option("--picture", order.picture,
                   "also draw the start with scree-post, as .png, .jpg, .pdf or .svg")
      ->type_name("FILE")
      ->check(named());
  command->callback([&order] { order.command = Command::check; });
}

void declare_keys(CLI::App& app, Order& order) {
  CLI::App* command = app.add_subcommand("keys", "print the reference of all deck keys");
  CLI::Option* markdown =
      command->add_flag("--markdown", order.as_markdown, "as a Markdown page, like input/keys.md");
  command->add_flag("--schema", order.as_schema, "as a JSON schema for completion and checks in editors")
      ->excludes(markdown);
  command->add_option("word", order.about, "print only the keys on this word")
      ->check(named())
      ->type_name("WORD")
      ->excludes(markdown);
  command->callback([&order] { order.command = Command::keys; });
}

void declare_new(CLI::App& app, Order& order) {
  CLI::App* command = app.add_subcommand("new", "write an example deck, or list all examples");
  command->add_option("example", order.example, "name of an example (default: list all)")
      ->type_name("EXAMPLE")
      ->check(named());
  command->add_option("file", order.file, "file to write (default: EXAMPLE.toml in the current folder)")
      ->type_name("FILE")
      ->check(named());
  command->callback([&order] { order.command = Command::new_deck; });
}

void declare_status(CLI::App& app, Order& order) {
  CLI::App* command = app.add_subcommand("status", "show the progress of runs, and how they ended");
  command->add_option("folder", order.folders, "results folders; one line each if there are several")
      ->type_name("DIR")
      ->required()
      ->check(named());
  command->callback([&order] { order.command = Command::status; });
}

// Users often give a deck in place of a command.
std::string usage_message(const CLI::App& app, const std::string& first, const std::string& problem) {
  if (first.ends_with(".toml") || std::filesystem::is_regular_file(first))
    return fmt::format("{0}: not a command; did you mean \"scree run {0}\"?", first);
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands({})) commands.push_back(command->get_name());
  const bool is_name = !first.empty() && !first.starts_with('-');
  const bool known = std::ranges::find(commands, first) != commands.end();
  return (is_name && !known ? first + ": not a command" + suggestion(first, commands) : problem) +
         "; scree --help and scree run --help list commands and options";
}

}  // namespace

Order parse_command_line(int count, char** values, const std::function<std::string()>& version) {
  Order order;
  const std::vector<std::string> arguments = split(count, values, order);
  refuse_empty_values(arguments);
  CLI::App app("Scree: collisions between a constrained multibody system and very many particles", "scree");
  app.footer(kExitCodes);
  app.set_version_flag("--version", version);
  app.require_subcommand(1);
  for (const auto declare : {declare_run, declare_check, declare_keys, declare_new, declare_status})
    declare(app, order);
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0)
      throw InputError(usage_message(app, arguments.empty() ? "" : arguments.front(), error.what()));
    std::ostringstream text;
    app.exit(error, text, text);
    order.command = Command::help, order.help = text.str();
  }
  return order;
}

}  // namespace scree
