// Messages to the user: warnings are kept for the run record, information goes to the terminal.
#pragma once

#include <string>
#include <vector>

namespace scree {

// "error: no such file\n": one printable line of bounded length, whatever the message holds.
std::string message_line(const std::string& kind, const std::string& message);

class Log {
 public:
  // quiet: nothing goes to the terminal (ranks other than 0, tests).
  explicit Log(bool quiet = false) : quiet_(quiet) {}

  void info(const std::string& message);     // to standard output
  void warning(const std::string& message);  // to standard error, and kept
  void error(const std::string& message);    // to standard error
  // Rewrites the progress line in place on a terminal; elsewhere prints a line if `force`, or nothing.
  void progress(const std::string& line, bool force = false);
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  void end_progress_line();
  void complain(const char* kind, const std::string& message);

  bool quiet_ = false;
  bool progress_line_open_ = false;
  std::vector<std::string> warnings_;
};

}  // namespace scree
