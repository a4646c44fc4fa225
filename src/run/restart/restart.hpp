// Going on from a checkpoint: what it must share with the deck, and what --allow-changes lets differ.
#pragma once

#include <string>
#include <vector>

#include "base/log.hpp"
#include "output/run_starts.hpp"
#include "run/state/run_options.hpp"
#include "run/state/state.hpp"

namespace scree {

struct Restart {
  State state;
  // Whether the deck is another one than the checkpoint's, and whether its forces may be: those of the state
  // are then to be computed anew.
  bool changed = false, forces_changed = false;
  std::string changes;           // since t = 0, this and earlier ones: a line for each key
  std::vector<RunStart> starts;  // up to the checkpoint
};

// Adds to a packed state the texts that a restart reads. changes: as in Restart; starts: with this one.
void add_restart_texts(Checkpoint& checkpoint, const RunOptions& options, const std::string& state_hash,
                       const std::string& changes, const std::vector<RunStart>& starts);
// The names of these texts.
inline const std::vector<std::string> kRestartTexts = {"changes", "deck", "fingerprint", "starts",
                                                       "state_hash"};
// As text: of all ranks' particles and the rest. Collective.
std::string hash_of_all(const State& state, const Ranks& ranks);
// Throws IoError where the file is damaged or no checkpoint, InputError where it belongs to another deck: its
// message names the keys that differ. With RunOptions::allow_changes the deck's values hold from the
// checkpoint's time on, as far as its numbers have a meaning for this deck. Collective.
Restart read_restart(const Model& model, const RunOptions& options, Log& log);

}  // namespace scree
