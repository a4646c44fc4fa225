#include "base/log.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>

#include "base/printable.hpp"

namespace scree {

namespace {

// Whether standard output is the terminal that this process runs on. mpirun gives its ranks another one, and
// copies what they write there, perhaps into the log of a batch job.
bool on_own_terminal() { return tcgetpgrp(STDOUT_FILENO) == getpgrp(); }

// Columns of the terminal; none where it does not say.
std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

constexpr std::size_t kLongest = 1200;  // of a warning or an error [B]

}  // namespace

void Log::end_progress_line() {
  if (progress_line_open_) std::fputc('\n', stdout);
  progress_line_open_ = false;
}

void Log::info(const std::string& message) {
  if (quiet_) return;
  end_progress_line();
  std::fprintf(stdout, "%s\n", message.c_str());
  std::fflush(stdout);
}

void Log::complain(const char* kind, const std::string& message) {
  if (quiet_) return;
  end_progress_line();
  std::fflush(stdout);
  std::fputs(message_line(kind, message).c_str(), stderr);
}

std::string message_line(const std::string& kind, const std::string& message) {
  return kind + ": " + shortened(printable(message), kLongest) + "\n";
}

void Log::warning(const std::string& message) {
  warnings_.push_back(message);
  complain("warning", message);
}

void Log::error(const std::string& message) { complain("error", message); }

void Log::progress(const std::string& line, bool force) {
  if (quiet_) return;
  if (on_own_terminal()) {
    // A line that wraps could not be rewritten.
    const std::size_t width = terminal_width();
    const std::string fitting = width > 1 ? line.substr(0, width - 1) : line;
    std::fprintf(stdout, "\r%s\033[K", fitting.c_str());
    progress_line_open_ = true;
  } else if (force) {
    std::fprintf(stdout, "%s\n", line.c_str());
  }
  std::fflush(stdout);
}

}  // namespace scree
