// The command line: scree run | check | new | keys | status | --version.
#include <fmt/format.h>
#include <mpi.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <functional>
#include <iostream>
#include <optional>
#include <span>
#include <string_view>

#include "base/error.hpp"
#include "base/printable.hpp"
#include "base/version.hpp"
#include "deck/choices.hpp"
#include "deck/deck.hpp"
#include "deck/suggestion.hpp"
#include "dem/output_fields.hpp"
#include "mbs/multibody.hpp"
#include "mbs/petsc_session.hpp"
#include "model/build.hpp"
#include "model/fit_segments.hpp"
#include "model/memory.hpp"
#include "output/library_versions.hpp"
#include "output/results_folder.hpp"
#include "partition/ranks.hpp"
#include "partition/shared_model.hpp"
#include "run/check.hpp"
#include "run/examples.hpp"
#include "run/scree_post.hpp"
#include "run/signals.hpp"
#include "run/simulation.hpp"
#include "run/start_picture.hpp"
#include "run/status.hpp"
#include "run/step_trials.hpp"
#include "run/still_fields.hpp"
#include "run/surfaces_outside.hpp"

namespace scree {
namespace {

constexpr const char* kExitCodes =
    "Exit codes: 0 done, 2 bad usage or deck, or too little memory for it, 3 the simulation failed,\n"
    "4 a file could not be read or written,\n"
    "5 stopped by a signal (SIGTERM, SIGINT, SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU) after writing a\n"
    "checkpoint, or without one where the model was still being built, or its picture drawn.\n"
    "Words behind -- go to PETSc, with the prefix mbs_ for the multibody solve, e.g. -- -mbs_ksp_view";

struct CommandLine {
  std::vector<std::string> words, petsc_words;
  std::string text;
};

CommandLine split(int count, char** values) {
  CommandLine line;
  bool petsc = false;
  for (int i = 0; i < count; ++i) {
    const std::string word = values[i];
    line.text += (i > 0 ? " " : "") + word;
    if (i == 0) continue;
    if (!petsc && word == "--")
      petsc = true;
    else
      (petsc ? line.petsc_words : line.words).push_back(word);
  }
  return line;
}

struct Arguments {
  std::string deck, output, backend = word_of(BackendChoice::automatic), restart, picture;
  bool overwrite = false;
  bool allow_changes = false;
  std::vector<std::string> overrides;
};

int mpi_value(int (*query)(MPI_Comm, int*)) {
  int value = 0;
  query(MPI_COMM_WORLD, &value);
  return value;
}

std::string version_text() {
  std::string text = fmt::format("scree {} (commit {})\ncompiler {}\nflags {}\n", version(), commit(),
                                 compiler(), compile_flags());
  for (const auto& [library, number] : library_versions()) text += fmt::format("{} {}\n", library, number);
  return text + fmt::format("PETSc {}\n", petsc_version());
}

std::string output_directory(const Arguments& arguments, const Deck& deck) {
  if (!arguments.output.empty()) return arguments.output;
  const std::string& directory = deck.root.table("output").text("directory");
  if (!directory.empty()) return directory;
  return "results/" + std::filesystem::path(arguments.deck).stem().string();
}

// What the multibody room refuses it names by joint or body; this adds the deck.
template <class Action>
auto naming_deck(const std::string& deck, const Action& action) {
  try {
    return action();
  } catch (const InputError& error) {
    const std::string message = error.what();
    throw InputError(message.starts_with(deck) || message.starts_with("--") ? message
                                                                            : deck + ": " + message);
  }
}

Deck checked_deck(const Arguments& arguments) {
  Deck deck = load_deck(arguments.deck, arguments.overrides);
  check_output_fields(deck);
  return deck;
}

// Puts the chosen values into the deck, as if it had named them.
void take_chosen(const std::vector<ChosenValue>& chosen, Deck& deck) {
  for (const ChosenValue& value : chosen) deck.root.take(value);
}

void say_chosen(const std::vector<ChosenValue>& chosen, Log& log) {
  for (const ChosenValue& value : chosen)
    if (!value.reason.empty()) log.info(fmt::format("chosen: {} ({})", value.text(), value.reason));
}

void warn_of_run(const Model& model, Log& log) {
  for (const std::string& warning : {step_warning(model), outside_at_start(model), still_fields(model)})
    if (!warning.empty()) log.warning(warning);
}

// Whether a signal has reached a rank; says so, and what there is not. Collective.
bool is_stopped(const Ranks& ranks, const char* lacking, Log& log) {
  const int signal = static_cast<int>(ranks.max(signal_received()));
  if (signal != 0) log.info(fmt::format("stopped by signal ({}) {}", strsignal(signal), lacking));
  return signal != 0;
}

ExitCode run(const Arguments& arguments, const CommandLine& line) {
  const Ranks ranks = Ranks::world();
  Log log(!ranks.is_root());
  Deck deck = checked_deck(arguments);
  const std::string directory = output_directory(arguments, deck);
  ranks.on_root([&] { ResultsFolder({directory, arguments.restart, arguments.overwrite}).check(); });
  std::vector<ChosenValue> chosen;
  const Model model = build_model(deck, log, RanksShare(ranks), chosen);
  take_chosen(chosen, deck);
  say_chosen(chosen, log);
  if (is_stopped(ranks, "before the first step: there is no new checkpoint", log))
    return ExitCode::stopped_by_signal;
  warn_of_run(model, log);
  std::optional<PetscSession> petsc;  // of rank 0, where the bodies are
  ranks.on_root([&] { petsc.emplace("scree", line.petsc_words); });
  const Deck whole = with_fitting_segments(deck);
  RunOptions options{arguments.backend,       directory,      arguments.restart,
                     arguments.allow_changes, arguments.deck, whole.resolved_text(),
                     whole.fingerprint(),     line.text,      ranks,
                     arguments.overwrite};
  const ExitCode code = naming_deck(arguments.deck, [&] {
    return naming_memory(size_of(model), ranks.size(), [&] { return run_simulation(model, options, log); });
  });
  if (petsc)
    for (const std::string& option : petsc->unused_options())
      log.warning("PETSc option " + option + " was not used");
  return code;
}

// What the multibody room says of the bodies, the constraints' rank included; on rank 0.
std::string bodies_report(const Model& model, const Ranks& ranks, Log& log) {
  if (model.bodies.empty()) return "solver         none";
  std::string report;
  ranks.on_root([&] {
    Multibody multibody(model);
    for (const std::string& warning : multibody.start_warnings()) log.warning(warning);
    const std::string& change = multibody.start_change();
    report = "solver         " + multibody.solver_description();
    if (!multibody.redundancy().empty())
      report += "\nredundant      reactions shared: " + multibody.redundancy();
    if (!change.empty()) report += "\nvelocities     made consistent; largest change: " + change;
  });
  return report;
}

// Everything short of running.
ExitCode check(const Arguments& arguments) {
  const Ranks ranks = Ranks::world();
  Log log(!ranks.is_root());
  std::string drawer;
  if (!arguments.picture.empty()) ranks.on_root([&] { drawer = find_scree_post(); });
  Deck deck = checked_deck(arguments);
  std::vector<ChosenValue> chosen;
  Model model = build_model(deck, log, RanksShare(ranks), chosen);
  take_chosen(chosen, deck);
  warn_of_run(model, log);
  std::optional<PetscSession> petsc;  // of rank 0, where the bodies are
  const ModelSize size = size_of(model);
  naming_deck(arguments.deck, [&] {
    naming_memory(size, ranks.size(), [&] {
      if (!model.bodies.empty()) ranks.on_root([&] { petsc.emplace("scree", std::vector<std::string>{}); });
      const std::string bodies = bodies_report(model, ranks, log);
      log.info(check_report(model, chosen, ranks) + bodies);
    });
  });
  if (arguments.picture.empty()) return ExitCode::done;
  naming_memory(size, ranks.size(), [&] {
    draw_start(std::move(model), with_fitting_segments(deck).resolved_text(), drawer, arguments.picture,
               ranks);
  });
  if (is_stopped(ranks, "before the picture was drawn", log)) return ExitCode::stopped_by_signal;
  log.info("picture        " + arguments.picture);
  return ExitCode::done;
}

ExitCode new_deck(const std::string& example, const std::string& file) {
  Ranks::world().on_root([&] {
    if (example.empty()) {
      std::cout << examples_text();
      return;
    }
    const std::string path = write_example(example, file);
    std::cout << fmt::format("{0} is written; scree check {0} checks it, scree run {0} runs it\n", path);
  });
  return ExitCode::done;
}

ExitCode status(const std::vector<std::string>& folders) {
  ExitCode code = ExitCode::done;
  const Ranks ranks = Ranks::world();
  ranks.on_root([&] {
    if (folders.size() == 1) {
      std::cout << status_report(folders.front());
    } else {
      const StatusTable table = status_table(folders);
      std::cout << table.text;
      code = table.code;
    }
  });
  ranks.broadcast(code);
  return code;
}

void declare_deck(CLI::App& command, Arguments& arguments) {
  command.add_option("deck", arguments.deck, "input deck (TOML)")->required();
  command
      .add_option("--set", arguments.overrides,
                  "replace a value of the deck, once for each: --set time.step=1e-4")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->take_all();
}

// A deck in the place of a command is what people try first.
std::string usage_message(const CLI::App& app, const CommandLine& line, const std::string& problem) {
  const std::string first = line.words.empty() ? "" : line.words.front();
  if (first.ends_with(".toml") || std::filesystem::is_regular_file(first))
    return fmt::format("{0}: not a command; did you mean \"scree run {0}\"?", first);
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands({})) commands.push_back(command->get_name());
  const bool is_word = !first.empty() && !first.starts_with('-');
  const bool known = std::ranges::find(commands, first) != commands.end();
  return (is_word && !known ? first + ": not a command" + suggestion(first, commands) : problem) +
         "; scree --help and scree run --help list commands and options";
}

ExitCode dispatch(const CommandLine& line) {
  CLI::App app("Scree: collisions between a constrained multibody system and very many particles", "scree");
  app.footer(kExitCodes);
  app.set_version_flag("--version", version_text);
  app.require_subcommand(1);
  Arguments arguments;

  CLI::App* run_command = app.add_subcommand(
      "run", "run a deck; results go to HDF5 files, and `scree status` tells how far it is");
  declare_deck(*run_command, arguments);
  run_command
      ->add_option("--output", arguments.output,
                   "folder for the results, from the current one (default: the deck's output.directory, or "
                   "results/DECK's name)")
      ->type_name("DIR");
  run_command
      ->add_option(
          "--backend", arguments.backend,
          "cpu; cuda: the GPU; auto: the GPU if there is one and the particles are enough to gain by it "
          "(default: auto)")
      ->check(CLI::IsMember(words_of<BackendChoice>()));
  CLI::Option* restart =
      run_command
          ->add_option("--restart", arguments.restart,
                       "continue from this checkpoint. Where it lies in the output folder, the history and "
                       "snapshots there go on, what was written after it is cut off, and other checkpoints "
                       "become NAME.earlier; with another folder they begin anew there, at its time")
          ->type_name("FILE");
  run_command
      ->add_flag("--allow-changes", arguments.allow_changes,
                 "with --restart: also where the deck is another one than the checkpoint's; the run is then "
                 "not bit for bit")
      ->needs(restart);
  run_command->add_flag("--overwrite", arguments.overwrite,
                        "remove the results of an earlier run from the output folder (default: refuse)");
  run_command->footer(kExitCodes);
  CLI::App* check_command = app.add_subcommand("check", "build and check a deck's model; run nothing");
  declare_deck(*check_command, arguments);
  check_command
      ->add_option("--picture", arguments.picture,
                   "draw the start, too, with scree-post: a .png, .jpg, .pdf or .svg")
      ->type_name("FILE");
  CLI::App* keys_command = app.add_subcommand("keys", "print every deck key: the manual");
  bool as_markdown = false, as_schema = false;
  CLI::Option* markdown =
      keys_command->add_flag("--markdown", as_markdown, "as a page in Markdown: input/keys.md");
  keys_command
      ->add_flag("--schema", as_schema, "as a JSON schema, with which editors complete and check decks")
      ->excludes(markdown);
  std::string example, new_file;
  CLI::App* new_command = app.add_subcommand("new", "write an example deck to begin from, or list them all");
  new_command->add_option("example", example, "name of an example; none: list them")->type_name("EXAMPLE");
  new_command->add_option("file", new_file, "where to write it (default: EXAMPLE.toml, here)")
      ->type_name("FILE");
  std::vector<std::string> folders;
  CLI::App* status_command = app.add_subcommand("status", "tell how far runs are, and how they ended");
  status_command->add_option("folder", folders, "folders of results; several: a line for each")
      ->type_name("DIR")
      ->required();

  try {
    std::vector<std::string> reversed(line.words.rbegin(), line.words.rend());
    app.parse(reversed);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) throw InputError(usage_message(app, line, error.what()));
    if (mpi_value(MPI_Comm_rank) == 0) app.exit(error);
    return ExitCode::done;
  }
  if (*run_command) return run(arguments, line);
  if (*check_command) return check(arguments);
  if (*new_command) return new_deck(example, new_file);
  if (*status_command) return status(folders);
  if (*keys_command && mpi_value(MPI_Comm_rank) == 0)
    std::cout << (as_markdown ? keys_markdown() + output_fields_markdown()
                  : as_schema ? keys_schema()
                              : keys_text() + output_fields_text());
  return ExitCode::done;
}

ExitCode guarded(const std::function<ExitCode()>& body) {
  const auto report = [](const char* what, ExitCode code) {
    Ranks::world().meet(what, static_cast<int>(code));
    if (mpi_value(MPI_Comm_rank) == 0) std::cerr << message_line("error", what);
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

// A process that is started alone starts MPI with its command line in one variable of the environment, and
// the system refuses one of 128 KiB. Says so, or nothing.
std::string length_trouble(int count, char** values) {
  constexpr std::size_t kLongest = 110000, kShown = 80;  // [B]
  std::size_t length = 0;
  std::string_view longest;
  for (const std::string_view word : std::span(values, static_cast<std::size_t>(count))) {
    length += word.size() + 1;
    if (word.size() > longest.size()) longest = word;
  }
  if (length <= kLongest) return "";
  return fmt::format(
      "--set or another word, {}: the command line has {} bytes; allowed are {}, a deck has no limit",
      shortened(std::string(longest), kShown), length, kLongest);
}

}  // namespace
}  // namespace scree

int main(int count, char** values) {
  if (const std::string trouble = scree::length_trouble(count, values); !trouble.empty()) {
    std::cerr << scree::message_line("error", trouble);
    return static_cast<int>(scree::ExitCode::bad_input);
  }
  const bool runs = count > 1 && std::string_view(values[1]) == "run";
  if (runs) scree::catch_signals();  // before MPI starts, which takes a while, too
  MPI_Init(&count, &values);
  if (runs) scree::catch_signals();
  const scree::CommandLine line = scree::split(count, values);
  const scree::ExitCode code = scree::guarded([&] { return scree::dispatch(line); });
  MPI_Finalize();
  return static_cast<int>(code);
}
