// Disk space of a run, computed before it starts: sums over the contents of its files (output/hdf5_size.hpp),
// for `scree check` and for the warning if the disk has too little space.
#pragma once

#include <cstdint>
#include <string>

#include "model/data/model.hpp"

namespace scree {

struct DiskUse {
  std::int64_t snapshots = 0, rows = 0, columns = 0;  // of the history
  bool rows_are_known = true;                         // otherwise `rows` is the least number
  Real snapshot = 0, all_snapshots = 0;               // one more; all together; without contacts [B]
  Real contacts = 0;                                  // of all snapshots, for densely packed particles
  Real history = 0, csv = 0;
  // Size of a checkpoint without contacts, and with densely packed particles.
  Real checkpoint = 0, dense_checkpoint = 0;
  int checkpoints = 1;  // that remain after the run

  Real left() const;  // after the run
  // Peak during the run: growing files exist twice, and a checkpoint is written beside the previous one.
  Real most() const;
};

// Sizes before compression. resolved_deck: lengths of the deck's resolved text and of its fingerprint, which
// checkpoints store [B].
DiskUse disk_use(const Model& model, std::int64_t resolved_deck);

// Space that is free to this user at the folder, existing or not [B]; negative if the system does not tell.
Real free_disk(const std::string& folder);

// The warning that the results exceed the free space, with a remedy; empty if they fit.
std::string disk_warning(const Model& model, const DiskUse& use, const std::string& folder);

// Lines of `scree check`: snapshots, checkpoints, history and disk.
std::string disk_lines(const Model& model, const DiskUse& use, const std::string& folder);

}  // namespace scree
