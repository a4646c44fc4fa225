// Names of keys and words of choices from earlier versions: read as their present forms, and reported.
#pragma once

#include <toml++/toml.h>

#include <string>
#include <vector>

#include "deck/keys.hpp"
#include "deck/source_text.hpp"

namespace scree {

// Puts the present names and words into the TOML tree of a deck before it is checked. The declarations of the
// keys have the former ones (Key::formerly, kFormerWords).
class FormerNames {
 public:
  // source: the deck's text, for messages; path: of the deck, which names values that no text stands for.
  FormerNames(const SourceText& source, std::string path) : source_(source), path_(std::move(path)) {}

  // Throws InputError where one table has both names of a key. A former name that --set has added replaces
  // the value under the present name: an override prevails under either name.
  void replace(toml::table& deck);

  // For the log, one for each former name or word that was replaced, with its first place:
  //   deck.toml:27:1: contact.pairs.0.tension = true is now limit_damping = false; so are 2 more
  std::vector<std::string> lines() const;

 private:
  struct Use {
    std::string pattern;  // with * for the elements of lists: equal for all uses of one name
    std::string line;     // of the first use
    int more = 0;
  };
  // What a table is called: the elements of lists by name or number, or all by *.
  struct Paths {
    std::string path, pattern;
    Paths below(const std::string& name, const std::string& in_pattern) const;
  };

  void replace(toml::table& table, const TableKeys& keys, const Paths& paths);
  void replace_name(toml::table& table, const Key& key, const FormerName& former, const Paths& paths);
  void replace_word(toml::node& node, const Key& key, const Paths& paths);
  void add(const std::string& location, const Paths& former, const std::string& value,
           const std::string& present);

  SourceText source_;
  std::string path_;
  std::vector<Use> uses_;
};

}  // namespace scree
