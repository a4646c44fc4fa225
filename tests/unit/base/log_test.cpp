// Suppression of repeated warnings of one kind.
#include "base/log.hpp"

#include "support/catch.hpp"

namespace scree {

TEST_CASE("ten warnings of a kind are kept, further ones are counted") {
  Log log(true);
  for (int i = 0; i < 67; ++i)
    log.warning("mesh \"link " + std::to_string(i) +
                "\": its triangles are small beside the particles: near " + std::to_string(3 * i) +
                " of them");
  for (int i = 0; i < 11; ++i)
    log.warning("robot.toml:" + std::to_string(i) + ":3: bodies.arm" +
                std::string(1, static_cast<char>('a' + i)) + ".density: no material has it");
  for (int i = 0; i < 10; ++i) log.warning("body \"" + std::to_string(i) + "\": is far away");
  CHECK(log.warnings().size() == 30);
  log.report_suppressed();
  REQUIRE(log.warnings().size() == 32);
  CHECK(log.warnings()[30] ==
        "1 more warning like this one: robot.toml:0:3: bodies.arma.density: no material has it");
  CHECK(log.warnings()[31].starts_with(
      "57 more warnings like this one: mesh \"link 0\": its triangles are small"));
  log.report_suppressed();
  CHECK(log.warnings().size() == 32);
  log.warning("mesh \"late\": its triangles are small beside the particles: near 2 of them");
  log.report_suppressed();
  CHECK(log.warnings().size() == 33);
}

TEST_CASE("warnings that differ in their words are of different kinds") {
  Log log(true);
  for (int i = 0; i < 8; ++i)
    log.warning("mesh \"a\": its facets are coarse"), log.warning("mesh \"a\": its shells cross");
  for (int i = 0; i < 8; ++i) log.warning("walls.b: its facets are coarse");
  CHECK(log.warnings().size() == 24);
}

}  // namespace scree
