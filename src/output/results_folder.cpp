#include "output/results_folder.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "base/error.hpp"
#include "output/status_file.hpp"

namespace scree {

namespace fs = std::filesystem;

namespace {

// Files that a run may write.
constexpr const char* kFileNames[] = {
    "history.h5",      "history.csv",     "particles.vtkhdf", "particles.xdmf",    "bodies.vtkhdf",
    "bodies.xdmf",     "surfaces.vtkhdf", "surfaces.xdmf",    "contacts.vtkhdf",   "contacts.xdmf",
    "links.vtkhdf",    "links.xdmf",      "checkpoint.h5",    "checkpoint_end.h5", "checkpoint_failed.h5",
    "run_record.json", kStatusName};
constexpr const char* kCheckpoints[] = {"checkpoint.h5", "checkpoint_end.h5", "checkpoint_failed.h5"};
// Suffixes of files that a killed run leaves beside them.
constexpr const char* kCopySuffixes[] = {".tmp", ".spare", ".old"};
// Suffix of checkpoints later than the one from which the run was continued.
constexpr const char* kEarlier = ".earlier";

// The checkpoint to continue from; empty if there is none.
std::string newest_checkpoint(const std::string& folder) {
  std::string newest;
  for (const char* name : {"checkpoint.h5", "checkpoint_end.h5"}) {
    const std::string path = folder + "/" + name;
    std::error_code error;
    if (fs::exists(path, error) &&
        (newest.empty() || fs::last_write_time(path, error) > fs::last_write_time(newest, error)))
      newest = path;
  }
  return newest;
}

void remove_file(const std::string& path) {
  std::error_code error;
  fs::remove(path, error);
  if (error) throw IoError(fmt::format("{}: cannot remove: {}", path, error.message()));
}

bool is_there(const std::string& path) { return fs::exists(fs::symlink_status(path)); }

}  // namespace

ResultsFolder::ResultsFolder(const ResultsOptions& options) : options_(options), lock_(options.folder) {}

bool ResultsFolder::continues() const {
  if (options_.restart.empty() || !fs::exists(options_.folder + "/history.h5")) return false;
  const fs::path folder = fs::path(options_.restart).parent_path();
  std::error_code none_such;
  return fs::equivalent(folder.empty() ? "." : folder, options_.folder, none_such);
}

std::vector<std::string> ResultsFolder::results_of_others() const {
  std::vector<std::string> found;
  if (continues()) return found;
  for (const char* name : kFileNames) {
    const std::string path = options_.folder + "/" + name;
    std::error_code none_such;
    if (is_there(path) && (options_.restart.empty() || !fs::equivalent(path, options_.restart, none_such)))
      found.push_back(name);
  }
  return found;
}

std::string ResultsFolder::way_out() const {
  const std::string newest = newest_checkpoint(options_.folder);
  return newest.empty() || !options_.restart.empty() ? "" : ", --restart " + newest + " continues them";
}

void ResultsFolder::check() const {
  if (std::error_code error; fs::is_directory(options_.restart, error)) {
    const std::string newest = newest_checkpoint(options_.restart);
    throw InputError(
        fmt::format("--restart {}: must be a file, but is a folder{}", options_.restart,
                    newest.empty() ? " without a checkpoint" : "; its newest checkpoint is " + newest));
  }
  lock_.check();
  check_results();
}

void ResultsFolder::check_results() const {
  if (options_.overwrite) return;
  const std::vector<std::string> found = results_of_others();
  if (found.empty()) return;
  throw InputError(
      fmt::format("output folder {}: contains results of an earlier run: {}; --overwrite removes them, "
                  "--output DIR writes to another folder{}",
                  options_.folder, fmt::join(found, ", "), way_out()));
}

void ResultsFolder::claim() {
  const std::string& folder = options_.folder;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw IoError(fmt::format("output folder {}: {}", folder, error.message()));
  if (!fs::is_directory(folder)) throw IoError(fmt::format("output folder {}: is a file", folder));
  lock_.take();
  check_results();  // another run may have written and ended meanwhile
}

// History and snapshots continue from the checkpoint of --restart: other checkpoints belong to other states,
// and later restarts must not use them.
void ResultsFolder::set_checkpoints_aside() const {
  for (const char* name : kCheckpoints) {
    const std::string path = options_.folder + "/" + name;
    std::error_code error;
    if (!is_there(path) || fs::equivalent(path, options_.restart, error)) continue;
    fs::rename(path, path + kEarlier, error);
    if (error) throw IoError(fmt::format("{}: cannot rename: {}", path, error.message()));
  }
}

void ResultsFolder::clear() const {
  if (continues()) {
    set_checkpoints_aside();
  } else {
    for (const std::string& name : results_of_others()) remove_file(options_.folder + "/" + name);
    for (const char* name : kCheckpoints) remove_file(options_.folder + "/" + name + kEarlier);
  }
  for (const char* name : kFileNames)
    for (const char* suffix : kCopySuffixes) remove_file(options_.folder + "/" + name + suffix);
}

}  // namespace scree
