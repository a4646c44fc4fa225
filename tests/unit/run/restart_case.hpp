// A deck that tests of restarts run, whose checkpoints they read and refuse.
#pragma once

#include <string>
#include <vector>

#include "base/error.hpp"
#include "deck/deck.hpp"
#include "model/builder/build.hpp"
#include "run/loop/simulation.hpp"
#include "run/restart/restart.hpp"
#include "support/petsc_run.hpp"

namespace scree {

struct RestartCase {
  explicit RestartCase(const std::string& text, const std::vector<std::string>& overrides = {})
      : deck(parse_deck(text, "deck.toml", overrides)) {
    petsc();
    Log log(true);
    model = build_model(deck, log);
    options.backend = "cpu", options.overwrite = true;
    options.resolved_deck = deck.resolved_text(), options.fingerprint = deck.fingerprint();
  }
  // Runs into a folder; returns the message of a failure.
  std::string run(const std::string& directory, const std::string& restart = "", bool allow_changes = false) {
    options.output_directory = directory, options.restart = restart, options.allow_changes = allow_changes;
    log = Log(true);
    try {
      if (run_simulation(model, options, log) != ExitCode::done) return "failed";
    } catch (const InputError& error) {
      return std::string("input: ") + error.what();
    } catch (const IoError& error) {
      return std::string("file: ") + error.what();
    }
    return "";
  }
  Restart read(const std::string& path) {
    options.restart = path;
    return read_restart(model, options, log);
  }
  std::string refusal(const std::string& path) {
    try {
      read(path);
    } catch (const IoError& error) {
      return error.what();
    }
    return "";
  }

  Deck deck;
  Model model;
  RunOptions options;
  Log log{true};
};

}  // namespace scree
