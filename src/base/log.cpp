#include "base/log.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>

#include "base/printable.hpp"

namespace scree {

namespace {

// Whether standard output is the terminal of this process. mpirun gives its ranks another terminal, whose
// output it copies, perhaps into the log of a batch job.
bool on_own_terminal() { return tcgetpgrp(STDOUT_FILENO) == getpgrp(); }

// Number of columns of the terminal; 0 if it is not known.
std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

constexpr std::size_t kLongest = 1200;  // of a warning or an error [B]
constexpr std::size_t kMostOfAKind = 10, kShownOfFirst = 120;
constexpr std::size_t kIdentifyingBytes = 60;  // length of the common beginning that identifies a kind [B]

// The common beginning of warnings of one kind: the first words without quoted texts, words with digits, and
// positions in the deck after the name of the table ("deck.toml:3:1: bodies.arm.mass").
std::string common_beginning(const std::string& message) {
  std::string words, word;
  char quote = 0;
  const auto close = [&] {
    const bool counts = word.find_first_of("0123456789/=") == word.npos;
    if (counts && !word.empty()) words += word.substr(0, word.find('.')) + ' ';
    word.clear();
  };
  for (const char c : message) {
    if (words.size() >= kIdentifyingBytes) break;
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || (c == '\'' && word.empty())) {
      quote = c;
    } else if (c == ' ' || c == ',') {
      close();
    } else {
      word += c;
    }
  }
  close();
  return words;
}

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
  Kind& kind = kinds_[common_beginning(message)];
  if (kind.shown == kMostOfAKind) {
    ++kind.left_out;
    return;
  }
  if (kind.shown++ == 0) kind.first = message;
  warnings_.push_back(message);
  complain("warning", message);
}

void Log::report_suppressed() {
  for (auto& [words, kind] : kinds_) {
    if (kind.left_out == 0) continue;
    warnings_.push_back(std::to_string(kind.left_out) +
                        (kind.left_out == 1 ? " more warning" : " more warnings") +
                        " like this one: " + shortened(printable(kind.first), kShownOfFirst));
    complain("warning", warnings_.back());
    kind.left_out = 0;
  }
}

void Log::error(const std::string& message) { complain("error", message); }

void Log::progress(const std::string& line, bool force) {
  if (quiet_) return;
  if (on_own_terminal()) {
    // A line that wraps cannot be rewritten.
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
