// Messages to the user: warnings are stored for the run record, information goes to the terminal.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace scree {

// "error: no such file\n": one printable line of limited length, whatever the message contains.
std::string message_line(const std::string& kind, const std::string& message);

class Log {
 public:
  // quiet: without output to the terminal (ranks other than 0, tests).
  explicit Log(bool quiet = false) : quiet_(quiet) {}

  void info(const std::string& message);  // to standard output
  // To standard error, and stored. Of warnings that differ only in names and numbers the first ten are shown
  // and stored; report_suppressed() issues a warning with the number of the others per kind, and resets the
  // counts.
  void warning(const std::string& message);
  void report_suppressed();
  void error(const std::string& message);  // to standard error
  // Rewrites the progress line on a terminal; elsewhere prints a line only with `force`.
  void progress(const std::string& line, bool force = false);
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  void end_progress_line();
  void complain(const char* kind, const std::string& message);

  bool quiet_ = false;
  bool progress_line_open_ = false;
  struct Kind {
    std::size_t shown = 0, left_out = 0;
    std::string first;  // first warning of this kind
  };
  std::vector<std::string> warnings_;
  std::map<std::string, Kind> kinds_;  // by the common beginning of the warnings
};

}  // namespace scree
