// Values from --set.
#include "support/catch.hpp"
#include "support/decks.hpp"

namespace scree {

namespace {

const std::string kDeck = kSmallDeck + R"(
[[particles]]
name = "block"
kind = "row"
origin = [0.0, 0.0]
spacing = [0.1, 0.0]
count = 3
radius = 0.05
mass = 1.0
)";

DeckTable load(const std::vector<std::string>& overrides) {
  return parse_deck(kDeck, "deck.toml", overrides).root;
}

}  // namespace

TEST_CASE("overrides replace values of any type") {
  CHECK(load({"time.step=1e-5"}).table("time").real("step") == 1e-5);
  CHECK(load({"space.min=[-2, -3]"}).table("space").vector("min").y == -3);
  CHECK(load({"title=\"two words\""}).text("title") == "two words");
  CHECK(load({"output.history_csv=true"}).table("output").boolean("history_csv"));
}

TEST_CASE("a bare word is a text") {
  CHECK(load({"time.control=adaptive"}).table("time").text("control") == "adaptive");
  CHECK(load({"output.directory=out/run-1"}).table("output").text("directory") == "out/run-1");
  CHECK(load({"integrator.particles=velocity-verlet"}).table("integrator").text("particles") ==
        "velocity-verlet");
}

TEST_CASE("blanks around keys and values do not matter") {
  CHECK(load({"time.step = 1e-5"}).table("time").real("step") == 1e-5);
  CHECK(load({" time . step=\t1e-5 "}).table("time").real("step") == 1e-5);
  CHECK(load({"time.control = adaptive "}).table("time").text("control") == "adaptive");
  CHECK(load({"particles. block .count = 5"}).tables("particles")[0].integer("count") == 5);
}

TEST_CASE("elements go by name or by number") {
  CHECK(load({"particles.block.count=5"}).tables("particles")[0].integer("count") == 5);
  CHECK(load({"particles.0.count=6"}).tables("particles")[0].integer("count") == 6);
  CHECK(
      load({"particles.block.count=5", "particles.block.count=7"}).tables("particles")[0].integer("count") ==
      7);
}

TEST_CASE("tables that were not there are made") {
  CHECK(load({"integrator.hht_alpha=-0.1"}).table("integrator").real("hht_alpha") == -0.1);
}

TEST_CASE("errors name the override instead of a line") {
  CHECK(deck_error(kDeck, {"time.step=-1"}) == "--set time.step=-1: time.step must be a number above 0 [s]");
  CHECK(deck_error(kDeck, {"time.stp=1"}) ==
        "--set time.stp=1: time.stp = 1: unknown key; did you mean \"step\"?");
  CHECK(contains(deck_error(kDeck, {"tme.step=1"}), "--set tme.step=1: tme = { step = 1 }: unknown key"));
  CHECK(contains(deck_error(kDeck, {"particles.blok.count=1"}),
                 "--set particles.blok.count=1: no element is named \"blok\"; did you mean \"block\"?"));
  CHECK(contains(deck_error(kDeck, {"particles.1.count=1"}), "there is 1 element, counted from 0"));
  CHECK(contains(deck_error(kDeck, {"time.step"}), "--set time.step: must have the form key.path=value"));
  for (const std::string path : {"", " ", ".", "time.", ".step", "time..step"})
    CHECK(deck_error(kDeck, {path + "=1"}) == "--set " + path + "=1: must have the form key.path=value");
  CHECK(contains(deck_error(kDeck, {"time.step.x=1"}), "step has no keys of its own"));
  CHECK(contains(deck_error(kDeck, {"space.min=[1,"}), "--set space.min=[1,: not a TOML value"));
  CHECK(contains(deck_error(kDeck, {"time.step=1\nend=2"}), "--set time.step=1\\nend=2: must be one value"));
}

TEST_CASE("an override of any length has a short message") {
  const std::string message = deck_error(kDeck, {"time.step=" + std::string(100000, 'x')});
  CHECK(message.size() < 500);
  CHECK(contains(message, "--set time.step=xxx"));
  CHECK(contains(message, "time.step must be a number above 0 [s]"));
}

}  // namespace scree
