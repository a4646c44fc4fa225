// The folder that a run writes its results into: one run at a time, and none over another's files unasked.
#pragma once

#include <string>
#include <vector>

#include "output/folder_lock.hpp"

namespace scree {

struct ResultsOptions {
  std::string folder;
  std::string restart;     // the checkpoint that the run continues; empty: it starts at t = 0
  bool overwrite = false;  // results of an earlier run are removed
};

// Of rank 0.
class ResultsFolder {
 public:
  explicit ResultsFolder(const ResultsOptions& options);

  // Throws InputError where another run writes into the folder, or where it holds results that are not
  // continued and may not be overwritten. Changes nothing.
  void check() const;
  // Makes the folder, checks it, and keeps it for this run until this object ends. Throws IoError, too.
  void claim();
  // Whether the run goes on with the files in the folder: the checkpoint is one of them.
  bool continues() const;
  // Removes what an earlier run has left, the checkpoint that the run continues excepted. Where its results
  // are continued they stay, and its other checkpoints get the name NAME.earlier. Throws IoError.
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
