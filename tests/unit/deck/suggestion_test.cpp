// Suggestions for misspelt names.
#include "deck/suggestion.hpp"

#include <set>
#include <string>
#include <vector>

#include "deck/keys.hpp"
#include "deck/synonyms.hpp"
#include "support/catch.hpp"

namespace scree {

TEST_CASE("a name is suggested that differs by a letter or a quarter of them") {
  const auto meant = [](const std::string& misspelt, const std::string& known) {
    const std::string text = suggestion(misspelt, {known, "something_else"});
    if (text == "; did you mean \"" + known + "\"?") return true;
    CHECK(text == "; known: " + known + ", something_else");
    return false;
  };
  CHECK(meant("stp", "step"));
  CHECK(meant("setp", "step"));  // two neighbours exchanged
  CHECK(meant("resitution", "restitution"));
  CHECK(meant("stifnes", "stiffness"));
  CHECK(meant("GROUND", "ground"));
  CHECK(meant("Ground", "ground"));
  CHECK(meant("p1", "p2"));
  CHECK_FALSE(meant("b", "a"));
  CHECK_FALSE(meant("rod", "bob"));
  CHECK_FALSE(meant("crank", "frame"));
  CHECK_FALSE(meant("direction", "dimension"));
  CHECK_FALSE(meant("", "a"));
}

TEST_CASE("of several names the nearest is suggested, and none where there are none") {
  CHECK(suggestion("joint_sprngs", {"joint_limits", "joint_springs"}) == "; did you mean \"joint_springs\"?");
  CHECK(suggestion("a", {}).empty());
}

TEST_CASE("synonyms of keys are known, by the path where the key is in another table") {
  const std::vector<std::string> pair{"stiffness", "friction", "restitution"};
  CHECK(key_suggestion("mu", pair) == "; did you mean \"friction\"?");
  CHECK(key_suggestion("COR", pair) == "; did you mean \"restitution\"?");
  CHECK(key_suggestion("e", pair) == "; did you mean \"restitution\"?");
  CHECK(key_suggestion("E", {"density", "young_modulus"}) == "; did you mean \"young_modulus\"?");
  CHECK(key_suggestion("mu", {"effort", "friction_coefficient"}) ==
        "; did you mean \"friction_coefficient\"?");
  CHECK(key_suggestion("dt", {"step", "end"}) == "; did you mean \"step\"?");
  CHECK(key_suggestion("dt", {"particles"}) == "; did you mean \"time.step\"?");
  CHECK(key_suggestion("e", {"particles"}) == "; known: particles");
  CHECK(key_suggestion("rh", {"rho", "mass"}) == "; did you mean \"rho\"?");
}

TEST_CASE("synonyms of words of choices are known, and misspelt ones") {
  CHECK(word_suggestion("hinge", {"fixed", "revolute"}) == "; did you mean \"revolute\"?");
  CHECK(word_suggestion("ball", {"sphere", "box"}) == "; did you mean \"sphere\"?");
  CHECK(word_suggestion("ball", {"revolute", "spherical"}) == "; did you mean \"spherical\"?");
  CHECK(word_suggestion("revolut", {"fixed", "revolute"}) == "; did you mean \"revolute\"?");
  CHECK(word_suggestion("mu", {"friction"}).empty());
  CHECK(word_suggestion("other", {"fixed", "revolute"}).empty());
}

namespace {

// Collects the paths of the keys, and the words of choices, of this table and its subtables.
void collect(const TableKeys& keys, const std::string& path, std::set<std::string>& paths,
             std::set<std::string>& words) {
  for (const Key& key : keys.keys) {
    paths.insert(path + key.name);
    words.insert(key.words.begin(), key.words.end());
    if (key.table != nullptr) collect(*key.table, path + key.name + ".", paths, words);
  }
}

}  // namespace

TEST_CASE("every synonym is of a key or a word that is there, and is none itself") {
  std::set<std::string> paths, words;
  collect(deck_keys(), "", paths, words);
  for (const Synonym& each : kKeySynonyms) {
    INFO(each.said);
    CHECK(paths.count(std::string(each.meant)) == 1);
  }
  for (const Synonym& each : kWordSynonyms) {
    INFO(each.said);
    CHECK(words.count(std::string(each.meant)) == 1);
    CHECK(words.count(std::string(each.said)) == 0);
  }
}

}  // namespace scree
