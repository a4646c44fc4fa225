#include "output/run_record.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <toml++/toml.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <type_traits>

#include "base/index.hpp"
#include "base/version.hpp"
#include "output/durable_file.hpp"
#include "output/library_versions.hpp"

namespace scree {

namespace {

// JSON has no numbers for infinity and NaN: they are written as texts.
void insert_number(toml::table& table, const std::string& key, double value) {
  if (std::isfinite(value)) {
    table.insert_or_assign(key, value);
  } else {
    table.insert_or_assign(key, fmt::format("{}", value));
  }
}

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

toml::array lines(const std::string& text) {
  toml::array result;
  std::istringstream all(text);
  for (std::string line; std::getline(all, line);) result.push_back(line);
  return result;
}

toml::table run_table(const RunRecord& record) {
  return toml::table{{"deck_path", record.deck_path},
                     {"resolved_deck", record.resolved_deck},
                     {"command_line", record.command_line},
                     {"status", record.status},
                     {"stop_condition", record.stop_condition},
                     {"exit_code", record.exit_code},
                     {"started", record.started},
                     {"ended", record.ended},
                     {"backend", record.backend},
                     {"solver", record.solver},
                     {"start_change", record.start_change},
                     {"redundancy", record.redundancy},
                     {"restarted_from", record.restarted_from},
                     {"changes", lines(record.changes)},
                     {"state_hash", record.state_hash},
                     {"ranks", record.ranks}};
}

toml::table build_table() {
  toml::table libraries;
  for (const auto& [name, text] : library_versions()) libraries.insert_or_assign(name, text);
  return toml::table{{"version", version()},
                     {"commit", commit()},
                     {"compiler", compiler()},
                     {"flags", compile_flags()},
                     {"libraries", libraries}};
}

// Costs of this start.
toml::table cost_table(const RunRecord& record) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  toml::table table;
  const RunStart own = record.starts.empty() ? RunStart{} : record.starts.back();
  insert_number(table, "wall_seconds", own.wall_seconds);
  insert_number(table, "loop_seconds", own.loop_seconds);
  insert_number(table, "cpu_seconds", own.cpu_seconds);
  table.insert_or_assign("peak_memory_kib", static_cast<std::int64_t>(usage.ru_maxrss));
  table.insert_or_assign("device_memory_kib", record.device_bytes / 1024);
  return table;
}

toml::table start_table(const RunStart& start) {
  toml::table table;
  for_each_entry(start, [&]<class Value>(const char* name, const Value& value) {
    if constexpr (std::is_same_v<Value, Real>)
      insert_number(table, name, value);
    else
      table.insert_or_assign(name, value);
  });
  return table;
}

toml::array start_array(const std::vector<RunStart>& starts) {
  toml::array array;
  for (const RunStart& start : starts) array.push_back(start_table(start));
  return array;
}

// Costs of all starts.
toml::table total_table(const std::vector<RunStart>& starts) {
  const RunStart sum = sum_of(starts);
  toml::table table{{"starts", static_cast<std::int64_t>(starts.size())}, {"steps", sum.steps}};
  insert_number(table, "wall_seconds", sum.wall_seconds);
  insert_number(table, "loop_seconds", sum.loop_seconds);
  insert_number(table, "cpu_seconds", sum.cpu_seconds);
  return table;
}

// Stages in the order of a step.
toml::array stage_array(const StageTimers& timers) {
  toml::array stages;
  for (int s = 0; s < static_cast<int>(Stage::count); ++s) {
    const StageTimers::Entry& entry = timers[static_cast<Stage>(s)];
    toml::table stage{{"stage", kStageNames[as_size(s)]}, {"calls", entry.calls}};
    insert_number(stage, "seconds", entry.seconds);
    stages.push_back(stage);
  }
  return stages;
}

}  // namespace

void write_run_record(const std::string& directory, const RunRecord& record) {
  toml::table counts, measures;
  for (const auto& [name, value] : record.counts) counts.insert_or_assign(name, value);
  for (const auto& [name, value] : record.measures) insert_number(measures, name, value);
  toml::array warnings;
  for (const std::string& warning : record.warnings) warnings.push_back(warning);
  const toml::table document{{"run", run_table(record)},
                             {"build", build_table()},
                             {"host", toml::table{{"name", host_name()}, {"processor", processor()}}},
                             {"cost", cost_table(record)},
                             {"starts", start_array(record.starts)},
                             {"total", total_table(record.starts)},
                             {"stages", stage_array(record.timers)},
                             {"counts", counts},
                             {"measures", measures},
                             {"warnings", warnings}};
  std::ostringstream text;
  text << toml::json_formatter{document} << '\n';
  write_text_file(directory + "/run_record.json", text.str());
}

}  // namespace scree
