// Every kind of wrong deck has one message with line, key, value and the allowed values.
#include <fmt/format.h>

#include <algorithm>

#include "support/catch.hpp"
#include "support/decks.hpp"

namespace scree {

namespace {

// A deck whose line `line` (counted from 1) is replaced.
std::string with_line(int line, const std::string& replacement) {
  std::string result, rest = kSmallDeck;
  for (int number = 1; !rest.empty(); ++number) {
    const std::size_t end = rest.find('\n') + 1;
    result += number == line ? replacement + "\n" : rest.substr(0, end);
    rest.erase(0, end);
  }
  return result;
}

// "deck.toml:12:" for a line counted from the end of the small deck, the first one after it being 1.
std::string line_after(std::ptrdiff_t line) {
  return fmt::format("deck.toml:{}:", std::count(kSmallDeck.begin(), kSmallDeck.end(), '\n') + line);
}

}  // namespace

TEST_CASE("a good deck gives no error") { CHECK(deck_error(kSmallDeck).empty()); }

TEST_CASE("text that is not TOML") {
  const std::string message = deck_error("[space\ndimension = 2\n");
  CHECK(contains(message, "deck.toml:1:"));
  CHECK(contains(message, "not TOML"));
  for (const char* bare : {"wall", "fixed", "no"})
    CHECK(contains(deck_error(with_line(8, fmt::format("control = {}", bare))), "; texts need quotes"));
  CHECK_FALSE(contains(deck_error(with_line(8, "step = 1m")), "quotes"));
}

TEST_CASE("a repeated key") {
  const std::string message = deck_error(with_line(8, "step = 1e-3\nstep = 2e-3"));
  CHECK(contains(message, "deck.toml:9:"));
  CHECK(contains(message, "step"));
}

TEST_CASE("unknown keys and tables get a suggestion") {
  CHECK(deck_error(with_line(8, "stp = 1e-3")) ==
        "deck.toml:8:1: time.stp = 1e-3: unknown key; did you mean \"step\"?");
  CHECK(contains(deck_error(kSmallDeck + "[contct]\n"),
                 "deck.toml:10:2: contct = { }: unknown key; did you mean \"contact\"?"));
  CHECK(contains(deck_error(kSmallDeck + "[[mesh]]\n"), "did you mean \"meshes\"?"));
  CHECK(contains(deck_error(kSmallDeck + "[joints]\n"), "joints = { }: must be "));
  CHECK(contains(deck_error(kSmallDeck + "[joints]\n"), "; write [[joints]]"));
  CHECK(
      contains(deck_error(with_line(8, "dt = 1e-3")), "time.dt = 1e-3: unknown key; did you mean \"step\"?"));
  CHECK(contains(deck_error("dt = 1e-3\n" + kSmallDeck), "did you mean \"time.step\"?"));
  const std::string far_off = deck_error(with_line(8, "step = 1e-3\nsomething_else = 1"));
  CHECK(contains(far_off, "time.something_else = 1: unknown key; known: end, step, control"));
}

TEST_CASE("values of the wrong type") {
  CHECK(deck_error(with_line(8, "step = \"fast\"")) ==
        "deck.toml:8:8: time.step = \"fast\": must be a number above 0 [s]");
  CHECK(deck_error(with_line(3, "dimension = 2.0")) ==
        "deck.toml:3:13: space.dimension = 2.0: must be an integer from 2 to 3, without a decimal point");
  CHECK(deck_error(with_line(4, "min = -1.0")) ==
        "deck.toml:4:7: space.min = -1.0: must be 2 numbers [m] in brackets");
  CHECK(
      contains(deck_error(with_line(4, "min = [0, 0, 0]")), "space.min = [0, 0, 0]: must be 2 numbers [m]"));
  CHECK(
      contains(deck_error(with_line(4, "min = [0, true]")), "space.min = [0, true]: must be 2 numbers [m]"));
  CHECK(contains(deck_error("title = 5\n" + kSmallDeck), "deck.toml:1:9: title = 5: must be a text"));
  CHECK(contains(deck_error(kSmallDeck + "[output]\nhistory_csv = 1\n"),
                 "history_csv = 1: must be true or false"));
  CHECK(contains(deck_error(kSmallDeck + "[output]\nhistory_bodies = [1]\n"), "must be a list of texts"));
  CHECK(contains(deck_error("contact = 3\n" + kSmallDeck), "contact = 3: must be a table"));
  CHECK(contains(deck_error("bodies = 3\n" + kSmallDeck), "bodies = 3: must be a list of tables"));
}

TEST_CASE("numbers are shown as they are written") {
  CHECK(contains(deck_error("\xef\xbb\xbftitle = 5.0\n" + kSmallDeck), "title = 5.0: must be a text"));
  CHECK(contains(deck_error(with_line(8, "\"sch\u00f6n\" = { a = [+1_000.50, 0x1F], b = 1E5 }")),
                 "= { a = [+1_000.50, 0x1F], b = 1E5 }: unknown key"));
  CHECK(
      contains(deck_error(kSmallDeck, {"time.other={ a = 2.0 }"}), "time.other = { a = 2.0 }: unknown key"));
}

TEST_CASE("numbers out of range, infinite and not a number") {
  CHECK(deck_error(with_line(8, "step = -1e-3")) ==
        "deck.toml:8:8: time.step = -1e-3: must be a number above 0 [s]");
  CHECK(contains(deck_error(with_line(8, "step = 0")), "time.step = 0: must be a number above 0 [s]"));
  CHECK(contains(deck_error(with_line(8, "step = nan")),
                 "time.step = nan: must be a number above 0 [s], finite"));
  CHECK(contains(deck_error(with_line(7, "end = inf")),
                 "time.end = inf: must be a number above 0 [s], finite"));
  CHECK(contains(deck_error(with_line(4, "min = [-inf, 0.0]")),
                 "space.min = [-inf, 0.0]: must be 2 numbers [m]"));
  CHECK(contains(deck_error(with_line(3, "dimension = 4")),
                 "space.dimension = 4: must be an integer from 2 to 3"));
  CHECK(contains(deck_error(kSmallDeck + "[integrator]\nhht_alpha = 0.1\n"),
                 "integrator.hht_alpha = 0.1: must be a number from -0.3333333333333333 to 0"));
  CHECK(
      contains(deck_error(kSmallDeck + "[[contact.pairs]]\nstiffness = -1.0\n"),
               "deck.toml:11:13: contact.pairs.0.stiffness = -1.0: must be a number of at least 0 [N/m^n]"));
  CHECK(contains(deck_error(kSmallDeck + "[output]\nhistory_particles = [-1]\n"),
                 "must be a list of integers of at least 0"));
}

TEST_CASE("texts that are no choice") {
  CHECK(contains(
      deck_error(with_line(9, "control = \"adaptiv\"")),
      "deck.toml:9:11: time.control = \"adaptiv\": must be one of \"fixed\", \"adaptive\"; did you mean "
      "\"adaptive\"?"));
}

TEST_CASE("missing keys and tables") {
  CHECK(deck_error(with_line(7, "")) == "deck.toml:6:1: time.end: missing; it must be a number above 0 [s]");
  CHECK(contains(deck_error("title = \"x\"\n"), "deck.toml: space: missing; it must be a table"));
  CHECK(contains(deck_error(kSmallDeck + "[[bodies]]\nname = \"a\"\n"),
                 "deck.toml:10:1: bodies.a.position: missing; it must be 2 numbers [m] in brackets"));
}

TEST_CASE("keys that the kind of table does not use") {
  const std::string lattice = "[[particles]]\nname = \"block\"\nkind = \"lattice\"\nfile = \"x.csv\"\n";
  CHECK(deck_error(kSmallDeck + lattice) ==
        "deck.toml:13:1: particles.block.file = \"x.csv\": not used with kind = \"lattice\", only with "
        "\"file\"");
  const std::string motion =
      "[[drivers]]\nname = \"d\"\njoint = \"j\"\nmotion = { kind = \"ramp\", rate = 1, phase = 0 }\n";
  CHECK(
      contains(deck_error(kSmallDeck + motion), "drivers.d.motion.phase = 0: not used with kind = \"ramp\""));
}

TEST_CASE("a quantity is a number or a table") {
  const std::string start = kSmallDeck + "[[particles]]\nkind = \"list\"\npositions = [[0, 0]]\n";
  CHECK(
      contains(deck_error(start + "radius = \"big\"\n"),
               "deck.toml:13:10: particles.0.radius = \"big\": must be a number [m] or a table with a kind"));
  CHECK(contains(deck_error(start + "radius = -1\n"),
                 "deck.toml:13:10: particles.0.radius.value = -1: must be a number above 0"));
  CHECK(contains(deck_error(start + "radius = { kind = \"uniform\", min = 1 }\n"),
                 "particles.0.radius.max: missing"));
}

TEST_CASE("repeated names") {
  const std::string body = "[[bodies]]\nname = \"a\"\nmass = 1\ninertia = 1\nposition = [0, 0]\n";
  CHECK(deck_error(kSmallDeck + body + body) ==
        "deck.toml:16:8: bodies.a.name = \"a\": repeated; names must be different");
}

TEST_CASE("a file that cannot be read") {
  const std::string message =
      deck_error(kSmallDeck + "[[particles]]\nkind = \"file\"\nfile = \"absent.csv\"\n");
  CHECK(contains(message, "deck.toml:12:8: particles.0.file = \"absent.csv\": must be the path of a file"));
  CHECK(contains(message, "absent.csv cannot be read"));
  CHECK_THROWS_AS(load_deck("no/such/deck.toml", {}), IoError);
}

TEST_CASE("names are parts of paths in the results") {
  const auto error = [](const std::string& name) {
    return deck_error(kSmallDeck + "[[materials]]\nname = " + name + "\n");
  };
  const std::string allowed =
      "must be a name of 1 to 200 bytes, without \"/\" and control characters, and not \".\" or \"..\"";
  for (const std::string name : {"\"\"", "\".\"", "\"..\"", "\"/\"", "\"a/b\"", "\"a\\nb\"", "\"\\u001b\"",
                                 "\"\\u0000\"", "\"\\u0085\"", "\"\\u202e\""}) {
    const std::string message = error(name);
    CHECK(contains(message, line_after(2) + "8: materials."));
    CHECK((contains(message, allowed) || contains(message, "without the character \\u0000")));
  }
  CHECK(contains(error("\"" + std::string(201, 'x') + "\""), allowed));
  for (const std::string name : {"\"a b\"", "\"a.b\"", "\"\u00e4\"", "\"...\"", "\"-1\""})
    CHECK(error(name).empty());
  CHECK(error("\"" + std::string(200, 'x') + "\"").empty());
}

TEST_CASE("every table that has a name checks it") {
  const std::string bad = "name = \"a/b\"\n", mass = "mass = 1\ninertia = 1\nposition = [0, 0]\n",
                    pair = "bodies = [\"ground\", \"b\"]\n";
  for (const std::string& table : std::vector<std::string>{
           "[[bodies]]\n" + mass, "[[walls]]\npoint = [0, 0]\nnormal = [1, 0]\n",
           "[[joints]]\ntype = \"fixed\"\n" + pair, "[[drivers]]\njoint = \"j\"\nmotion = 0\n",
           "[[spring_dampers]]\n" + pair, "[[torsional_spring_dampers]]\n" + pair,
           "[[applied_forces]]\nbody = \"b\"\n", "[[particles]]\nkind = \"list\"\npositions = []\n"}) {
    CHECK(contains(deck_error(kSmallDeck + table + bad), ".name = \"a/b\": must be a name"));
  }
}

TEST_CASE("keys nested too deep are refused before they are parsed") {
  const auto nested = [](int parts) {
    std::string key = "a";
    for (int i = 1; i < parts; ++i) key += ".a";
    return key;
  };
  const std::string refused = "a key of more than 16 parts";
  CHECK(contains(deck_error(kSmallDeck + nested(30000) + " = 1\n"), line_after(1) + " " + refused));
  CHECK(contains(deck_error(kSmallDeck + "[" + nested(17) + "]\n"), refused));
  CHECK(contains(deck_error(kSmallDeck + "x = { \"b\" . " + nested(30000) + " = 1 }\n"), refused));
  CHECK(contains(deck_error(kSmallDeck, {nested(30000) + "=1"}), refused));
  CHECK(contains(deck_error(kSmallDeck, {"time={ " + nested(30000) + " = 1 }"}), refused));
  CHECK(contains(deck_error(kSmallDeck + nested(16) + " = 1\n"), "unknown key"));
  // Nesting as deep as both limits permit: toml++ has its own for values.
  std::string open, close;
  for (int i = 0; i < 250; ++i) open += "{ " + nested(16) + " = ", close += " }";
  CHECK(contains(deck_error(kSmallDeck + "x = " + open + "1" + close + "\n"), "unknown key"));
  for (int i = 0; i < 250; ++i) open += "{ a = ", close += " }";
  CHECK(contains(deck_error(kSmallDeck + "x = " + open + "1" + close + "\n"), "not TOML"));
}

TEST_CASE("dots in texts, comments and numbers are no keys") {
  const std::string dots = "a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a";
  for (const std::string& text :
       std::vector<std::string>{"\"" + dots + "\"", "'" + dots + "'", "\"\"\"\n\\\"" + dots + "\"\"\"",
                                "\"\"\"\"" + dots + "\"\"\"", "'''" + dots + "'''", "\"\" # " + dots})
    CHECK(deck_error("title = " + text + "\n" + kSmallDeck).empty());
  std::string numbers = "1.0";
  for (int i = 0; i < 30; ++i) numbers += ", 1.0";
  CHECK(contains(deck_error(kSmallDeck + "x = [" + numbers + "]\n"), "unknown key"));
}

TEST_CASE("values within a quantity are reported in the quantity's unit") {
  const std::string particles = kSmallDeck + "[[particles]]\nkind = \"list\"\npositions = []\n";
  CHECK(contains(deck_error(particles + "radius = -1\n"),
                 "particles.0.radius.value = -1: must be a number above 0 [m]"));
  CHECK(contains(deck_error(particles + "density = { kind = \"uniform\", min = 0, max = 1 }\n"),
                 "density.min = 0: must be a number above 0 [kg/m^3]"));
  const std::string driver = kSmallDeck + "[[drivers]]\nname = \"d\"\njoint = \"j\"\n";
  CHECK(contains(deck_error(driver + "motion = { kind = \"ramp\", rate = \"x\" }\n"),
                 "must be a number [(rad or m)/s]"));
  CHECK(contains(deck_error(driver + "motion = { kind = \"sine\", frequency = 1 }\n"),
                 "motion.amplitude: missing; it must be a number [rad or m]"));
}

}  // namespace scree
