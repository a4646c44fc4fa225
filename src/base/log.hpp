// Messages to the user: warnings are kept for the run record, information goes to the terminal.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace scree {

// "error: no such file\n": one printable line of bounded length, whatever the message holds.
std::string message_line(const std::string& kind, const std::string& message);

class Log {
 public:
  // quiet: nothing goes to the terminal (ranks other than 0, tests).
  explicit Log(bool quiet = false) : quiet_(quiet) {}

  void info(const std::string& message);  // to standard output
  // To standard error, and kept. Of warnings that differ in names and numbers alone only the first ten are
  // shown and kept; tell_left_out() says how many more there were, in a warning each, and begins to count
  // anew.
  void warning(const std::string& message);
  void tell_left_out();
  void error(const std::string& message);  // to standard error
  // Rewrites the progress line in place on a terminal; elsewhere prints a line if `force`, or nothing.
  void progress(const std::string& line, bool force = false);
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  void end_progress_line();
  void complain(const char* kind, const std::string& message);

  bool quiet_ = false;
  bool progress_line_open_ = false;
  struct Kind {
    std::size_t shown = 0, left_out = 0;
    std::string first;  // of its warnings
  };
  std::vector<std::string> warnings_;
  std::map<std::string, Kind> kinds_;  // by what their warnings have in common
};

}  // namespace scree
