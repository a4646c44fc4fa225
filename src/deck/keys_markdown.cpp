// The reference page of the keys, printed by `scree keys --markdown`.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "deck/keys.hpp"
#include "deck/wrapped.hpp"

namespace scree {

namespace {

constexpr std::size_t kWidth = 120;

constexpr const char* kIntroduction =
    "This page is made by `scree keys --markdown`; `scree keys` prints the same for a terminal. "
    "[README.md](README.md) describes how the keys are used together, [limits.md](limits.md) what is not "
    "modelled. `[name]` is a table; `[[name]]` is an element of a list and may occur any number of times. "
    "Quantities are in SI units, angles in radians.";

constexpr const char* kEditors =
    "Editors complete and check decks with the JSON schema `postprocess/scree/deck.schema.json`, which "
    "`scree keys --schema` prints. Editors that use [Taplo](https://taplo.tamasfe.dev), such as VS Code with "
    "the extension Even Better TOML, read it where the first line of the deck names it, by its path from the "
    "deck or as a URL:";

constexpr const char* kSchemaLine = "    #:schema ../../postprocess/scree/deck.schema.json\n";

constexpr const char* kNoSchemaKnows =
    "A schema cannot express all rules; `scree check DECK` checks all of them.";

// Escapes a text for Markdown; text between backticks is code and stays as it is.
std::string escaped(const std::string& text) {
  std::string result;
  bool code = false;
  for (const char c : text) {
    if (c == '`') code = !code;
    if (c == '|' || (!code && std::string_view("\\*_[]<>#").find(c) != std::string_view::npos))
      result += '\\';
    result += c;
  }
  return result;
}

bool is_table(const Key& key) { return key.type == ValueType::table || key.type == ValueType::tables; }

std::string header_of(const Key& key, const std::string& path) {
  return key.type == ValueType::table ? fmt::format("`[{}]`", path) : fmt::format("`[[{}]]`", path);
}

std::string path_of(const std::string& table, const Key& key) {
  return table.empty() ? key.name : table + "." + key.name;
}

std::string link(const std::string& text, const std::string& anchor) {
  return fmt::format("[{}](#{})", text, anchor);
}

std::string values_text(const Key& key) {
  if (key.type != ValueType::quantity) return escaped(allowed_values(key, 0));
  const bool distribution = key.table == &distribution_keys();
  return fmt::format(
      "a number \\[{}\\] or a {}", escaped(key.unit),
      distribution ? link("distribution", "distribution") : link("function of time", "time_function"));
}

// The cell in the column of the default values.
std::string cell_of_default(const Key& key) {
  const std::string text = default_text(key), word = "default ";
  return escaped(text.starts_with(word) ? text.substr(word.size()) : text);
}

void describe_keys(std::string& out, const TableKeys& table, const std::string& path) {
  out += "| key | takes | default | meaning |\n|---|---|---|---|\n";
  for (const Key& key : table.keys) {
    if (is_table(key)) continue;
    std::string takes = values_text(key);
    for (const std::string& more : {kinds_text(key, table.selector), former_text(key)})
      if (!more.empty()) takes += "; " + escaped(more);
    out += fmt::format("| <a id=\"{}\"></a>`{}` | {} | {} | {} |\n", path_of(path, key), key.name, takes,
                       cell_of_default(key), escaped(key.sentence));
  }
  out += "\n";
}

void describe_table(std::string& out, const TableKeys& table, const std::string& path,
                    const std::string& header) {
  out += fmt::format("<a id=\"{}\"></a>\n\n## {}\n\n", path.empty() ? "top" : path, header);
  if (!table.sentence.empty()) out += wrapped(escaped(table.sentence), kWidth) + "\n";
  describe_keys(out, table, path);
  std::vector<std::string> below;
  for (const Key& key : table.keys)
    if (is_table(key) && !path.empty())
      below.push_back(link(header_of(key, path_of(path, key)), path_of(path, key)));
  if (!below.empty()) out += wrapped(fmt::format("Tables in it: {}.", fmt::join(below, ", ")), kWidth) + "\n";
}

// Calls use(key, path, header) for each table, outer tables first.
template <class Use>
void for_each_table(const TableKeys& table, const std::string& path, const Use& use) {
  for (const Key& key : table.keys) {
    if (!is_table(key)) continue;
    const std::string name = path_of(path, key);
    use(key, name, header_of(key, name));
    for_each_table(*key.table, name, use);
  }
}

}  // namespace

std::string keys_markdown() {
  std::string out = "# Keys of a deck\n\n" + wrapped(kIntroduction, kWidth) + "\n" +
                    wrapped(kEditors, kWidth) + "\n" + kSchemaLine + "\n" + wrapped(kNoSchemaKnows, kWidth) +
                    "\n";
  std::vector<std::string> contents{link("top of the deck", "top")};
  for_each_table(deck_keys(), "", [&](const Key&, const std::string& path, const std::string& header) {
    contents.push_back(link(header, path));
  });
  contents.push_back(link("functions of time", "time_function"));
  contents.push_back(link("distributions", "distribution"));
  contents.push_back(link("output fields", "output_fields"));
  out += wrapped(fmt::format("{}", fmt::join(contents, ", ")), kWidth) + "\n";
  describe_table(out, deck_keys(), "", "Top of the deck");
  for_each_table(deck_keys(), "", [&](const Key& key, const std::string& path, const std::string& header) {
    describe_table(out, *key.table, path, header + (key.is_required ? " (required)" : ""));
  });
  describe_table(out, time_function_keys(), "time_function", "Functions of time");
  describe_table(out, distribution_keys(), "distribution", "Distributions");
  return out;
}

}  // namespace scree
