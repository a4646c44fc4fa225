// Differences of two decks and their texts.
#include "deck/differences.hpp"

#include "support/catch.hpp"
#include "support/decks.hpp"

namespace scree {

namespace {

const std::string kDeck = kSmallDeck + R"(
[[materials]]
name = "glass"
[[bodies]]
name = "a"
mass = 0.1
inertia = 1e-20
position = [0.1, 0.3]
shapes = [{ radius = 0.05 }, { radius = 0.06, offset = [0.1, 0.0] }]
[[drivers]]
name = "d"
joint = "j"
motion = { kind = "table", times = [0.0, 1.0], values = [0.0, 2.0] }
)";

std::vector<std::string> differing(const std::string& before, const std::string& after) {
  std::vector<std::string> texts;
  for (const DeckDifference& d : deck_differences(parse_deck(before, "a.toml", {}).fingerprint(),
                                                  parse_deck(after, "b.toml", {}).fingerprint()))
    texts.push_back(to_text(d));
  return texts;
}

std::vector<std::string> differing(const std::vector<std::string>& overrides) {
  return differing(kDeck, parse_deck(kDeck, "a.toml", overrides).resolved_text());
}

using Texts = std::vector<std::string>;

}  // namespace

TEST_CASE("decks differ in the keys with other values, by the names of --set") {
  CHECK(differing({"title=other", "time.end=7", "output.compression=3"}).empty());
  CHECK(differing({"time.step=2e-3"}) == Texts{"time.step: 0.001 -> 0.002"});
  CHECK(differing({"bodies.a.mass=0.2", "time.control=adaptive"}).front() == "bodies.a.mass: 0.1 -> 0.2");
  CHECK(differing({"drivers.d.motion.values=[0.0, 3.0]"}) ==
        Texts{"drivers.d.motion.values: [0.0, 2.0] -> [0.0, 3.0]"});
  CHECK(differing({"drivers.d.motion=1.0"}).size() == 4);
  CHECK(differing({"gravity=[-0.0, 0.0]"}) == Texts{"gravity: [0.0, 0.0] -> [-0.0, 0.0]"});
}

TEST_CASE("lists differ as a whole where they have other entries") {
  std::string renamed = kDeck;
  renamed.replace(renamed.find("\"glass\""), 7, "\"steel\"");
  CHECK(differing(kDeck, renamed) == Texts{"materials: [glass] -> [steel]"});
  const Texts longer = differing(
      kDeck, kDeck + "[[bodies]]\nname = \"b\"\nposition = [0.5, 0.5]\nmass = 1.0\ninertia = 1.0\n");
  REQUIRE(longer.size() == 1);
  CHECK(longer[0] == "bodies: [a] -> [a, b]");
  const auto patterns =
      deck_differences("[[bodies]]\nname = \"a\"\ncount = 1\n", "[[bodies]]\nname = \"a\"\n");
  REQUIRE(patterns.size() == 1);
  CHECK((patterns[0].pattern == "bodies.*.count" && patterns[0].after == "nothing"));
}

TEST_CASE("a text that is no deck differs as a whole") {
  CHECK(deck_differences("no deck", kSmallDeck).size() == 1);
}

}  // namespace scree
