// The deck: checked values of one input file, and the place of each value in it.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "deck/keys.hpp"

namespace scree {

class DeckTable;

// One value with its source. A table is stored as a vector of one element, a list of tables as a vector of
// any length.
struct DeckValue {
  std::variant<bool, std::int64_t, Real, std::string, Vec3, std::vector<Real>, std::vector<std::int64_t>,
               std::vector<std::string>, std::vector<Vec3>, std::vector<DeckTable>>
      data;
  std::string location;     // "deck.toml:12:8", or "--set key=value"
  std::string shown;        // the value as TOML text, shortened, for messages
  bool is_given = false;    // by the deck or by --set; otherwise a default, or chosen by the program
  std::string reason = {};  // why the program chose the value
};

// A value that the program chooses because the deck does not give it.
struct ChosenValue {
  std::string table, key;  // "time", "step"
  std::variant<Real, std::string> value;
  std::string reason;  // of the choice, for the user; empty where it follows from another choice

  // "time.step = 1.2e-05"
  std::string text() const;
};

// A table of the deck after its keys were checked against their declarations. The accessors throw
// std::logic_error where the key is not declared with that type.
class DeckTable {
 public:
  // path: "bodies.net", empty for the whole deck. location: as in DeckValue.
  DeckTable(const TableKeys& keys, std::string path, std::string location)
      : keys_(&keys), path_(std::move(path)), location_(std::move(location)) {}

  // Whether the key was given or has a default value.
  bool has(const std::string& key) const { return values_.count(key) > 0; }
  // Whether the deck or --set gives the key.
  bool gives(const std::string& key) const { return has(key) && value(key).is_given; }
  // Whether the word of a choice is "auto", for which choice() has no value.
  bool is_automatic(const std::string& key) const { return text(key) == kAutomatic; }
  bool boolean(const std::string& key) const { return get<bool>(key); }
  std::int64_t integer(const std::string& key) const { return get<std::int64_t>(key); }
  Real real(const std::string& key) const { return get<Real>(key); }
  const std::string& text(const std::string& key) const { return get<std::string>(key); }
  // The enum value of the key's word. Value: the enum with which the key was declared.
  template <class Value>
  Value choice(const std::string& key) const {
    return value_of<Value>(word(key, typeid(Value)));
  }
  Vec3 vector(const std::string& key) const { return get<Vec3>(key); }
  const std::vector<Real>& reals(const std::string& key) const { return get<std::vector<Real>>(key); }
  const std::vector<std::int64_t>& integers(const std::string& key) const {
    return get<std::vector<std::int64_t>>(key);
  }
  const std::vector<std::string>& texts(const std::string& key) const {
    return get<std::vector<std::string>>(key);
  }
  const std::vector<Vec3>& vectors(const std::string& key) const { return get<std::vector<Vec3>>(key); }
  // table: a table or a quantity. tables: a list of tables, empty where the deck has none.
  const DeckTable& table(const std::string& key) const { return get<std::vector<DeckTable>>(key).front(); }
  const std::vector<DeckTable>& tables(const std::string& key) const {
    return get<std::vector<DeckTable>>(key);
  }

  // path: "bodies.net". label: with the location in front, "deck.toml:12:1: bodies.net".
  const std::string& path() const { return path_; }
  const std::string& location() const { return location_; }
  std::string label() const { return location_ + ": " + path_; }
  // Place and value of a key for messages: "deck.toml:12:8: path.key = value", without the value where the
  // key has none.
  std::string place(const std::string& key) const;
  // Throws InputError "place(key): problem".
  [[noreturn]] void fail(const std::string& key, const std::string& problem) const;

  const TableKeys& keys() const { return *keys_; }
  const std::map<std::string, DeckValue>& values() const { return values_; }
  void set(const std::string& key, DeckValue value) { values_.insert_or_assign(key, std::move(value)); }
  // Stores a value that the program chose, of a key of this table or of a table in it. Where the key is the
  // table's selector, the values of keys that do not exist for the chosen word are removed.
  void take(const ChosenValue& chosen);

 private:
  const DeckValue& value(const std::string& key) const;
  const std::string& word(const std::string& key, const std::type_info& choice_of) const;
  template <class T>
  const T& get(const std::string& key) const {
    return std::get<T>(value(key).data);
  }

  const TableKeys* keys_;
  std::string path_, location_;
  std::map<std::string, DeckValue> values_;
};

struct Deck {
  std::string path;
  DeckTable root;
  std::vector<std::string> former_names = {};  // a line for each that the deck has (deck/former_names.hpp)

  // The deck as TOML, with all defaults and overrides; it loads to the same deck.
  std::string resolved_text() const;
  // The values, as TOML, that must be equal in a restarted run: all but title, time.end, output.*, stop
  // and parallel.*. Files are represented by hashes of their contents. Throws IoError where a file cannot be
  // read.
  std::string fingerprint() const;
};

// Reads and checks a deck. overrides: "key.path=value" in TOML's syntax; a value that is not TOML is taken as
// a text. Elements of a list of tables are addressed by name or number: particles.block.count=5,
// bodies.0.mass=2. Throws InputError with file, line, column, key, value and the allowed values, and IoError
// where the file cannot be read.
Deck load_deck(const std::string& path, const std::vector<std::string>& overrides);
// Reads and checks the text of a deck. path: for messages, and for the folder of the files that the deck
// names.
Deck parse_deck(const std::string& text, const std::string& path, const std::vector<std::string>& overrides);

}  // namespace scree
