// Every deck in input/ loads and builds, with the values of the paper's cases.
#include <filesystem>

#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 2 * kUlp;  // of positions up to 3 m [m]

const std::string kInput = std::string(SCREE_SOURCE_DIR) + "/input";

Model load_model(const std::string& name, const std::vector<std::string>& overrides = {}) {
  Log log(true);
  return build_model(load_deck(kInput + "/" + name, overrides), log);
}

}  // namespace

TEST_CASE("every deck loads, builds, and resolves to itself") {
  int decks = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kInput)) {
    if (entry.path().extension() != ".toml") continue;
    ++decks;
    CAPTURE(entry.path());
    const Deck deck = load_deck(entry.path().string(), {});
    Log log(true);
    const Model model = build_model(deck, log);
    CHECK(model.bodies.size() + model.particles.size() + model.inserters.size() > 0);
    for (const std::string& warning : log.warnings())
      CHECK(warning.starts_with("time.step: with steps of 0.001 s"));
    CHECK(parse_deck(deck.resolved_text(), deck.path, {}).fingerprint() == deck.fingerprint());
  }
  CHECK(decks >= 13);
}

TEST_CASE("case 5.1") {
  const Model model = load_model("paper/net.toml");
  REQUIRE(model.bodies.size() == 20);
  CHECK(near(model.bodies[19].position.x, 0.95, {.absolute = kRoundOff}));
  CHECK(model.bodies[7].position.y == -0.6);
  REQUIRE(model.spring_dampers.size() == 19);
  CHECK(model.spring_dampers[18].body[0] == 18);
  CHECK(model.spring_dampers[18].stiffness == 1e5);
  REQUIRE(model.joints.size() == 2);
  CHECK(model.joints[1].body[1] == 19);
  CHECK(near(model.joints[1].point[0].x, 0.95, {.absolute = kRoundOff}));
  CHECK(model.gravity == Vec3{0, -9.8066, 0});
  CHECK(model.contact.law(0, 0).normal_stiffness == 0);
}

TEST_CASE("case 5.2") {
  const Model model = load_model("paper/valley.toml");
  REQUIRE(model.bodies.size() == 13);
  CHECK(near(model.bodies[6].position.y, -1.2, {.absolute = kRoundOff}));
  CHECK(near(model.bodies[6].position.x, -0.35, {.absolute = kRoundOff}));
  CHECK(near(model.bodies[12].position.x, 0.25, {.absolute = kRoundOff}));
  CHECK(near(model.bodies[12].position.y, -0.6, {.absolute = kRoundOff}));
  CHECK(model.joints.size() == 13);
  CHECK(model.particles.position[4] == Vec3{0.05, 1.5, 0});
  CHECK(model.contact.law(0, 0).tension);
}

TEST_CASE("case 5.3") {
  const Model small = load_model("paper/net_9.toml");
  REQUIRE(small.particles.size() == 9);
  CHECK(small.particles.position[0].x == -0.15);
  CHECK(std::abs(small.particles.position[4].x) < 1e-15);
  CHECK(near(small.particles.position[8].y, 0.3, {.absolute = kRoundOff}));
  const Model large = load_model("paper/net_400.toml");
  REQUIRE(large.particles.size() == 400);
  CHECK(near(large.particles.position[19].x, 1.14, {.absolute = kRoundOff}));
  CHECK(near(large.particles.position[399].y, 19 * 0.12, {.absolute = kRoundOff}));
}

TEST_CASE("Table 4: 17 cases from one deck, 30 wide, filled from the bottom") {
  for (int count = 100; count <= 900; count += 50) {
    const Model model = load_model("paper/table4.toml", {"particles.block.count=" + std::to_string(count)});
    REQUIRE(model.particles.size() == static_cast<std::size_t>(count));
    const Vec3 last = model.particles.position.back();
    CHECK(near(last.y, -0.25 + 0.11 * ((count - 1) / 30), {.absolute = kRoundOff}));
    CHECK(near(last.x, -1.595 + 0.11 * ((count - 1) % 30), {.absolute = kRoundOff}));
    CHECK(near(model.particles.position[29].x, 1.595, {.absolute = kRoundOff}));
  }
  CHECK(near(load_model("paper/table4.toml", {"particles.block.count=900"}).particles.position.back().y, 2.94,
             {.absolute = kRoundOff}));
}

}  // namespace scree
