#include "output/run_starts.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <sstream>

#include "base/error.hpp"

namespace scree {

namespace {

constexpr const char* kStarts = "starts";

}  // namespace

RunStart sum_of(const std::vector<RunStart>& starts) {
  RunStart sum;
  for (const RunStart& start : starts) {
    if (&start == &starts.front()) sum = start, sum.steps = 0;
    sum.to = start.to, sum.steps += start.steps;
  }
  sum.wall_seconds = sum.loop_seconds = sum.cpu_seconds = 0;
  for (const RunStart& start : starts) {
    sum.wall_seconds += start.wall_seconds, sum.loop_seconds += start.loop_seconds;
    sum.cpu_seconds += start.cpu_seconds;
  }
  return sum;
}

std::string to_text(const std::vector<RunStart>& starts) {
  toml::array array;
  for (const RunStart& start : starts) {
    toml::table table;
    for_each_entry(start, [&](const char* name, const auto& value) { table.insert(name, value); });
    array.push_back(table);
  }
  std::ostringstream text;
  text << toml::table{{kStarts, array}} << '\n';
  return text.str();
}

std::vector<RunStart> starts_in(const std::string& text, const std::string& path) {
  const auto refuse = [&](std::string_view why) {
    throw IoError(fmt::format("{}: the list of the run's starts is damaged: {}", path, why));
  };
  toml::table all;
  try {
    all = toml::parse(text);
  } catch (const toml::parse_error& error) {
    refuse(error.description());
  }
  std::vector<RunStart> starts;
  const toml::array* const array = all[kStarts].as_array();
  if (array == nullptr) refuse("it is missing");
  for (const toml::node& node : *array) {
    const toml::table* const table = node.as_table();
    if (table == nullptr) refuse("an entry is not a table");
    for_each_entry(starts.emplace_back(), [&]<class Value>(const char* name, Value& value) {
      const auto found = (*table)[name].value_exact<Value>();
      found ? value = *found : (refuse(fmt::format("{} is missing", name)), value);
    });
  }
  return starts;
}

}  // namespace scree
