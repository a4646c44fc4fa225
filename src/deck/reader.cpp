#include "deck/reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "base/printable.hpp"
#include "deck/choices.hpp"
#include "deck/source_text.hpp"
#include "deck/suggestion.hpp"

namespace scree {

namespace {

class Reader {
 public:
  Reader(const toml::table& deck, const SourceText& source, std::string deck_path, int dimension)
      : deck_(deck), source_(source), deck_path_(std::move(deck_path)), dimension_(dimension) {}

  // quantity_unit: of the quantity that the table represents.
  DeckTable read_table(const toml::table& source, const TableKeys& keys, const std::string& path,
                       const std::string& location, const std::string& quantity_unit = "") const;

 private:
  // The key whose value is being read.
  struct Context {
    const Key& key;
    std::string path;                // of the key
    std::string location;            // of the value
    std::string quantity_unit = "";  // of the quantity whose table has the key
  };

  void check_key(const toml::key& key, const toml::node& node, const TableKeys& keys,
                 const DeckTable& table) const;
  void read_key(const toml::table& source, const Key& key, DeckTable& table,
                const std::string& quantity_unit) const;
  void fill_default(const Context& context, DeckTable& table) const;
  // Whether the default that depends on another key's value applies.
  bool follows_another_key(const Key& key) const;
  const std::string& default_value(const Key& key) const;
  [[noreturn]] void fail_missing(const Context& context, const DeckTable& table) const;
  DeckValue read_value(const toml::node& node, const Context& context) const;
  std::vector<DeckTable> read_tables(const toml::node& node, const Context& context) const;
  DeckTable read_quantity(const toml::node& node, const Context& context) const;
  Real number(const toml::node& node, const toml::node& whole, const Context& context) const;
  std::int64_t integer(const toml::node& node, const toml::node& whole, const Context& context) const;
  std::string text(const toml::node& node, const Context& context) const;
  std::string file(const std::string& value, const toml::node& node, const Context& context) const;
  Vec3 vector(const toml::node& node, const toml::node& whole, const Context& context) const;
  const toml::array& list(const toml::node& node, const Context& context) const;
  template <class T, class ReadEntry>
  std::vector<T> entries(const toml::node& node, const Context& context, const ReadEntry& read_entry) const;
  std::string allowed(const Context& context) const;
  [[noreturn]] void fail(const toml::node& node, const Context& context,
                         const std::string& detail = "") const;

  const toml::table& deck_;
  const SourceText& source_;
  std::string deck_path_;
  int dimension_;
};

// Whether the table's selector has one of these words.
bool is_of(const DeckTable& table, const std::vector<std::string>& kinds) {
  return !kinds.empty() &&
         std::find(kinds.begin(), kinds.end(), table.text(table.keys().selector)) != kinds.end();
}

// Whether the text can be a name: names are referred to, and are parts of paths in HDF5 files.
bool is_name(const std::string& text) {
  return !text.empty() && text.size() <= kLongestName && text != "." && text != ".." &&
         text.find('/') == std::string::npos && printable(text) == text;
}

DeckTable Reader::read_table(const toml::table& source, const TableKeys& keys, const std::string& path,
                             const std::string& location, const std::string& quantity_unit) const {
  DeckTable table(keys, path, location);
  for (const Key& key : keys.keys) {
    if (key.name == keys.selector) read_key(source, key, table, quantity_unit);
  }
  for (const auto& [name, node] : source) check_key(name, node, keys, table);
  for (const Key& key : keys.keys) {
    if (key.name != keys.selector) read_key(source, key, table, quantity_unit);
  }
  return table;
}

// Throws InputError for a key that is not declared, or not for this kind of table.
void Reader::check_key(const toml::key& name, const toml::node& node, const TableKeys& keys,
                       const DeckTable& table) const {
  const std::string key_name(name.str());
  const std::string path = join_path(table.path(), key_name);
  const std::string at = location_of(name.source().path ? name.source() : node.source(), table.location());
  const auto found =
      std::find_if(keys.keys.begin(), keys.keys.end(), [&](const Key& k) { return k.name == key_name; });
  if (found == keys.keys.end()) {
    std::vector<std::string> names;
    for (const Key& key : keys.keys) names.push_back(key.name);
    throw InputError(fmt::format("{}: {} = {}: unknown key{}", at, path, shown(node, source_),
                                 key_suggestion(key_name, names)));
  }
  if (found->kinds.empty() || is_of(table, found->kinds)) return;
  throw InputError(fmt::format("{}: {} = {}: not used with {} = \"{}\", only with \"{}\"", at, path,
                               shown(node, source_), keys.selector, table.text(keys.selector),
                               fmt::join(found->kinds, "\", \"")));
}

void Reader::read_key(const toml::table& source, const Key& key, DeckTable& table,
                      const std::string& quantity_unit) const {
  if (!key.kinds.empty() && !is_of(table, key.kinds)) return;
  Context context{key, join_path(table.path(), key.name), table.location(), quantity_unit};
  if (const toml::node* node = source.get(key.name)) {
    context.location = location_of(node->source(), table.location());
    DeckValue value = read_value(*node, context);
    value.is_given = true;
    table.set(key.name, std::move(value));
  } else if (key.is_required || is_of(table, key.required_kinds)) {
    fail_missing(context, table);
  } else {
    fill_default(context, table);
  }
}

void Reader::fail_missing(const Context& context, const DeckTable& table) const {
  const std::string& selector = table.keys().selector;
  const std::string with =
      context.key.is_required ? "" : fmt::format("with {} = \"{}\" ", selector, table.text(selector));
  throw InputError(fmt::format("{}: {}: missing; {}it must be {}", context.location, context.path, with,
                               allowed(context)));
}

bool Reader::follows_another_key(const Key& key) const {
  return !key.where_key.empty() && deck_.at_path(key.where_key).value_or(std::string()) == key.where_value;
}

const std::string& Reader::default_value(const Key& key) const {
  return follows_another_key(key) ? key.default_there : key.default_value;
}

void Reader::fill_default(const Context& context, DeckTable& table) const {
  const Key& key = context.key;
  const std::string& location = context.location;
  if (key.type == ValueType::tables) {
    table.set(key.name, {std::vector<DeckTable>{}, location, "[]"});
  } else if (key.type == ValueType::table) {
    table.set(key.name, {std::vector{read_table({}, *key.table, context.path, location)}, location, "{}"});
  } else if (key.default_value == "zero") {
    table.set(key.name, {Vec3{}, location, "zero"});
  } else if (!key.default_value.empty()) {
    const toml::table parsed = toml::parse("value = " + default_value(key), std::string_view("default"));
    table.set(key.name, read_value(*parsed.get("value"), context));
  }
}

DeckValue Reader::read_value(const toml::node& node, const Context& context) const {
  DeckValue value{false, context.location, shown(node, source_)};
  switch (context.key.type) {
    case ValueType::boolean:
      if (!node.is_boolean()) fail(node, context);
      value.data = node.as_boolean()->get();
      break;
    case ValueType::integer:
      value.data = integer(node, node, context);
      break;
    case ValueType::real:
      value.data = number(node, node, context);
      break;
    case ValueType::text:
    case ValueType::choice:
    case ValueType::name:
    case ValueType::file:
      value.data = text(node, context);
      break;
    case ValueType::vector:
      value.data = vector(node, node, context);
      break;
    case ValueType::reals:
      value.data =
          entries<Real>(node, context, [&](const toml::node& n) { return number(n, node, context); });
      break;
    case ValueType::integers:
      value.data = entries<std::int64_t>(node, context,
                                         [&](const toml::node& n) { return integer(n, node, context); });
      break;
    case ValueType::texts:
      value.data = entries<std::string>(node, context, [&](const toml::node& n) {
        if (!n.is_string()) fail(node, context);
        return n.as_string()->get();
      });
      break;
    case ValueType::vectors:
      value.data =
          entries<Vec3>(node, context, [&](const toml::node& n) { return vector(n, node, context); });
      break;
    case ValueType::quantity:
      value.data = std::vector{read_quantity(node, context)};
      break;
    case ValueType::table:
      if (!node.is_table()) fail(node, context);
      value.data =
          std::vector{read_table(*node.as_table(), *context.key.table, context.path, context.location)};
      break;
    case ValueType::tables:
      value.data = read_tables(node, context);
      break;
  }
  return value;
}

std::vector<DeckTable> Reader::read_tables(const toml::node& node, const Context& context) const {
  std::vector<DeckTable> tables;
  std::set<std::string> names;
  if (node.is_table() && context.key.length == 0)
    fail(node, context, fmt::format("; write [[{}]]", context.path));
  for (const toml::node& entry : list(node, context)) {
    if (!entry.is_table()) fail(node, context);
    const toml::node* name = entry.as_table()->get("name");
    const bool named = name && name->is_string();
    const std::string id = named ? name->as_string()->get() : std::to_string(tables.size());
    const std::string location = location_of(entry.source(), context.location);
    tables.push_back(
        read_table(*entry.as_table(), *context.key.table, join_path(context.path, id), location));
    if (named && !names.insert(id).second) tables.back().fail("name", "repeated; names must be different");
  }
  return tables;
}

DeckTable Reader::read_quantity(const toml::node& node, const Context& context) const {
  const Key& key = context.key;
  if (node.is_table())
    return read_table(*node.as_table(), *key.table, context.path, context.location, key.unit);
  number(node, node, context);
  toml::table constant;
  constant.insert("kind", word_of(TimeFunctionKind::constant));
  constant.insert("value", node);
  return read_table(constant, *key.table, context.path, context.location, key.unit);
}

Real Reader::number(const toml::node& node, const toml::node& whole, const Context& context) const {
  const std::optional<Real> value = node.is_number() ? node.value<Real>() : std::nullopt;
  const Key& key = context.key;
  if (!value) fail(whole, context);
  const bool above_min = key.min_excluded ? *value > key.min : *value >= key.min;
  if (!std::isfinite(*value)) fail(whole, context, ", finite");
  if (!above_min || *value > key.max) fail(whole, context);
  return *value;
}

std::int64_t Reader::integer(const toml::node& node, const toml::node& whole, const Context& context) const {
  if (!node.is_integer()) fail(whole, context, node.is_floating_point() ? ", without a decimal point" : "");
  number(node, whole, context);
  return node.as_integer()->get();
}

std::string Reader::text(const toml::node& node, const Context& context) const {
  if (!node.is_string()) fail(node, context);
  const std::string value = node.as_string()->get();
  const std::vector<std::string>& words = context.key.words;
  if (context.key.type == ValueType::choice && std::find(words.begin(), words.end(), value) == words.end())
    fail(node, context, word_suggestion(value, words));
  if (value.find('\0') != std::string::npos) fail(node, context, " without the character \\u0000");
  if (context.key.type == ValueType::name && !is_name(value)) fail(node, context);
  return context.key.type == ValueType::file ? file(value, node, context) : value;
}

std::string Reader::file(const std::string& value, const toml::node& node, const Context& context) const {
  const std::filesystem::path folder = std::filesystem::absolute(deck_path_).parent_path();
  const std::string path = (folder / value).lexically_normal().string();
  if (const std::string trouble = input_file_error(path); !trouble.empty())
    fail(node, context, fmt::format("; {} {}", path, trouble));
  return path;
}

// In 2D the vector's z is 0.
Vec3 Reader::vector(const toml::node& node, const toml::node& whole, const Context& context) const {
  const toml::array* numbers = node.as_array();
  if (!numbers || numbers->size() != static_cast<std::size_t>(dimension_)) fail(whole, context);
  const auto component = [&](std::size_t i) { return number(*numbers->get(i), whole, context); };
  return {component(0), component(1), dimension_ == 3 ? component(2) : 0};
}

const toml::array& Reader::list(const toml::node& node, const Context& context) const {
  if (!node.is_array()) fail(node, context);
  const toml::array& array = *node.as_array();
  if (context.key.length > 0 && array.size() != context.key.length) fail(node, context);
  return array;
}

template <class T, class ReadEntry>
std::vector<T> Reader::entries(const toml::node& node, const Context& context,
                               const ReadEntry& read_entry) const {
  std::vector<T> values;
  for (const toml::node& entry : list(node, context)) values.push_back(read_entry(entry));
  return values;
}

std::string Reader::allowed(const Context& context) const {
  Key key = context.key;
  if (key.unit.starts_with(kQuantityUnit)) {
    const bool several = context.quantity_unit.find(' ') != std::string::npos && key.unit != kQuantityUnit;
    key.unit = (several ? "(" + context.quantity_unit + ")" : context.quantity_unit) +
               key.unit.substr(kQuantityUnit.size());
  }
  return allowed_values(key, dimension_);
}

void Reader::fail(const toml::node& node, const Context& context, const std::string& detail) const {
  if (context.location.starts_with("--set "))
    throw InputError(
        fmt::format("{}: {} must be {}{}", context.location, context.path, allowed(context), detail));
  throw InputError(fmt::format("{}: {} = {}: must be {}{}", context.location, context.path,
                               shown(node, source_), allowed(context), detail));
}

}  // namespace

DeckTable read_deck(const toml::table& source, const std::string& text, const std::string& path) {
  const auto dimension = source["space"]["dimension"].value<std::int64_t>();
  const int known = dimension && *dimension == 2 ? 2 : 3;
  const SourceText written(text, path);
  return Reader(source, written, path, known).read_table(source, deck_keys(), "", path);
}

std::string join_path(const std::string& table, const std::string& key) {
  return table.empty() ? key : table + "." + key;
}

std::string location_of(const toml::source_region& source, const std::string& otherwise) {
  if (!source.path) return otherwise;
  if (source.path->starts_with("--set ")) return *source.path;
  return fmt::format("{}:{}:{}", *source.path, source.begin.line, source.begin.column);
}

}  // namespace scree
