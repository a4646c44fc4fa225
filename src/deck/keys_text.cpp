// The manual of the deck's keys, printed by `scree keys`.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "deck/keys.hpp"
#include "deck/wrapped.hpp"

namespace scree {

namespace {

constexpr std::size_t kWidth = 110;

// The text of input/limits.md, in lines of kWidth; tests/cli/test_words.py compares them.
constexpr const char* kModelLimits = R"(The model has these limits today.

Particles are discs (2D) or spheres (3D); there are no polygons. Particles are not bonded and do not break.

Friction and rolling and twisting resistance act between particles, bodies and walls. JKR contacts, plastic
contacts, liquid bridges and an attraction with a range beyond touch are available in explicit steps
(velocity-verlet) only. Adhesion acts on particles and on the discs and spheres on bodies; a body's mesh does
not adhere to planes. Liquid bridges have a constant volume each and exist between spheres and surfaces in 3D.

Particles, and the discs and spheres on bodies, touch each other, planes and meshes. A mesh of a body touches
planes with the corners of its convex hull. Meshes do not touch each other.

Bodies are rigid. Planar bodies move along x and y and rotate about z, also in 3D; forces along z have no
effect on them. Bodies with `kind = "spatial"` move freely in space, with spherical, universal and all other
common joints (`input/README.md`). Joints have motors, servos, springs, stops and dry friction, but no
clearance. Cylinders have no mass.

There is no fluid but liquid bridges, and no heat transfer.
)";

void describe_key(std::string& out, const Key& key, const std::string& selector) {
  out += "  " + key.name + "\n";
  out += wrapped(key_facts(key, selector), kWidth, 6);
  out += wrapped(key.sentence, kWidth, 6);
}

void describe_table(std::string& out, const TableKeys& table, const std::string& header) {
  out += header + "\n";
  if (!table.sentence.empty()) out += wrapped(table.sentence, kWidth, 2);
  for (const Key& key : table.keys) {
    if (key.type != ValueType::table && key.type != ValueType::tables) describe_key(out, key, table.selector);
  }
  out += "\n";
}

void describe_below(std::string& out, const TableKeys& table, const std::string& path) {
  for (const Key& key : table.keys) {
    const bool single = key.type == ValueType::table;
    if (!single && key.type != ValueType::tables) continue;
    const std::string name = path.empty() ? key.name : path + "." + key.name;
    const std::string header = single ? "[" + name + "]" : "[[" + name + "]]";
    describe_table(out, *key.table, header + (key.is_required ? "  (required)" : ""));
    describe_below(out, *key.table, name);
  }
}

// The names of all keys below `table` that take such a quantity, each once.
void add_names(const TableKeys& table, const TableKeys& quantity, std::vector<std::string>& names) {
  for (const Key& key : table.keys) {
    if (key.type == ValueType::table || key.type == ValueType::tables) add_names(*key.table, quantity, names);
    const bool is_one = key.type == ValueType::quantity && key.table == &quantity;
    if (is_one && std::find(names.begin(), names.end(), key.name) == names.end()) names.push_back(key.name);
  }
}

std::string header_of(const std::string& name, const TableKeys& quantity) {
  std::vector<std::string> names;
  add_names(deck_keys(), quantity, names);
  const std::string keys = wrapped(fmt::format("Of the keys {}.", fmt::join(names, ", ")), kWidth, 2);
  return name + "\n" + keys.substr(0, keys.size() - 1);
}

}  // namespace

std::string default_text(const Key& key) {
  if (key.is_required) return "required";
  if (key.default_value.empty()) return "left out: " + key.default_note;
  const std::string text = "default " + key.default_value;
  if (key.where_key.empty()) return text;
  return fmt::format("{}, with {} = \"{}\" {}", text, key.where_key, key.where_value, key.default_there);
}

std::string kinds_text(const Key& key, const std::string& selector) {
  const auto with = [&](const char* what, const std::vector<std::string>& kinds) {
    return fmt::format("{} with {} = \"{}\"", what, selector, fmt::join(kinds, "\", \""));
  };
  std::string text;
  if (!key.kinds.empty()) text = with("only", key.kinds);
  if (!key.required_kinds.empty()) text += (text.empty() ? "" : "; ") + with("required", key.required_kinds);
  return text;
}

std::string former_text(const Key& key) {
  std::string text;
  const auto add = [&](const std::string& more) { text += (text.empty() ? "formerly " : ", ") + more; };
  for (const FormerName& former : key.former_names)
    add(former.text + (former.sense == FormerSense::negated ? ", with the opposite value" : ""));
  for (const FormerWord& former : key.former_words)
    add(fmt::format("\"{}\" for \"{}\"", former.text, former.now));
  return text;
}

std::string key_facts(const Key& key, const std::string& selector) {
  std::string facts = allowed_values(key, 0) + "; " + default_text(key);
  for (const std::string& more : {kinds_text(key, selector), former_text(key)})
    if (!more.empty()) facts += "; " + more;
  return facts;
}

std::string keys_text() {
  std::string out;
  out += wrapped(
      "Keys of a deck, by table. [name] is a table; [[name]] is an element of a list and may stand any "
      "number of "
      "times. Each key: what it takes [unit]; default; meaning. SI units; angles in radians.",
      kWidth);
  out += "\n";
  out += kModelLimits;
  out += "\n";
  describe_table(out, deck_keys(), "(top of the deck)");
  describe_below(out, deck_keys(), "");
  describe_table(out, time_function_keys(), header_of("time function", time_function_keys()));
  describe_table(out, distribution_keys(), header_of("distribution", distribution_keys()));
  return out;
}

}  // namespace scree
