// Names of keys and words of choices from earlier versions.
#include "deck/former_names.hpp"

#include <algorithm>
#include <functional>

#include "deck/differences.hpp"
#include "deck/keys_search.hpp"
#include "support/catch.hpp"
#include "support/decks.hpp"

namespace scree {

namespace {

using Lines = std::vector<std::string>;

const std::string kPairs = kSmallDeck + R"([[contact.pairs]]
stiffness = 1e5
)";
const int kPairsLine = 12;  // of what follows kPairs

Deck loaded(const std::string& text, const Lines& overrides = {}) {
  return parse_deck(text, "deck.toml", overrides);
}

bool limits_damping(const Deck& deck) {
  return deck.root.table("contact").tables("pairs")[0].boolean("limit_damping");
}

std::string at(int line) { return "deck.toml:" + std::to_string(line) + ":1: "; }

}  // namespace

TEST_CASE("a former name is read as the present one, with the opposite value where the sense has changed") {
  const Deck yes = loaded(kPairs + "tension = true\n"), no = loaded(kPairs + "tension = false\n");
  CHECK((!limits_damping(yes) && limits_damping(no) && limits_damping(loaded(kPairs))));
  CHECK(yes.former_names ==
        Lines{at(kPairsLine) + "contact.pairs.0.tension = true is now limit_damping = false"});
  CHECK(yes.resolved_text() == loaded(kPairs + "limit_damping = false\n").resolved_text());
  CHECK(no.fingerprint() == loaded(kPairs).fingerprint());
  CHECK(loaded(kPairs + "limit_damping = false\n").former_names.empty());
}

TEST_CASE("a former word of a choice is read as the present one") {
  const Deck deck = loaded(kSmallDeck + "[integrator]\nredundant = \"share\"\n");
  CHECK(deck.root.table("integrator").text("redundant") == "minimum-norm");
  CHECK(deck.former_names ==
        Lines{"deck.toml:11:13: integrator.redundant = \"share\" is now \"minimum-norm\""});
  const Deck lines =
      loaded(kSmallDeck +
             "[[motors]]\nname = \"m\"\njoint = \"j\"\ntype = \"line\"\nstall_effort = 2.0\n"
             "free_rate = 1.0\n[[meshes]]\nname = \"l\"\nkind = \"line\"\npoints = [[0.0, 0.0], "
             "[1.0, 0.0]]\n");
  CHECK(lines.root.tables("motors")[0].text("type") == "torque-speed");
  CHECK(lines.root.tables("meshes")[0].text("kind") == "line");  // of another choice
  CHECK(lines.former_names.size() == 1);
}

TEST_CASE("uses of one former name are counted in one line") {
  const std::string pair = "tension = true\n[[contact.pairs]]\nstiffness = 1.0\n";
  const std::string first = at(kPairsLine) + "contact.pairs.0.tension = true is now limit_damping = false";
  CHECK(loaded(kPairs + pair + "tension = true\n").former_names == Lines{first + "; so is 1 more"});
  CHECK(loaded(kPairs + pair + pair + "tension = false\n").former_names == Lines{first + "; so are 2 more"});
}

TEST_CASE("both names of a key are refused, with the place of either") {
  const std::string refusal = "contact.pairs.0.tension = true: is the former name of limit_damping, which ";
  CHECK(deck_error(kPairs + "tension = true\nlimit_damping = false\n") ==
        at(kPairsLine) + refusal + "deck.toml:13:17 gives, too");
  CHECK(deck_error(kPairs + "limit_damping = false\ntension = true\n") ==
        at(kPairsLine + 1) + refusal + "deck.toml:12:17 gives, too");
  CHECK(contains(deck_error(kPairs, {"contact.pairs=[{stiffness=1.0,tension=true,limit_damping=false}]"}),
                 refusal));
}

TEST_CASE("--set prevails under either name") {
  const std::string old_no = "contact.pairs.0.tension=false", old_yes = "contact.pairs.0.tension=true";
  CHECK(limits_damping(loaded(kPairs + "tension = true\n", {"contact.pairs.0.limit_damping=true"})));
  CHECK(limits_damping(loaded(kPairs + "limit_damping = false\n", {old_no})));
  CHECK_FALSE(limits_damping(loaded(kPairs, {old_no, old_yes})));
  CHECK_FALSE(limits_damping(loaded(kPairs, {old_yes, old_yes})));
  CHECK(limits_damping(loaded(kPairs, {old_yes, "contact.pairs.0.limit_damping=true"})));
  CHECK(loaded(kPairs, {old_yes}).former_names ==
        Lines{"--set " + old_yes + ": contact.pairs.0.tension = true is now limit_damping = false"});
  CHECK(loaded(kSmallDeck, {"space.leaving=drift"}).root.table("space").text("leaving") == "ballistic");
}

TEST_CASE("wrong values under a former name are refused at their place, unknown names as ever") {
  CHECK(
      contains(deck_error(kPairs + "tension = 3\n"), "deck.toml:12:11: contact.pairs.0.limit_damping = 3: "));
  CHECK(contains(deck_error(kPairs + "tensoin = true\n"), "unknown key; known: "));
  CHECK(contains(deck_error(kSmallDeck + "tension = true\n"), "time.tension = true: unknown key"));
  CHECK(contains(deck_error(kSmallDeck + "[integrator]\nredundant = \"shared\"\n"),
                 "must be one of \"error\", \"minimum-norm\""));
}

TEST_CASE("a fingerprint of an earlier version differs in no renamed key") {
  const std::string now = loaded(kPairs + "limit_damping = false\n").fingerprint();
  std::string before = now;
  const std::string present = "limit_damping = false";
  before.replace(before.find(present), present.size(), "tension = true");
  CHECK(deck_differences(before, now).empty());
  before.replace(before.find("tension = true"), 14, "tension = false");
  const std::vector<DeckDifference> found = deck_differences(before, now);
  REQUIRE(found.size() == 1);
  CHECK(to_text(found[0]) == "contact.pairs.0.limit_damping: true -> false");
}

TEST_CASE("the manual finds a key by its former names and words") {
  CHECK(contains(keys_about("tension"), "contact.pairs.limit_damping\n"));
  CHECK(contains(keys_about("tension"), "formerly tension, with the opposite value"));
  CHECK(contains(keys_about("share"), "integrator.redundant\n"));
  CHECK(contains(keys_about("drift"), "formerly \"drift\" for \"ballistic\""));
}

TEST_CASE("no former name or word is a present one of the same table or choice") {
  const std::function<void(const TableKeys&)> check_table = [&](const TableKeys& table) {
    for (const Key& key : table.keys) {
      for (const FormerName& former : key.former_names) {
        CAPTURE(former.text);
        CHECK(std::ranges::find(table.keys, former.text, &Key::name) == table.keys.end());
        CHECK((former.sense == FormerSense::same || key.type == ValueType::boolean));
        CHECK((key.type != ValueType::table && key.type != ValueType::tables));  // --set makes no such tables
      }
      for (const FormerWord& former : key.former_words) {
        CAPTURE(former.text);
        CHECK(std::ranges::find(key.words, former.text) == key.words.end());
        CHECK(std::ranges::find(key.words, former.now) != key.words.end());
      }
      if (key.table != nullptr) check_table(*key.table);
    }
  };
  check_table(deck_keys());
}

}  // namespace scree
