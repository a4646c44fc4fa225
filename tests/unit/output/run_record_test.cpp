#include "output/run_record.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/error.hpp"
#include "base/version.hpp"
#include "output/library_versions.hpp"
#include "scratch.hpp"
#include "support/catch.hpp"

using namespace scree;

namespace {

std::string record_text(const ScratchDirectory& scratch, const RunRecord& record) {
  write_run_record(scratch.path(), record);
  std::ifstream file(scratch / "run_record.json");
  return {std::istreambuf_iterator<char>(file), {}};
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("the run record holds what was run and with what") {
  ScratchDirectory scratch;
  RunRecord record;
  record.deck_path = "input/a.toml";
  record.resolved_deck = "title = \"x\"\n";
  record.status = "failed: \"quoted\" \\ text";
  record.exit_code = 3;
  record.starts.resize(2), record.device_bytes = 4096;
  record.starts[0].steps = 7, record.starts[0].loop_seconds = 1.25;
  record.starts[1].steps = 8, record.starts[1].loop_seconds = 2.5;
  record.counts = {{"steps", 1234567890123}};
  record.measures = {{"simulated_time", 0.1}, {"balance_error", NAN}};
  record.warnings = {"first", "second"};
  { const auto scope = record.timers.time(Stage::contact_force); }
  const std::string text = record_text(scratch, record);
  CHECK(holds(text, R"("deck_path" : "input/a.toml")"));
  CHECK(holds(text, R"("resolved_deck" : "title = \"x\"\n")"));
  CHECK(holds(text, R"("status" : "failed: \"quoted\" \\ text")"));
  CHECK(holds(text, R"("exit_code" : 3)"));
  CHECK(holds(text, R"("loop_seconds" : 2.5)"));   // this start
  CHECK(holds(text, R"("loop_seconds" : 3.75)"));  // all starts
  CHECK((holds(text, R"("steps" : 7)") && holds(text, R"("steps" : 15)")));
  CHECK(holds(text, R"("device_memory_kib" : 4)"));
  CHECK(holds(text, R"("steps" : 1234567890123)"));
  CHECK(holds(text, R"("balance_error" : "nan")"));  // JSON has no NaN
  CHECK(holds(text, R"("commit" : ")" + commit()));
  CHECK(holds(text, R"("version" : ")" + version()));
  CHECK(holds(text, R"("stage" : "contact_force")"));
  CHECK(holds(text, R"("HDF5" : ")"));
  CHECK(text.find("\"first\"") < text.find("\"second\""));
}

TEST_CASE("the run record replaces the old one") {
  ScratchDirectory scratch;
  RunRecord record;
  record.status = "running";
  record_text(scratch, record);
  record.status = "done";
  const std::string text = record_text(scratch, record);
  CHECK(holds(text, "\"done\""));
  CHECK(!holds(text, "\"running\""));
  CHECK(!std::filesystem::exists(scratch / "run_record.json.tmp"));
  CHECK_THROWS_AS(write_run_record(scratch / "no_such_directory", record), IoError);
}

TEST_CASE("versions are known") {
  CHECK(!version().empty());
  CHECK(!commit().empty());
  CHECK(!compiler().empty());
  CHECK(!compile_flags().empty());
  for (const auto& [library, number] : library_versions()) {
    CAPTURE(library);
    CHECK(number.find_first_of("123456789") != std::string::npos);
  }
}
