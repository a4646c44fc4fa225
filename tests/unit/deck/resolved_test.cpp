// The resolved deck, its fingerprint, and the manual.
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include "support/catch.hpp"
#include "support/decks.hpp"

namespace scree {

namespace {

const std::string kDeck = "title = 'a \"b\" \\ c'\n" + kSmallDeck + R"(
[output]
history_interval = 0.1
[[materials]]
name = "glass"
density = 2.5e3
[[bodies]]
name = "a"
mass = 0.1
inertia = 1e-20
position = [0.1, 0.3]
shapes = [{ radius = 0.05 }, { radius = 0.06, offset = [0.1, 0.0] }]
[[drivers]]
name = "d"
joint = "j"
motion = { kind = "sine", amplitude = 2.0, frequency = 3 }
)";

std::string fingerprint(const std::vector<std::string>& overrides) {
  return parse_deck(kDeck, "deck.toml", overrides).fingerprint();
}

}  // namespace

TEST_CASE("the resolved deck holds the defaults and loads to itself") {
  const Deck deck = parse_deck(kDeck, "deck.toml", {"time.end=2", "time.control=adaptive"});
  const std::string text = deck.resolved_text();
  CHECK(contains(text, "tolerance = 2e-08"));
  CHECK(contains(text, "leaving = \"error\""));
  CHECK(contains(text, "end = 2.0"));
  CHECK(contains(text,
                 "motion = { kind = \"sine\", value = 0.0, amplitude = 2.0, frequency = 3.0, phase = 0.0 }"));
  const Deck again = parse_deck(text, "resolved.toml", {});
  CHECK(again.resolved_text() == text);
  CHECK(again.fingerprint() == deck.fingerprint());
  CHECK(again.root.text("title") == "a \"b\" \\ c");
  CHECK(again.root.tables("bodies")[0].tables("shapes")[1].vector("offset").x == 0.1);
}

TEST_CASE("the default step control follows the particles' integrator") {
  const std::string head = "[space]\ndimension = 2\nmin = [-1, -1]\nmax = [1, 1]\n[time]\nend = 1.0\n";
  const auto resolved = [](const std::string& text, const std::vector<std::string>& overrides = {}) {
    return parse_deck(text, "deck.toml", overrides).resolved_text();
  };
  const std::string verlet = "integrator.particles=velocity-verlet", step = "time.step=1e-3";
  CHECK(contains(resolved(head), "control = \"adaptive\"\ntolerance = 2e-08\n"));
  CHECK_FALSE(contains(resolved(head), "\nstep = "));
  CHECK(contains(resolved(head, {step}), "step = 0.001\ncontrol = \"adaptive\"\n"));
  CHECK(contains(resolved(head, {"integrator.particles=hht"}), "control = \"adaptive\""));
  CHECK(contains(resolved(head, {verlet, step}), "control = \"fixed\""));
  CHECK(contains(resolved(head + "[integrator]\nparticles = \"velocity-verlet\"\n", {step}),
                 "control = \"fixed\""));
  CHECK(contains(resolved(head, {verlet, step, "time.control=adaptive"}), "control = \"adaptive\""));
  CHECK(contains(resolved(head), "particles = \"auto\"\n"));  // decided when the model is built
  CHECK(contains(resolved(head, {verlet}), "control = \"fixed\"\n"));
  const std::string again = resolved(head, {verlet, step});
  CHECK(resolved(again) == again);
}

TEST_CASE("the fingerprint changes with the physics, not with output and end") {
  const std::string original = fingerprint({});
  CHECK(fingerprint({"output.history_interval=0.2", "time.end=5", "output.directory=x"}) == original);
  CHECK(fingerprint({"title=corrected", "parallel.imbalance=1"}) == original);
  CHECK(fingerprint({"time.step=2e-3"}) != original);
  CHECK(fingerprint({"bodies.a.mass=0.2"}) != original);
  CHECK(fingerprint({"bodies.a.mass=1e-1"}) == original);
}

TEST_CASE("the fingerprint follows the contents of files") {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "scree_fingerprint_test";
  std::filesystem::create_directories(folder);
  const auto write = [&](const std::string& text) { std::ofstream(folder / "p.csv") << text; };
  const std::string text = kSmallDeck + "[[particles]]\nkind = \"file\"\nfile = \"p.csv\"\n";
  const auto load = [&] { return parse_deck(text, (folder / "deck.toml").string(), {}); };
  write("x,y\n0,0\n");
  const std::string first = load().fingerprint();
  CHECK(load().fingerprint() == first);
  CHECK(parse_deck(load().resolved_text(), "elsewhere/deck.toml", {}).fingerprint() == first);
  write("x,y\n0,1\n");
  CHECK(load().fingerprint() != first);
  std::filesystem::remove_all(folder);
}

TEST_CASE("every key has a sentence, and a default, or a meaning when left out") {
  const std::function<void(const TableKeys&)> check_table = [&](const TableKeys& table) {
    for (const Key& key : table.keys) {
      CAPTURE(key.name);
      const bool is_table = key.type == ValueType::table || key.type == ValueType::tables;
      CHECK(key.sentence.empty() == is_table);
      if (!is_table) CHECK((key.is_required || !key.default_value.empty() || !key.default_note.empty()));
      if (!key.kinds.empty()) CHECK_FALSE(table.selector.empty());
      if (key.table) {
        CHECK_FALSE(key.table->sentence.empty());
        check_table(*key.table);
      }
    }
  };
  check_table(deck_keys());
}

TEST_CASE("the manual names every table and fits 110 columns") {
  const std::string manual = keys_text();
  for (const char* header : {"[space]  (required)", "[[contact.pairs]]", "[[bodies.shapes]]", "[[particles]]",
                             "[output]", "time function", "distribution"}) {
    CAPTURE(header);
    CHECK(contains(manual, header));
  }
  CHECK(contains(manual, "a number above 0 [s]; required"));
  CHECK(contains(manual, "default \"adaptive\", with integrator.particles = \"velocity-verlet\" \"fixed\""));
  CHECK(contains(manual, "only with kind = \"cone\", \"funnel\"; required with kind"));
  std::istringstream lines(manual);
  std::string line;
  while (std::getline(lines, line)) CHECK(line.size() <= 110);
}

}  // namespace scree
