// The status that a run publishes while it goes on.
#include "output/status_file.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/error.hpp"
#include "base/utc.hpp"
#include "scratch.hpp"
#include "support/catch.hpp"

namespace scree {

namespace {

RunStatus some_status() {
  RunStatus s;
  s.state = "failed: stage \"output\"\n", s.host = "node1", s.process = "17";
  s.started = "2026-01-01T00:00:00Z", s.written = utc_now();
  s.progress.time = 0.1, s.progress.end = 1, s.progress.steps = 12345678901;
  s.warnings = {"first", "second \xff"};
  return s;
}

std::string message_of_reading(const std::string& folder) {
  try {
    read_status(folder);
  } catch (const IoError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a status is read back as it was written") {
  const ScratchDirectory scratch;
  const RunStatus written = some_status();
  write_status(scratch.path(), written);
  const RunStatus read = read_status(scratch.path());
  CHECK(read.state == "failed: stage \"output\"\\n");  // on one line
  CHECK(read.process == "17");
  CHECK(read.progress.time == written.progress.time);
  CHECK(read.progress.steps == written.progress.steps);
  CHECK(std::isnan(read.progress.seconds_left));
  CHECK(read.warnings == std::vector<std::string>{"first", "second \\xff"});
  CHECK(seconds_since(read.written) >= 0);
  CHECK(seconds_since(read.written) < 60);
  CHECK(std::isnan(seconds_since("yesterday")));
  CHECK_FALSE(std::filesystem::exists(scratch / "status.toml.tmp"));
}

TEST_CASE("a status that is damaged is named") {
  const ScratchDirectory scratch;
  CHECK(message_of_reading(scratch.path()) ==
        scratch / kStatusName + ": cannot be read: No such file or directory");
  write_status(scratch.path(), some_status());
  std::ifstream file(scratch / kStatusName);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  for (const std::size_t length : {std::size_t{0}, text.size() / 3, text.size() - 30}) {
    std::ofstream(scratch / kStatusName) << text.substr(0, length);
    INFO(length);
    CHECK(message_of_reading(scratch.path()).find("status.toml: is damaged: ") != std::string::npos);
  }
}

}  // namespace scree
