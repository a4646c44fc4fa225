// Declarations of the deck's keys, from which the reader, the manual (`scree keys`) and the schema work.
#pragma once

#include <initializer_list>
#include <string>
#include <typeinfo>
#include <vector>

#include "base/types.hpp"
#include "deck/choice.hpp"

namespace scree {

enum class ValueType {
  boolean,
  integer,
  real,
  text,
  choice,    // one of the words of an enum (deck/choices.hpp)
  name,      // text to which other keys refer, and which names results
  file,      // path, relative to the deck's folder
  vector,    // as many numbers as space.dimension
  reals,     // list of numbers
  integers,  // list of integers
  texts,     // list of texts
  vectors,   // list of vectors
  quantity,  // a number, or a table with its own keys; x is short for { kind = "constant", value = x }
  table,     // [name]
  tables     // [[name]], any number of them
};

struct TableKeys;

// How the value of a former key becomes that of the present one.
enum class FormerSense {
  same,
  negated  // a boolean that says the opposite
};

// The name of a key in earlier versions, which is still read.
struct FormerName {
  std::string text;
  FormerSense sense = FormerSense::same;
};

// How the value of a key of [[contact.pairs]] follows from the pairs of two materials with themselves, where
// contact.mixing makes their pair.
enum class Combining {
  none,    // no key of a pair of materials
  same,    // it must be the same
  mean,    // by the rule of contact.mixing
  series,  // springs in series
  other    // by a function of its own (model/builder/mixing.cpp)
};

constexpr std::size_t kLongestName = 200;  // [B]
// The word of a choice that leaves the decision to the program.
inline const std::string kAutomatic = "auto";
// The unit of a key in a quantity's table: that of the quantity.
inline const std::string kQuantityUnit = "the quantity's unit";

// One key. The functions below begin a declaration, the members complete it:
//   real("step", "s").above(0).required().about("Step size.")
struct Key {
  std::string name;
  std::vector<FormerName> former_names;
  ValueType type = ValueType::real;
  std::string unit;  // empty: dimensionless or not a number
  Real min = -kInfinity, max = kInfinity;
  bool min_excluded = false;
  std::size_t length = 0;                     // number of entries of a list; 0: any
  std::vector<std::string> words;             // of a choice
  std::vector<FormerWord> former_words;       // likewise, still read
  const std::type_info* choice_of = nullptr;  // its enum
  bool is_required = false;
  std::string default_value;  // TOML text, "zero" for a vector of zeros; empty: none
  std::string default_note;   // the behaviour where the key is left out and default_value is empty
  // default_there is the default value where the deck gives the text `where_value` for the key `where_key`.
  std::string where_key, where_value, default_there;
  std::vector<std::string> kinds;  // values of the table's selector for which the key exists; empty: all
  std::vector<std::string> required_kinds;  // those for which the key is required; is_required: for all
  std::string sentence;
  const TableKeys* table = nullptr;  // keys of a table, of tables, or of a quantity
  Combining combining = Combining::none;

  Key& formerly(const std::string& former, FormerSense sense = FormerSense::same);
  Key& above(Real limit);     // numbers > limit
  Key& at_least(Real limit);  // numbers >= limit
  Key& within(Real low, Real high);
  Key& entries(std::size_t count);
  Key& required();
  // Required for these words of the table's selector, a choice.
  template <class Value>
  Key& required_for(std::initializer_list<Value> selector_values) {
    for (const Value value : selector_values) required_kinds.push_back(word_of(value));
    return *this;
  }
  Key& otherwise(const std::string& toml_text);
  template <class Value>
  Key& otherwise_choice(Value value) {
    return otherwise('"' + word_of(value) + '"');
  }
  // Adds the word kAutomatic to the choice, as its default.
  Key& otherwise_automatic();
  // The default is `there` where the deck gives the choice `value` for the key at the path.
  template <class Where, class Value>
  Key& otherwise_where(const std::string& key_path, Where value, Value there) {
    where_key = key_path, where_value = word_of(value), default_there = '"' + word_of(there) + '"';
    return *this;
  }
  Key& left_out(const std::string& meaning);
  template <class Value>
  Key& only_for(std::initializer_list<Value> selector_values) {
    for (const Value value : selector_values) kinds.push_back(word_of(value));
    return *this;
  }
  Key& combined(Combining how);
  Key& about(const std::string& text);
};

struct TableKeys {
  std::string sentence;
  std::vector<Key> keys;
  std::string selector;  // key whose value decides which of the other keys exist; empty: none
};

Key boolean(const std::string& name);
Key integer(const std::string& name);
Key real(const std::string& name, const std::string& unit);
Key text(const std::string& name);
Key choice_of_words(const std::string& name, std::vector<std::string> words, const std::type_info& choice_of);
// A key that accepts the words of an enum; DeckTable::choice reads it.
template <class Value>
Key choice(const std::string& name) {
  Key key = choice_of_words(name, words_of<Value>(), typeid(Value));
  key.former_words = former_words_of<Value>();
  return key;
}
Key name_key();        // "name"
Key coordinate_key();  // "coordinate", of a joint
// Keys of an element that connects two bodies: its name, the bodies, and its own keys.
TableKeys with_connection(const std::string& sentence, std::vector<Key> own,
                          const std::string& selector = "");
Key local_points_key();  // "local_points", one on either body
Key file(const std::string& name);
Key vector(const std::string& name, const std::string& unit);
Key reals(const std::string& name, const std::string& unit);
Key integers(const std::string& name);
Key texts(const std::string& name);
Key vectors(const std::string& name, const std::string& unit);
Key quantity(const std::string& name, const std::string& unit, const TableKeys& keys);
Key table(const std::string& name, const TableKeys& keys);
Key tables(const std::string& name, const TableKeys& keys);

// Keys of an orientation: quaternion, or rotation_axis and rotation_angle, or z_axis with or without x_axis,
// each after `prefix`; read by read_orientation (model/derived/frames.hpp). what: "the body's frame"; outer:
// the frame relative to which it is oriented.
std::vector<Key> orientation_keys(const std::string& prefix, const std::string& what,
                                  const std::string& outer);

// The whole deck, and its parts by subject.
const TableKeys& deck_keys();
const TableKeys& space_keys();
const TableKeys& time_keys();
const TableKeys& integrator_keys();
const TableKeys& contact_keys();
const TableKeys& material_keys();
const TableKeys& mesh_keys();
const TableKeys& wall_keys();
const TableKeys& wall_motion_keys();
const TableKeys& output_keys();
const TableKeys& history_region_keys();
const TableKeys& stop_keys();
const TableKeys& parallel_keys();
const TableKeys& body_keys();
const TableKeys& solid_keys();
const TableKeys& marker_keys();
const TableKeys& joint_keys();
const TableKeys& driver_keys();
const TableKeys& cylinder_keys();
const TableKeys& spring_damper_keys();
const TableKeys& torsional_spring_damper_keys();
const TableKeys& bushing_keys();
const TableKeys& applied_force_keys();
const TableKeys& motor_keys();
const TableKeys& joint_spring_keys();
const TableKeys& joint_limit_keys();
const TableKeys& joint_friction_keys();
const TableKeys& coupler_keys();
const TableKeys& particle_keys();
const TableKeys& inserter_keys();
const TableKeys& outlet_keys();
const TableKeys& time_function_keys();
const TableKeys& distribution_keys();
// Keys of one component of a mixture of particles, and those of a table that may have a mixture: the list
// "mixture", how its shares are kept, and the keys of a component without a share, for a table whose
// particles are of one kind. read_mixture() (model/builder/read_mixture.hpp) reads both forms.
const TableKeys& mixture_keys();
std::vector<Key> mixture_list_keys();

// The values that a key accepts, for messages and the manual: "a number above 0 [s]". dimension: of the
// domain, or 0 where it is not known.
std::string allowed_values(const Key& key, int dimension);
// The behaviour where the key is left out: "required", "default 1e-3", "left out: none".
std::string default_text(const Key& key);
// The words of the table's selector for which the key exists or is required; empty where that holds for all.
std::string kinds_text(const Key& key, const std::string& selector);
// Former names and words: "formerly tension, with the opposite value"; empty without any.
std::string former_text(const Key& key);
// These four texts as one line.
std::string key_facts(const Key& key, const std::string& selector);

// The manual: for a terminal, 110 columns wide; as a page in Markdown; as a JSON schema (draft 2020-12). The
// schema accepts every deck that the reader accepts. It rejects the values that the reader rejects for a
// single key, except for 1.0 in place of an integer and for numbers that are not finite.
std::string keys_text();
std::string keys_markdown();
std::string keys_schema();

}  // namespace scree
