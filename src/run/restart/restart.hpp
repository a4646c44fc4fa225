// Restart from a checkpoint: what it must have in common with the deck, and what --allow-changes permits to
// differ.
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
  // changed: the deck differs from the checkpoint's. forces_changed: so may its forces, and those in the
  // state must be recomputed.
  bool changed = false, forces_changed = false;
  std::string changes;           // since t = 0, earlier restarts included: a line for each key
  std::vector<RunStart> starts;  // up to the checkpoint
};

// Adds the texts that a restart needs to a packed state. changes: as in Restart; starts: including this one.
void add_restart_texts(Checkpoint& checkpoint, const RunOptions& options, const std::string& state_hash,
                       const std::string& changes, const std::vector<RunStart>& starts);
// Names of these texts.
inline const std::vector<std::string> kRestartTexts = {"changes", "deck", "fingerprint", "starts",
                                                       "state_hash"};
// Hash of all ranks' particles and the rest of the state, as text. Collective.
std::string hash_of_all(const State& state, const Ranks& ranks);
// Throws IoError if the file is damaged or no checkpoint, InputError with the keys that differ if it belongs
// to another deck. With RunOptions::allow_changes the deck's values apply from the checkpoint's time on, as
// far as the stored values are meaningful for this deck. Collective.
Restart read_restart(const Model& model, const RunOptions& options, Log& log);

}  // namespace scree
