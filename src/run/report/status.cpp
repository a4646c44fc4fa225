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

struct Observed {
  RunStatus status;                // status that the run has written
  std::optional<LockOwner> owner;  // current owner of the folder
  std::string state;               // running, done, stopped, failed, killed, starting
};

// A run locks the folder before it writes a status: until then the file is that of the previous run.
bool is_of_earlier_run(const RunStatus& status, const LockOwner& owner) {
  return !owner.since.empty() && status.written < owner.since;
}

std::string state_of(const RunStatus& status, const std::optional<LockOwner>& owner) {
  if (owner && is_of_earlier_run(status, *owner)) return "starting";
  if (status.state != "running") return status.state.substr(0, status.state.find_first_of(" :"));
  return owner ? "running" : "killed";
}

Observed observe(const std::string& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) throw InputError(folder + ": no such folder");
  Observed observed;
  observed.owner = FolderLock(folder).owner();
  const bool has_status = fs::is_regular_file(folder + "/" + kStatusName, error);
  if (!has_status && observed.owner) {
    observed.state = "starting";
    return observed;
  }
  if (!has_status) throw InputError(fmt::format("{}: contains no {} of a run", folder, kStatusName));
  observed.status = read_status(folder);
  observed.state = state_of(observed.status, observed.owner);
  if (observed.state != "killed") return observed;
  observed.owner = FolderLock(folder).owner();  // a new run may have started meanwhile
  observed.state = state_of(observed.status, observed.owner);
  return observed;
}

// Age of a UTC time of any machine's clock.
std::string age_text(const std::string& utc) { return duration_text(seconds_since(utc)) + " ago"; }

std::string owner_text(const LockOwner& owner) {
  const bool here = owner.host == LockOwner::this_process().host;
  return owner.described() +
         (here ? ", alive" : ", another host: it counts as alive while it holds the folder's lock");
}

std::string state_text(const Observed& observed) {
  const RunStatus& status = observed.status;
  if (observed.state == "starting")
    return "starting: " + owner_text(*observed.owner) + "; it has not written a status yet";
  const std::string age = age_text(status.written);
  if (observed.state == "running")
    return fmt::format("running: {}; last status {}", owner_text(*observed.owner), age);
  const std::string process = fmt::format("process {} on host {}", status.process, status.host);
  if (observed.state == "killed")
    return fmt::format(
        "killed: {} wrote its last status {} as running, and does not hold the folder's lock any more",
        process, age);
  return fmt::format("{}; {}, {}", status.state, process, age);
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

std::string checkpoint_text(const RunStatus& status) {
  if (status.checkpoint.empty()) return "none in this run";
  return fmt::format("{}, t = {:.6g} s, written {}", status.checkpoint, status.checkpoint_time,
                     age_text(status.checkpoint_written));
}

// The lines on the run's own status.
std::string status_lines(const Observed& observed) {
  const RunStatus& status = observed.status;
  const Progress& p = status.progress;
  const bool is_running = observed.state == "running";
  const char* const at_last_row =
      status.state.starts_with("failed") ? ", at the last row of the history" : "";
  std::string text = fmt::format("deck           {}, backend {}\n", printable(status.deck), status.backend);
  text += fmt::format("simulated      {:.6g} of {:g} s ({})\n", p.time, p.end, percent_text(p));
  if (!status.stop_condition.empty())
    text += fmt::format("ended by       stop condition {}\n", printable(status.stop_condition));
  if (is_running) text += fmt::format("time left      {}\n", duration_text(p.seconds_left));
  text += fmt::format("wall time      {}, since {}\n", duration_text(status.wall_seconds), status.started);
  text += fmt::format("steps          {}, the last one of {:.2e} s\n", p.steps, p.step);
  text += fmt::format("rate           {}{}\n", rate_text(p), is_running ? "" : " at the end");
  text +=
      fmt::format("contacts       {}{}\n", p.contacts < 0 ? "?" : std::to_string(p.contacts), at_last_row);
  text += fmt::format("energy         balance error {:.2e} J of {:.4g} J exchanged ({}){}\n", p.balance_error,
                      p.exchanged, balance_text(p), at_last_row);
  text += fmt::format("checkpoint     {}\n", checkpoint_text(status));
  text += fmt::format("written        {} snapshots, {} rows of the history\n", status.snapshots,
                      status.history_rows);
  return text;
}

std::string warning_lines(const RunStatus& status) {
  std::string text = fmt::format("warnings       {}\n", status.warnings.size());
  for (const std::string& warning : status.warnings) text += "               " + printable(warning) + "\n";
  return text;
}

constexpr std::size_t kColumns = 8;
using Row = std::array<std::string, kColumns>;

Row row_of(const std::string& folder) {
  const Observed observed = observe(folder);
  const Progress& p = observed.status.progress;
  if (observed.state == "starting") return {folder, observed.state, "", "", "", "", "", ""};
  return {folder,
          observed.state,
          fmt::format("{:.6g} of {:g} s", p.time, p.end),
          percent_text(p),
          std::to_string(p.steps),
          rate_text(p),
          balance_text(p),
          observed.state == "running" ? duration_text(p.seconds_left) : ""};
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
  const Observed observed = observe(folder);
  std::string text = "state          " + printable(state_text(observed)) + "\n";
  if (observed.state != "starting") text += status_lines(observed);
  text += fmt::format("on disk        {}\n", bytes_text(size_on_disk(folder)));
  return observed.state == "starting" ? text : text + warning_lines(observed.status);
}

StatusTable status_table(const std::vector<std::string>& folders) {
  StatusTable table;
  std::vector<Row> rows{{"folder", "state", "simulated", "", "steps", "rate", "balance", "left"}};
  const auto add_error_row = [&](const std::string& folder, const std::exception& error, ExitCode code) {
    const std::string message = error.what(), start = folder + ": ";
    rows.push_back({folder, message.starts_with(start) ? message.substr(start.size()) : message});
    table.code = code;
  };
  for (const std::string& folder : folders) {
    try {
      rows.push_back(row_of(folder));
    } catch (const InputError& error) {
      add_error_row(folder, error, ExitCode::bad_input);
    } catch (const IoError& error) {
      add_error_row(folder, error, ExitCode::io_failed);
    }
  }
  table.text = aligned(rows);
  return table;
}

}  // namespace scree
