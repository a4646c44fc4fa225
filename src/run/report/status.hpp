// The report of `scree status`: what can be told of a run from outside, while it goes on or after it.
#pragma once

#include <string>
#include <vector>

#include "base/error.hpp"

namespace scree {

// Several lines on the run in a folder: its state, progress, rate, energy balance, files. Throws InputError
// where there is no such folder or no run in it, IoError where its status file cannot be read.
std::string status_report(const std::string& folder);
// A line for each folder, under a header. A folder of which nothing can be told has the reason in its line.
struct StatusTable {
  std::string text;
  ExitCode code = ExitCode::done;  // of the last folder of which nothing could be told
};
StatusTable status_table(const std::vector<std::string>& folders);

}  // namespace scree
