#include "output/status_file.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <sstream>

#include "base/error.hpp"
#include "base/printable.hpp"
#include "output/durable_file.hpp"

namespace scree {

namespace {

constexpr const char* kStopCondition = "stop_condition";

// Calls use(name, value) for the entries of the file.
template <class Status, class Use>
void for_each_entry(Status& s, const Use& use) {
  auto& p = s.progress;
  use("state", s.state), use(kStopCondition, s.stop_condition);
  use("host", s.host), use("process", s.process);
  use("started", s.started), use("written", s.written);
  use("deck", s.deck), use("backend", s.backend), use("ranks", s.ranks);
  use("time", p.time), use("end", p.end), use("steps", p.steps), use("step", p.step);
  use("particles", p.particles), use("contacts", p.contacts);
  use("balance_error", p.balance_error), use("exchanged", p.exchanged);
  use("step_rate", p.step_rate), use("particle_step_rate", p.particle_step_rate);
  use("seconds_left", p.seconds_left), use("wall_seconds", s.wall_seconds);
  use("checkpoint", s.checkpoint), use("checkpoint_written", s.checkpoint_written);
  use("checkpoint_time", s.checkpoint_time);
  use("snapshots", s.snapshots), use("history_rows", s.history_rows), use("warnings", s.warnings);
}

using Texts = std::vector<std::string>;

// TOML is UTF-8, which texts of others may not be.
void insert(toml::table& table, const char* name, const std::string& text) {
  table.insert(name, printable(text));
}

void insert(toml::table& table, const char* name, const Texts& texts) {
  toml::array array;
  for (const std::string& text : texts) array.push_back(printable(text));
  table.insert(name, array);
}

template <class Number>
void insert(toml::table& table, const char* name, Number value) {
  table.insert(name, value);
}

template <class Value>
bool take(const toml::table& table, const char* name, Value& value) {
  const auto found = table[name].value_exact<Value>();
  if (found) value = *found;
  return found.has_value();
}

bool take(const toml::table& table, const char* name, Texts& texts) {
  const toml::array* const array = table[name].as_array();
  if (array == nullptr) return false;
  for (const toml::node& text : *array) texts.push_back(text.value_or(std::string()));
  return true;
}

toml::table parsed(const std::string& path) {
  const std::string text = read_text_file(path);
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw IoError(fmt::format("{}: is damaged: {}", path, error.description()));
  }
}

}  // namespace

void write_status(const std::string& folder, const RunStatus& status) {
  toml::table table;
  for_each_entry(status, [&](const char* name, const auto& value) { insert(table, name, value); });
  std::ostringstream text;
  text << table << '\n';
  write_text_file(folder + "/" + kStatusName, text.str());
}

RunStatus read_status(const std::string& folder) {
  const std::string path = folder + "/" + kStatusName;
  const toml::table table = parsed(path);
  RunStatus status;
  for_each_entry(status, [&](const char* name, auto& value) {
    const bool is_new = name == kStopCondition;  // files of earlier versions lack it
    if (!take(table, name, value) && !is_new)
      throw IoError(fmt::format("{}: is damaged: {} is missing", path, name));
  });
  return status;
}

}  // namespace scree
