// Choices: words and the enums' values that they stand for.
#include "deck/choices.hpp"

#include <functional>
#include <set>

#include "support/catch.hpp"
#include "support/decks.hpp"

namespace scree {

namespace {

enum class Colour { red, green, blue };

}  // namespace

template <>
inline constexpr auto kWords<Colour> = std::to_array<Word<Colour>>({{"red", Colour::red},
                                                                    {"green", Colour::green}});

TEST_CASE("a word stands for its own value, and an unknown one for none") {
  for (const Word<JointKind>& word : kWords<JointKind>) {
    CHECK(value_of<JointKind>(word.text) == word.value);
    CHECK(word_of(word.value) == word.text);
  }
  CHECK_THROWS_AS(value_of<JointKind>("ball"), std::logic_error);
  CHECK_THROWS_AS(value_of<JointKind>(""), std::logic_error);
  CHECK_THROWS_AS(word_of(Colour::blue), std::logic_error);
  CHECK(words_of<Colour>() == std::vector<std::string>{"red", "green"});
}

TEST_CASE("a key is read as the choice that it was declared with") {
  const DeckTable root = parse_deck(kSmallDeck, "deck.toml", {"space.x_min=wall"}).root;
  const DeckTable& space = root.table("space");
  CHECK(space.choice<Boundary>("x_min") == Boundary::wall);
  CHECK(space.choice<OutsidePolicy>("leaving") == OutsidePolicy::error);
  CHECK_THROWS_AS(space.choice<OutsidePolicy>("x_min"), std::logic_error);
  CHECK_THROWS_AS(space.choice<Boundary>("wall_material"), std::logic_error);
  CHECK_THROWS_AS(space.choice<Boundary>("w_min"), std::logic_error);
}

TEST_CASE("keys that belong to a kind name words of their table's selector") {
  int tables = 0;
  std::set<const TableKeys*> seen;
  const std::function<void(const TableKeys&)> check_table = [&](const TableKeys& table) {
    if (!seen.insert(&table).second) return;
    std::set<std::string> words;
    for (const Key& key : table.keys)
      if (key.name == table.selector) words.insert(key.words.begin(), key.words.end());
    tables += words.empty() ? 0 : 1;
    for (const Key& key : table.keys) {
      INFO(key.name);
      for (const std::string& kind : key.kinds) CHECK(words.contains(kind));
      for (const std::string& kind : key.required_kinds) CHECK(words.contains(kind));
      if (key.table != nullptr) check_table(*key.table);
    }
  };
  check_table(deck_keys());
  // Time, meshes, motions of walls, bodies, solids, joints, motors, cylinders, couplers, particles, functions
  // of time, distributions, regions of the history.
  CHECK(tables == 15);
}

}  // namespace scree
