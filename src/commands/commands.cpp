#include "commands/commands.hpp"

#include <fmt/format.h>

#include <cstring>
#include <filesystem>
#include <iostream>
#include <optional>

#include "base/processor.hpp"
#include "base/version.hpp"
#include "deck/deck.hpp"
#include "deck/keys_search.hpp"
#include "dem/reports/output_fields.hpp"
#include "mbs/multibody.hpp"
#include "mbs/petsc_session.hpp"
#include "model/builder/build.hpp"
#include "model/builder/fit_segments.hpp"
#include "model/checks/memory.hpp"
#include "output/library_versions.hpp"
#include "output/results_folder.hpp"
#include "partition/mpi_session.hpp"
#include "partition/ranks.hpp"
#include "partition/shared_model.hpp"
#include "run/check/check.hpp"
#include "run/check/disk_use.hpp"
#include "run/check/examples.hpp"
#include "run/check/start_picture.hpp"
#include "run/loop/simulation.hpp"
#include "run/record/constant_fields.hpp"
#include "run/report/rebound_check.hpp"
#include "run/report/scree_post.hpp"
#include "run/report/signals.hpp"
#include "run/report/status.hpp"
#include "run/report/surfaces_outside.hpp"

namespace scree {
namespace {

std::string output_directory(const Order& order, const Deck& deck) {
  if (!order.output.empty()) return order.output;
  const std::string& directory = deck.root.table("output").text("directory");
  if (!directory.empty()) return directory;
  return "results/" + std::filesystem::path(order.deck).stem().string();
}

// Adds the deck's name to errors of the multibody code, which name joint or body alone.
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

// Says which names in the deck are those of earlier versions.
Deck checked_deck(const Order& order, Log& log) {
  Deck deck = load_deck(order.deck, order.overrides);
  check_output_fields(deck);
  for (const std::string& line : deck.former_names) log.info("former name: " + line);
  return deck;
}

// Length of the deck's texts in a checkpoint [B].
std::int64_t length_of(const Deck& deck) {
  const Deck whole = with_fitting_segments(deck);
  return std::ssize(whole.resolved_text()) + std::ssize(whole.fingerprint());
}

// Enters the chosen values into the deck as if it had named them.
void enter_chosen(const std::vector<ChosenValue>& chosen, Deck& deck) {
  for (const ChosenValue& value : chosen) deck.root.take(value);
}

void log_chosen(const std::vector<ChosenValue>& chosen, Log& log) {
  for (const ChosenValue& value : chosen)
    if (!value.reason.empty()) log.info(fmt::format("chosen: {} ({})", value.text(), value.reason));
}

void warn_of_run(const Model& model, Log& log) {
  for (const std::string& warning : {step_warning(model), outside_at_start(model), constant_fields(model)})
    if (!warning.empty()) log.warning(warning);
}

// Whether a rank has received a signal; if so, logs that together with the text `lacking`. Collective.
bool is_stopped(const Ranks& ranks, const char* lacking, Log& log) {
  const int signal = static_cast<int>(ranks.max(signal_received()));
  if (signal != 0) log.info(fmt::format("stopped by signal ({}) {}", strsignal(signal), lacking));
  return signal != 0;
}

ExitCode run(const Order& order) {
  start_mpi();
  catch_signals();  // again: the MPI library has handlers of its own
  const Ranks ranks = Ranks::world();
  Log log(!ranks.is_root());
  Deck deck = checked_deck(order, log);
  const std::string directory = output_directory(order, deck);
  ranks.on_root([&] { ResultsFolder({directory, order.restart, order.overwrite}).check(); });
  std::vector<ChosenValue> chosen;
  const Model model = build_model(deck, log, RankShare(ranks), chosen);
  enter_chosen(chosen, deck);
  log_chosen(chosen, log);
  if (is_stopped(ranks, "before the first step, without a new checkpoint", log))
    return ExitCode::stopped_by_signal;
  warn_of_run(model, log);
  const std::string too_much = disk_warning(model, disk_use(model, length_of(deck)), directory);
  if (!too_much.empty()) log.warning(too_much);
  std::optional<PetscSession> petsc;  // on rank 0, which has the bodies
  ranks.on_root([&] { petsc.emplace("scree", order.petsc_arguments); });
  const Deck whole = with_fitting_segments(deck);
  RunOptions options{
      order.backend,       directory,  order.restart, order.allow_changes, order.deck, whole.resolved_text(),
      whole.fingerprint(), order.text, ranks,         order.overwrite};
  options.trace = {order.trace, order.trace_from, order.trace_steps};
  const ExitCode code = naming_deck(order.deck, [&] {
    return naming_memory(size_of(model), ranks.size(), [&] { return run_simulation(model, options, log); });
  });
  if (petsc)
    for (const std::string& option : petsc->unused_options())
      log.warning("PETSc option " + option + " was not used");
  log.report_suppressed();
  return code;
}

// The lines of the multibody code on the bodies, including the rank of the constraints; on rank 0.
std::string bodies_report(const Model& model, const Ranks& ranks, Log& log) {
  if (model.bodies.empty()) return "solver         none";
  std::string report;
  ranks.on_root([&] {
    Multibody multibody(model);
    for (const std::string& warning : multibody.start_warnings()) log.warning(warning);
    log.report_suppressed();
    const std::string& change = multibody.start_change();
    report = "solver         " + multibody.solver_description();
    if (!multibody.redundancy().empty())
      report += "\nredundant      minimum-norm reactions: " + multibody.redundancy();
    if (!change.empty()) report += "\nvelocities     made consistent; largest change: " + change;
  });
  return report;
}

// Builds and checks the model without running it.
ExitCode check(const Order& order) {
  const bool draws = !order.picture.empty();
  if (draws) start_mpi();
  const Ranks ranks = Ranks::world();
  Log log(!ranks.is_root());
  std::string drawer;
  if (draws) ranks.on_root([&] { drawer = find_scree_post(); });
  Deck deck = checked_deck(order, log);
  std::vector<ChosenValue> chosen;
  Model model = build_model(deck, log, RankShare(ranks), chosen);
  enter_chosen(chosen, deck);
  warn_of_run(model, log);
  const std::string directory = output_directory(order, deck);
  const DiskUse disk = disk_use(model, length_of(deck));
  if (const std::string warning = disk_warning(model, disk, directory); !warning.empty())
    log.warning(warning);
  const ModelSize size = size_of(model);
  naming_deck(order.deck, [&] {
    naming_memory(size, ranks.size(), [&] {
      const std::string bodies = bodies_report(model, ranks, log);
      log.info(check_report(model, chosen, ranks, disk_lines(model, disk, directory)) + bodies);
    });
  });
  if (!draws) return ExitCode::done;
  std::optional<PetscSession> petsc;  // on rank 0, which has the bodies
  if (!model.bodies.empty()) ranks.on_root([&] { petsc.emplace("scree", std::vector<std::string>{}); });
  naming_memory(size, ranks.size(), [&] {
    draw_start(std::move(model), with_fitting_segments(deck).resolved_text(), drawer, order.picture, ranks);
  });
  if (is_stopped(ranks, "before the picture was drawn", log)) return ExitCode::stopped_by_signal;
  log.info("picture        " + order.picture);
  return ExitCode::done;
}

ExitCode new_deck(const Order& order) {
  Ranks::world().on_root([&] {
    if (order.example.empty()) {
      std::cout << examples_text();
      return;
    }
    const std::string path = write_example(order.example, order.file);
    std::cout << fmt::format("wrote {0}; scree check {0} checks it, scree run {0} runs it\n", path);
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

void print_on_root(const std::string& text) {
  if (Ranks::world().is_root()) std::cout << text;
}

std::string manual(const Order& order) {
  if (order.about) return keys_about(*order.about);
  if (order.as_schema) return keys_schema();
  return order.as_markdown ? keys_markdown() + output_fields_markdown() : keys_text() + output_fields_text();
}

// The instruction sets of this build beyond those of every processor of the architecture.
std::string instructions_text() {
  std::string names;
  for (const ProcessorFeature* wanted = wanted_instructions(); wanted->name != nullptr; ++wanted)
    names += (names.empty() ? "" : ", ") + std::string(wanted->name);
  return names.empty() ? "every processor of this architecture" : "processors with " + names;
}

}  // namespace

std::string version_text() {
  std::string text = fmt::format("scree {} (commit {})\ncompiler {}\nflags {}\nfor {}\n", version(), commit(),
                                 compiler(), compile_flags(), instructions_text());
  for (const auto& [library, number] : library_versions()) text += fmt::format("{} {}\n", library, number);
  return text + fmt::format("PETSc {}\n", petsc_version());
}

ExitCode carry_out(const Order& order) {
  switch (order.command) {
    case Command::run:
      return run(order);
    case Command::check:
      return check(order);
    case Command::new_deck:
      return new_deck(order);
    case Command::status:
      return status(order.folders);
    case Command::keys:
      print_on_root(manual(order));
      break;
    case Command::help:
      print_on_root(order.help);
      break;
  }
  return ExitCode::done;
}

}  // namespace scree
