// The results folder of a run: it belongs to one run at a time, and existing results are only overwritten on
// request.
#pragma once

#include <string>
#include <vector>

#include "output/folder_lock.hpp"

namespace scree {

struct ResultsOptions {
  std::string folder;
  std::string restart;     // checkpoint to continue from; empty: the run starts at t = 0
  bool overwrite = false;  // remove the results of an earlier run
};

// Exists on rank 0 alone.
class ResultsFolder {
 public:
  explicit ResultsFolder(const ResultsOptions& options);

  // Throws InputError if another run writes into the folder, or if the folder has results that are neither
  // continued nor may be overwritten. Changes nothing.
  void check() const;
  // Creates and checks the folder, and locks it for the lifetime of this object. Throws IoError, too.
  void claim();
  // Whether the run continues the files in the folder: its checkpoint is one of them.
  bool continues() const;
  // Removes the results of an earlier run except the checkpoint to continue from. Results that are continued
  // stay, and the other checkpoints are renamed to NAME.earlier. Throws IoError.
  void clear() const;

 private:
  void check_results() const;
  void set_checkpoints_aside() const;
  std::vector<std::string> results_of_others() const;
  std::string way_out() const;

  ResultsOptions options_;
  FolderLock lock_;
};

}  // namespace scree
