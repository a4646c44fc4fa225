// How much disk a run takes, before it runs: sums of what its files hold (output/hdf5_size.hpp), for
// `scree check` and for the warning where that does not fit.
#pragma once

#include <cstdint>
#include <string>

#include "model/data/model.hpp"

namespace scree {

struct DiskUse {
  std::int64_t snapshots = 0, rows = 0, columns = 0;  // of the history
  bool rows_are_known = true;                         // else these are the fewest
  Real snapshot = 0, all_snapshots = 0;               // one more, all together, contacts left out [B]
  Real contacts = 0;  // of all snapshots, if particles touch as they do in dense packings
  Real history = 0, csv = 0;
  // Of a checkpoint if nothing touches then, and if particles touch as they do in dense packings.
  Real checkpoint = 0, dense_checkpoint = 0;
  int checkpoints = 1;  // that are left

  Real left() const;  // by the run
  // While it goes on: growing files exist twice, and a checkpoint is written beside the last one.
  Real most() const;
};

// resolved_deck: the lengths of the deck's resolved text and of its fingerprint, which checkpoints hold.
// Before compression.
DiskUse disk_use(const Model& model, std::int64_t resolved_deck);

// What is free to this user where the folder is, or would be made [B]; below 0 where the system does not say.
Real free_disk(const std::string& folder);

// That the results do not fit into what is free, and what to change; empty where they do.
std::string disk_warning(const Model& model, const DiskUse& use, const std::string& folder);

// Lines of `scree check`: snapshots, checkpoints, history and disk.
std::string disk_lines(const Model& model, const DiskUse& use, const std::string& folder);

}  // namespace scree
