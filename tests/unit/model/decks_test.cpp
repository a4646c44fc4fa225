// Every deck in input/ loads, builds and says what the paper's cases say.
#include <filesystem>

#include "support/catch.hpp"
#include "support/models.hpp"

namespace scree {

namespace {

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
    CHECK(model.bodies.size() + model.particles.size() > 0);
    for (const std::string& warning : log.warnings())
      CHECK(warning.starts_with("time.step: steps of 0.001 s"));
    CHECK(parse_deck(deck.resolved_text(), deck.path, {}).fingerprint() == deck.fingerprint());
  }
  CHECK(decks >= 13);
}

TEST_CASE("case 5.1") {
  const Model model = load_model("paper/net.toml");
  REQUIRE(model.bodies.size() == 20);
  CHECK(model.bodies[19].position.x == Approx(0.95));
  CHECK(model.bodies[7].position.y == -0.6);
  REQUIRE(model.spring_dampers.size() == 19);
  CHECK(model.spring_dampers[18].body[0] == 18);
  CHECK(model.spring_dampers[18].stiffness == 1e5);
  REQUIRE(model.joints.size() == 2);
  CHECK(model.joints[1].body[1] == 19);
  CHECK(model.joints[1].point[0].x == Approx(0.95));
  CHECK(model.gravity == Vec3{0, -9.8066, 0});
  CHECK(model.contact.law(0, 0).normal_stiffness == 0);
}

TEST_CASE("case 5.2") {
  const Model model = load_model("paper/valley.toml");
  REQUIRE(model.bodies.size() == 13);
  CHECK(model.bodies[6].position.y == Approx(-1.2));
  CHECK(model.bodies[6].position.x == Approx(-0.35));
  CHECK(model.bodies[12].position.x == Approx(0.25));
  CHECK(model.bodies[12].position.y == Approx(-0.6));
  CHECK(model.joints.size() == 13);
  CHECK(model.particles.position[4] == Vec3{0.05, 1.5, 0});
  CHECK(model.contact.law(0, 0).tension);
}

TEST_CASE("case 5.3") {
  const Model small = load_model("paper/net_9.toml");
  REQUIRE(small.particles.size() == 9);
  CHECK(small.particles.position[0].x == -0.15);
  CHECK(std::abs(small.particles.position[4].x) < 1e-15);
  CHECK(small.particles.position[8].y == Approx(0.3));
  const Model large = load_model("paper/net_400.toml");
  REQUIRE(large.particles.size() == 400);
  CHECK(large.particles.position[19].x == Approx(1.14));
  CHECK(large.particles.position[399].y == Approx(19 * 0.12));
}

TEST_CASE("Table 4: 17 cases from one deck, 30 wide, filled from the bottom") {
  for (int count = 100; count <= 900; count += 50) {
    const Model model = load_model("paper/table4.toml", {"particles.block.count=" + std::to_string(count)});
    REQUIRE(model.particles.size() == static_cast<std::size_t>(count));
    const Vec3 last = model.particles.position.back();
    CHECK(last.y == Approx(-0.25 + 0.11 * ((count - 1) / 30)));
    CHECK(last.x == Approx(-1.595 + 0.11 * ((count - 1) % 30)));
    CHECK(model.particles.position[29].x == Approx(1.595));
  }
  CHECK(load_model("paper/table4.toml", {"particles.block.count=900"}).particles.position.back().y ==
        Approx(2.94));
}

}  // namespace scree
