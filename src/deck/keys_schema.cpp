// The keys as a JSON schema, printed by `scree keys --schema`, with which editors complete and check decks.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "deck/keys.hpp"

namespace scree {

namespace {

using Schema = toml::table;

constexpr const char* kTimeFunction = "time_function";
constexpr const char* kDistribution = "distribution";

Schema schema_of(const TableKeys& table);

bool is_of(const std::vector<std::string>& kinds, const std::string& word) {
  return std::find(kinds.begin(), kinds.end(), word) != kinds.end();
}

toml::array array_of(const std::vector<std::string>& texts) {
  toml::array array;
  for (const std::string& text : texts) array.push_back(text);
  return array;
}

// The schema cannot name a vector of zeros, whose length is the dimension of the domain.
bool has_default(const Key& key) { return !key.default_value.empty() && key.default_value != "zero"; }

void insert_limit(Schema& schema, const char* name, Real limit, bool integral) {
  if (!std::isfinite(limit)) return;
  if (integral)
    schema.insert_or_assign(name, static_cast<std::int64_t>(limit));
  else
    schema.insert_or_assign(name, limit);
}

Schema number(const Key& key, bool integral = false) {
  Schema schema{{"type", integral ? "integer" : "number"}};
  insert_limit(schema, key.min_excluded ? "exclusiveMinimum" : "minimum", key.min, integral);
  insert_limit(schema, "maximum", key.max, integral);
  return schema;
}

Schema list(const Schema& entries, std::size_t fewest, std::size_t most) {
  Schema schema{{"type", "array"}, {"items", entries}};
  if (fewest > 0) schema.insert("minItems", static_cast<std::int64_t>(fewest));
  if (most > 0) schema.insert("maxItems", static_cast<std::int64_t>(most));
  return schema;
}

Schema list(const Schema& entries, const Key& key) { return list(entries, key.length, key.length); }

Schema vector(const Key& key) { return list(number(key), 2, 3); }

// JSON counts characters, the reader bytes: the schema may accept a longer name than the reader, not a
// shorter.
Schema name() {
  return Schema{{"type", "string"},
                {"minLength", 1},
                {"maxLength", static_cast<std::int64_t>(kLongestName)},
                {"pattern", "^[^/\\u0000-\\u001f\\u007f]*$"},
                {"not", Schema{{"enum", toml::array{".", ".."}}}}};
}

// A number is short for the table's `value`, and has its range.
Schema quantity(const Key& key) {
  const auto value = std::ranges::find(key.table->keys, "value", &Key::name);
  const char* const table = key.table == &distribution_keys() ? kDistribution : kTimeFunction;
  return Schema{{"anyOf", toml::array{number(*value), Schema{{"$ref", fmt::format("#/$defs/{}", table)}}}}};
}

Schema words_of(const Key& key) {
  const Schema words{{"enum", array_of(key.words)}};
  if (key.former_words.empty()) return words;
  toml::array either{words};
  for (const FormerWord& former : key.former_words)
    either.push_back(Schema{{"const", former.text}, {"deprecated", true}});
  return Schema{{"anyOf", either}};
}

Schema values_of(const Key& key) {
  switch (key.type) {
    case ValueType::boolean:
      return Schema{{"type", "boolean"}};
    case ValueType::integer:
      return number(key, true);
    case ValueType::real:
      return number(key);
    case ValueType::text:
    case ValueType::file:
      return Schema{{"type", "string"}};
    case ValueType::choice:
      return words_of(key);
    case ValueType::name:
      return name();
    case ValueType::vector:
      return vector(key);
    case ValueType::reals:
      return list(number(key), key);
    case ValueType::integers:
      return list(number(key, true), key);
    case ValueType::texts:
      return list(Schema{{"type", "string"}}, key);
    case ValueType::vectors:
      return list(vector(key), key);
    case ValueType::quantity:
      return quantity(key);
    case ValueType::table:
      return schema_of(*key.table);
    case ValueType::tables:
      return list(schema_of(*key.table), 0, 0);
  }
  return {};
}

std::string description(const Key& key, const std::string& selector) {
  if (key.type == ValueType::table || key.type == ValueType::tables) return key.table->sentence;
  return fmt::format("{}\n\n{}.", key.sentence, key_facts(key, selector));
}

Schema schema_of(const Key& key, const std::string& selector) {
  Schema schema = values_of(key);
  if (const std::string text = description(key, selector); !text.empty()) schema.insert("description", text);
  if (has_default(key) && key.where_key.empty()) {
    const toml::table parsed = toml::parse("value = " + key.default_value, std::string_view("default"));
    schema.insert("default", *parsed.get("value"));
  }
  return schema;
}

// The key under a name that it had in earlier versions.
Schema schema_of(const Key& key, const FormerName& former) {
  const char* const note = former.sense == FormerSense::negated ? ", which has the opposite value" : "";
  Schema schema = values_of(key);
  schema.insert("deprecated", true);
  schema.insert("description",
                fmt::format("Former name of {}{}.\n\n{}.", key.name, note, allowed_values(key, 0)));
  return schema;
}

// What holds where the selector has the text, which is this word or a former one of it: which keys must be
// given, and which ones do not exist. A key with a former name is not required: either name will do.
Schema rule_of(const TableKeys& table, const Key& selector, const std::string& word,
               const std::string& text) {
  Schema absent;
  toml::array required;
  for (const Key& key : table.keys) {
    const bool exists = key.kinds.empty() || is_of(key.kinds, word);
    if (!exists) {
      absent.insert(key.name, false);
      for (const FormerName& former : key.former_names) absent.insert(former.text, false);
    }
    if (exists && key.former_names.empty() &&
        ((key.is_required && !key.kinds.empty()) || is_of(key.required_kinds, word)))
      required.push_back(key.name);
  }
  Schema then;
  if (!absent.empty()) then.insert("properties", absent);
  if (!required.empty()) then.insert("required", required);
  if (then.empty()) return {};
  Schema condition{{"properties", Schema{{selector.name, Schema{{"const", text}}}}}};
  // Without `required` the condition holds where the selector is left out, too.
  if (selector.where_key.empty() && selector.default_value == fmt::format("\"{}\"", text))
    return Schema{{"if", condition}, {"then", then}};
  condition.insert("required", toml::array{selector.name});
  return Schema{{"if", condition}, {"then", then}};
}

Schema schema_of(const TableKeys& table) {
  Schema properties;
  toml::array required, rules;
  for (const Key& key : table.keys) {
    properties.insert(key.name, schema_of(key, table.selector));
    for (const FormerName& former : key.former_names) properties.insert(former.text, schema_of(key, former));
    if (key.is_required && key.kinds.empty() && key.former_names.empty()) required.push_back(key.name);
    if (key.name != table.selector) continue;
    const auto add_rule = [&](const std::string& word, const std::string& text) {
      if (const Schema rule = rule_of(table, key, word, text); !rule.empty()) rules.push_back(rule);
    };
    for (const std::string& word : key.words) add_rule(word, word);
    for (const FormerWord& former : key.former_words) add_rule(former.now, former.text);
  }
  Schema schema{{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
  if (!required.empty()) schema.insert("required", required);
  if (!rules.empty()) schema.insert("allOf", rules);
  return schema;
}

}  // namespace

std::string keys_schema() {
  Schema schema = schema_of(deck_keys());
  schema.insert("$schema", "https://json-schema.org/draft/2020-12/schema");
  schema.insert("title", "Deck of Scree");
  schema.insert("description", "Made by `scree keys --schema`. SI units; angles in radians.");
  schema.insert("$defs", Schema{{kTimeFunction, schema_of(time_function_keys())},
                                {kDistribution, schema_of(distribution_keys())}});
  std::ostringstream text;
  text << toml::json_formatter{schema} << '\n';
  return text.str();
}

}  // namespace scree
