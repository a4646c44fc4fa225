#include "run/report/status.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>

#include "base/error.hpp"
#include "base/printable.hpp"
#include "base/utc.hpp"
#include "output/folder_lock.hpp"
#include "output/status_file.hpp"
#include "run/report/progress.hpp"

namespace scree {
namespace {

namespace fs = std::filesystem;

struct Seen {
  RunStatus told;                  // status that the run has written
  std::optional<LockOwner> owner;  // current owner of the folder
  std::string word;                // running, done, stopped, failed, killed, starting
};

// A run locks the folder before it writes a status: until then the file is that of the previous run.
bool is_of_earlier_run(const RunStatus& told, const LockOwner& owner) {
  return !owner.since.empty() && told.written < owner.since;
}

std::string word_of(const RunStatus& told, const std::optional<LockOwner>& owner) {
  if (owner && is_of_earlier_run(told, *owner)) return "starting";
  if (told.state != "running") return told.state.substr(0, told.state.find_first_of(" :"));
  return owner ? "running" : "killed";
}

Seen look_into(const std::string& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) throw InputError(folder + ": no such folder");
  Seen seen;
  seen.owner = FolderLock(folder).owner();
  const bool told = fs::is_regular_file(folder + "/" + kStatusName, error);
  if (!told && seen.owner) {
    seen.word = "starting";
    return seen;
  }
  if (!told) throw InputError(fmt::format("{}: contains no {} of a run", folder, kStatusName));
  seen.told = read_status(folder);
  seen.word = word_of(seen.told, seen.owner);
  if (seen.word != "killed") return seen;
  seen.owner = FolderLock(folder).owner();  // a new run may have started meanwhile
  seen.word = word_of(seen.told, seen.owner);
  return seen;
}

// Age of a UTC time of any machine's clock.
std::string age_text(const std::string& utc) { return duration_text(seconds_since(utc)) + " ago"; }

std::string owner_text(const LockOwner& owner) {
  const bool here = owner.host == LockOwner::this_process().host;
  return owner.described() +
         (here ? ", alive" : ", another host: it counts as alive while it holds the folder's lock");
}

std::string state_text(const Seen& seen) {
  const RunStatus& told = seen.told;
  if (seen.word == "starting")
    return "starting: " + owner_text(*seen.owner) + "; it has not written a status yet";
  const std::string age = age_text(told.written);
  if (seen.word == "running") return fmt::format("running: {}; last status {}", owner_text(*seen.owner), age);
  const std::string process = fmt::format("process {} on host {}", told.process, told.host);
  if (seen.word == "killed")
    return fmt::format(
        "killed: {} wrote its last status {} as running, and does not hold the folder's lock any more",
        process, age);
  return fmt::format("{}; {}, {}", told.state, process, age);
}

double size_on_disk(const std::string& folder) {
  double bytes = 0;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const auto size = entry.file_size(error);
    if (!error) bytes += static_cast<double>(size);
  }
  return bytes;
}

std::string bytes_text(double bytes) {
  const char* unit = "B";
  for (const char* const larger : {"kB", "MB", "GB", "TB"}) {
    if (bytes < 1000) break;
    bytes /= 1000, unit = larger;
  }
  return fmt::format("{:.3g} {}", bytes, unit);
}

std::string checkpoint_text(const RunStatus& told) {
  if (told.checkpoint.empty()) return "none in this run";
  return fmt::format("{}, t = {:.6g} s, written {}", told.checkpoint, told.checkpoint_time,
                     age_text(told.checkpoint_written));
}

// The lines on the run's own status.
std::string told_lines(const Seen& seen) {
  const RunStatus& told = seen.told;
  const Progress& p = told.progress;
  const bool goes_on = seen.word == "running";
  const char* const at_last_row = told.state.starts_with("failed") ? ", at the last row of the history" : "";
  std::string text = fmt::format("deck           {}, backend {}\n", printable(told.deck), told.backend);
  text += fmt::format("simulated      {:.6g} of {:g} s ({})\n", p.time, p.end, percent_text(p));
  if (goes_on) text += fmt::format("time left      {}\n", duration_text(p.seconds_left));
  text += fmt::format("wall time      {}, since {}\n", duration_text(told.wall_seconds), told.started);
  text += fmt::format("steps          {}, the last one of {:.2e} s\n", p.steps, p.step);
  text += fmt::format("rate           {}{}\n", rate_text(p), goes_on ? "" : " at the end");
  text +=
      fmt::format("contacts       {}{}\n", p.contacts < 0 ? "?" : std::to_string(p.contacts), at_last_row);
  text += fmt::format("energy         balance error {:.2e} J of {:.4g} J exchanged ({}){}\n", p.balance_error,
                      p.exchanged, balance_text(p), at_last_row);
  text += fmt::format("checkpoint     {}\n", checkpoint_text(told));
  text +=
      fmt::format("written        {} snapshots, {} rows of the history\n", told.snapshots, told.history_rows);
  return text;
}

std::string warning_lines(const RunStatus& told) {
  std::string text = fmt::format("warnings       {}\n", told.warnings.size());
  for (const std::string& warning : told.warnings) text += "               " + printable(warning) + "\n";
  return text;
}

constexpr std::size_t kColumns = 8;
using Row = std::array<std::string, kColumns>;

Row row_of(const std::string& folder) {
  const Seen seen = look_into(folder);
  const Progress& p = seen.told.progress;
  if (seen.word == "starting") return {folder, seen.word, "", "", "", "", "", ""};
  return {folder,
          seen.word,
          fmt::format("{:.6g} of {:g} s", p.time, p.end),
          percent_text(p),
          std::to_string(p.steps),
          rate_text(p),
          balance_text(p),
          seen.word == "running" ? duration_text(p.seconds_left) : ""};
}

// Aligns the columns. Rows with a folder and a message alone do not widen the other columns.
std::string aligned(const std::vector<Row>& rows) {
  std::array<std::size_t, kColumns> widths{};
  for (const Row& row : rows)
    for (std::size_t c = 0; c < kColumns; ++c)
      if (c == 0 || !row[2].empty()) widths[c] = std::max(widths[c], row[c].size());
  std::string text;
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < kColumns; ++c) line += fmt::format("{:<{}}  ", row[c], widths[c]);
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

}  // namespace

std::string status_report(const std::string& folder) {
  const Seen seen = look_into(folder);
  std::string text = "state          " + printable(state_text(seen)) + "\n";
  if (seen.word != "starting") text += told_lines(seen);
  text += fmt::format("on disk        {}\n", bytes_text(size_on_disk(folder)));
  return seen.word == "starting" ? text : text + warning_lines(seen.told);
}

StatusTable status_table(const std::vector<std::string>& folders) {
  StatusTable table;
  std::vector<Row> rows{{"folder", "state", "simulated", "", "steps", "rate", "balance", "left"}};
  const auto tell_trouble = [&](const std::string& folder, const std::exception& error, ExitCode code) {
    const std::string message = error.what(), start = folder + ": ";
    rows.push_back({folder, message.starts_with(start) ? message.substr(start.size()) : message});
    table.code = code;
  };
  for (const std::string& folder : folders) {
    try {
      rows.push_back(row_of(folder));
    } catch (const InputError& error) {
      tell_trouble(folder, error, ExitCode::bad_input);
    } catch (const IoError& error) {
      tell_trouble(folder, error, ExitCode::io_failed);
    }
  }
  table.text = aligned(rows);
  return table;
}

}  // namespace scree
