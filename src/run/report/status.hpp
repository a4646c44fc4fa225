// The report of `scree status` on a run, from outside, during the run or after it.
#pragma once

#include <string>
#include <vector>

#include "base/error.hpp"

namespace scree {

// Several lines on the run in a folder: state, progress, rate, energy balance, files. Throws InputError if
// there is no such folder or no run in it, IoError if its status file cannot be read.
std::string status_report(const std::string& folder);
// One line per folder, below a header. A folder without a readable status has the reason in its line.
struct StatusTable {
  std::string text;
  ExitCode code = ExitCode::done;  // of the last folder without a readable status
};
StatusTable status_table(const std::vector<std::string>& folders);

}  // namespace scree
