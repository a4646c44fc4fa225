#include "deck/keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "deck/choices.hpp"

namespace scree {

Key& Key::formerly(const std::string& former, FormerSense sense) {
  former_names.push_back({former, sense});
  return *this;
}

Key& Key::above(Real limit) {
  min = limit;
  min_excluded = true;
  return *this;
}

Key& Key::at_least(Real limit) {
  min = limit;
  return *this;
}

Key& Key::within(Real low, Real high) {
  min = low;
  max = high;
  return *this;
}

Key& Key::entries(std::size_t count) {
  length = count;
  return *this;
}

Key& Key::required() {
  is_required = true;
  return *this;
}

Key& Key::otherwise(const std::string& toml_text) {
  default_value = toml_text;
  return *this;
}

Key& Key::otherwise_automatic() {
  words.insert(words.begin(), kAutomatic);
  return otherwise('"' + kAutomatic + '"');
}

Key& Key::left_out(const std::string& meaning) {
  default_note = meaning;
  return *this;
}

Key& Key::combined(Combining how) {
  combining = how;
  return *this;
}

Key& Key::about(const std::string& text) {
  sentence = text;
  return *this;
}

namespace {

Key make_key(const std::string& name, ValueType type, const std::string& unit = "",
             const TableKeys* table = nullptr) {
  Key key;
  key.name = name;
  key.type = type;
  key.unit = unit;
  key.table = table;
  return key;
}

std::string range_text(const Key& key) {
  if (std::isfinite(key.min) && std::isfinite(key.max))
    return key.min_excluded ? fmt::format(" above {} and at most {}", key.min, key.max)
                            : fmt::format(" from {} to {}", key.min, key.max);
  if (std::isfinite(key.min))
    return fmt::format("{}{}", key.min_excluded ? " above " : " of at least ", key.min);
  if (std::isfinite(key.max)) return fmt::format(" of at most {}", key.max);
  return "";
}

std::string list_text(const Key& key, const std::string& entries) {
  const std::string count = key.length > 0 ? fmt::format("{} ", key.length) : "";
  return fmt::format("a list of {}{}{}", count, entries, range_text(key));
}

}  // namespace

Key boolean(const std::string& name) { return make_key(name, ValueType::boolean); }
Key integer(const std::string& name) { return make_key(name, ValueType::integer); }
Key real(const std::string& name, const std::string& unit) { return make_key(name, ValueType::real, unit); }
Key text(const std::string& name) { return make_key(name, ValueType::text); }
Key choice_of_words(const std::string& name, std::vector<std::string> words,
                    const std::type_info& choice_of) {
  Key key = make_key(name, ValueType::choice);
  key.words = std::move(words);
  key.choice_of = &choice_of;
  return key;
}
Key coordinate_key() {
  return choice<JointCoordinate>("coordinate")
      .left_out("the joint's only coordinate; for a screw the angle")
      .about(
          "Which coordinate of the joint: revolute joints have an angle, translational joints a "
          "displacement, cylindrical joints and screws both, distance joints a length. Universal joints have "
          "angle_1, the rotation of the cross relative to the first body about that body's arm, and angle_2, "
          "the rotation of the second body relative to the cross about the second body's arm.");
}
Key name_key() { return make_key("name", ValueType::name); }
Key file(const std::string& name) { return make_key(name, ValueType::file); }
Key vector(const std::string& name, const std::string& unit) {
  return make_key(name, ValueType::vector, unit);
}
Key reals(const std::string& name, const std::string& unit) { return make_key(name, ValueType::reals, unit); }
Key integers(const std::string& name) { return make_key(name, ValueType::integers); }
Key texts(const std::string& name) { return make_key(name, ValueType::texts); }
Key vectors(const std::string& name, const std::string& unit) {
  return make_key(name, ValueType::vectors, unit);
}
Key quantity(const std::string& name, const std::string& unit, const TableKeys& keys) {
  return make_key(name, ValueType::quantity, unit, &keys);
}
Key table(const std::string& name, const TableKeys& keys) {
  return make_key(name, ValueType::table, "", &keys);
}
Key tables(const std::string& name, const TableKeys& keys) {
  return make_key(name, ValueType::tables, "", &keys);
}

std::string allowed_values(const Key& key, int dimension) {
  const std::string numbers = dimension > 0 ? fmt::format("{} numbers", dimension) : "2 or 3 numbers";
  const std::string unit = key.unit.empty() ? "" : fmt::format(" [{}]", key.unit);
  switch (key.type) {
    case ValueType::boolean:
      return "true or false";
    case ValueType::integer:
      return "an integer" + range_text(key);
    case ValueType::real:
      return "a number" + range_text(key) + unit;
    case ValueType::text:
      return "a text";
    case ValueType::choice:
      return fmt::format("one of \"{}\"", fmt::join(key.words, "\", \""));
    case ValueType::name:
      return fmt::format(
          "a name of 1 to {} bytes, without \"/\" and control characters, and not \".\" or \"..\"",
          kLongestName);
    case ValueType::file:
      return "the path of a file, relative to the deck's folder";
    case ValueType::vector:
      return fmt::format("{}{} in brackets", numbers, unit);
    case ValueType::reals:
      return list_text(key, "numbers") + unit;
    case ValueType::integers:
      return list_text(key, "integers");
    case ValueType::texts:
      return list_text(key, "texts");
    case ValueType::vectors:
      return list_text(key, fmt::format("points of {}", numbers)) + unit;
    case ValueType::quantity:
      return fmt::format("a number{} or a table with a kind", unit);
    case ValueType::table:
      return "a table";
    case ValueType::tables:
      return "a list of tables";
  }
  return "";
}

}  // namespace scree
